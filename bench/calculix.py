"""CalculiX (ccx): running it on the deck of a case and reading the displacements back.

Deck and result file are those of exchange/, which tells what they hold.
"""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import clock
from common.errors import ComputationError, InputError
from exchange import calculix_deck, frd_file
from exchange.foreign_mesh import HexMesh

PROGRAM, PACKAGE = "ccx", "calculix-ccx"
SECONDS = r"Total CalculiX Time: *([\d.]+)"


@dataclass(frozen=True)
class Solution:
    """What ccx answered: displacement (n, 3) in m, and what it cost.

    process_seconds: from start to end of the process. processor_seconds: of them, on a processor.
    solver_seconds: what ccx says of itself, the reading of the deck included. increments: those
    that converged. iterations: all, those of increments that were cut included. version: ccx's own,
    as text.
    """

    displacement: np.ndarray
    process_seconds: float
    processor_seconds: float
    solver_seconds: float
    increments: int
    iterations: int
    version: str


def deck(title, mesh, law, material, element="C3D8", tolerance=None, explicit=None, share=1.0):
    """The input deck of a case, as text.

    title: one line. mesh: HexMesh of reference/. law: name out of LAWS. material: dict of its
    numbers (SI). element, tolerance, explicit: as calculix_deck.deck takes them. share: of the
    displacements. Raises InputError for a law that ccx lacks.
    """
    prescribed, values = mesh.imposed(share)
    plain = HexMesh(mesh.points, mesh.cells, {})
    options = {"element": element, "tolerance": tolerance, "explicit": explicit}
    return calculix_deck.deck(title, plain, law, material, prescribed, values, **options)


def read_progress(path):
    """What a progress file of ccx (.sta) says: (increments, iterations, share of the load reached).

    Raises InputError naming the line and the rule when the file cannot be read or is not one.
    """
    increments, iterations, reached = 0, 0, 0.0
    for number, line in enumerate(_text(path).splitlines()[2:], start=3):
        try:
            _, _, attempt, count, _, time_in_step, _ = line.split()
            iterations += int(count)
            if not attempt.endswith("U"):  # ccx marks what did not converge
                increments, reached = increments + 1, float(time_in_step)
        except ValueError as error:
            raise InputError(
                f"{path}:{number}: {line.strip()!r}: seven columns STEP INC ATT ITRS and three "
                "times are required"
            ) from error
    return increments, iterations, reached


def solve(text, n_nodes, folder, environment=None, processor=None):
    """Run ccx on a deck in an empty folder until all is at rest. Returns a Solution.

    text: of deck(). n_nodes: of its mesh. environment: of the process; None takes the present one.
    processor: the one that it keeps to, or None. Raises ComputationError when ccx finds no
    equilibrium, InputError when its files are damaged.
    """
    done = _run(text, folder, environment, processor)
    increments, iterations, reached = read_progress(Path(folder) / "case.sta")
    if reached != 1:
        raise ComputationError(f"CalculiX stopped at {reached:.4f} of the load")
    return _solution(done, n_nodes, folder, increments, iterations)


def move(text, n_nodes, folder, motion, environment=None, processor=None):
    """Run ccx on the deck of a motion, an Explicit, in an empty folder: Solution at its end.

    Its increments are shorter than the steps of the motion, and more, where ccx takes those for
    unstable. Arguments as of solve. Raises ComputationError when ccx breaks off or blows up,
    InputError when its files are damaged.
    """
    done = _run(text, folder, environment, processor)
    selected = re.search(r"SELECTED time increment: *(\S+)", done.output)
    reached = re.findall(r"^  100CL +\d+ +(\S+)", _text(Path(folder) / "case.frd"), re.MULTILINE)
    duration = motion.time_step * motion.steps
    if not (selected and reached) or abs(float(reached[-1]) / duration - 1) > 1e-5:  # six digits
        raise ComputationError(f"CalculiX stopped at {(reached or '0')[-1]} s of {duration:g} s")
    increments = math.ceil(duration / float(selected[1]) - 1e-5)
    return _solution(done, n_nodes, folder, increments, increments)


def stable_step(text, folder, environment=None):
    """The longest step, s, that ccx takes for stable, of the deck of a short motion.

    Raises ComputationError when it tells none.
    """
    done = _run(text, folder, environment, None)
    told = re.search(r"COURANT initial stable time increment: *(\S+)", done.output)
    if not told:
        raise ComputationError("CalculiX tells no stable step")
    return float(told[1])


def _run(text, folder, environment, processor):
    """ccx on a deck: clock.Clocked. Raises ComputationError when it does not end well."""
    (Path(folder) / "case.inp").write_text(text, encoding="ascii")
    done = clock.run([PROGRAM, "-i", "case"], folder, environment, processor)
    if done.code or not re.search(SECONDS, done.output):
        errors = re.findall(r"\*ERROR.*", done.output)
        reason = errors[-1] if errors else "no message"
        raise ComputationError(f"CalculiX ended with {done.code}: {reason}")
    return done


def _solution(done, n_nodes, folder, increments, iterations):
    """The Solution of a run that ended well."""
    version = re.search(r"CalculiX Version ([\w.]+)", done.output)
    return Solution(
        frd_file.read_displacement(Path(folder) / "case.frd", n_nodes),
        done.seconds,
        done.processor_seconds,
        float(re.search(SECONDS, done.output)[1]),
        increments,
        iterations,
        version[1] if version else "unknown",
    )


def _text(path):
    """The text of a file that ccx wrote. Raises InputError."""
    try:
        return Path(path).read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read as what CalculiX writes: {error}") from error
