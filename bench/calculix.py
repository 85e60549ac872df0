"""Runs CalculiX (ccx) on the deck of a case and reads its displacements.

Deck and result file are handled by exchange/.
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
    """The answer of ccx, displacement (n, 3) in m, and its cost.

    process_seconds: wall time of the process. processor_seconds: its processor time.
    solver_seconds: as printed by ccx, including the reading of the deck. increments: those that
    converged. iterations: all, including those of increments that were cut. version: that of ccx.
    """

    displacement: np.ndarray
    process_seconds: float
    processor_seconds: float
    solver_seconds: float
    increments: int
    iterations: int
    version: str


def material_of(case):
    """The only Material of a Case of reference/. Raises InputError if CalculiX cannot have it."""
    if len(case.materials) > 1:
        raise InputError(f"{case.name}: has several materials; decks here have one")
    if case.materials[0].law not in calculix_deck.LAWS:
        raise InputError(
            f"{case.name}: material.law = {case.materials[0].law!r}: CalculiX has no such law"
        )
    return case.materials[0]


def deck(title, mesh, material, element="C3D8", tolerance=None, explicit=None, share=1.0):
    """The input deck of a case, as text.

    title: one line. mesh: HexMesh and material: Material of reference/. element, tolerance,
    explicit: as for calculix_deck.deck. share: the share of the displacements to impose. Raises
    InputError for a law that ccx lacks.
    """
    prescribed, values = mesh.imposed(share)
    plain = HexMesh(mesh.points, mesh.cells, {})
    options = {"element": element, "tolerance": tolerance, "explicit": explicit}
    law, parameters = material.law, material.parameters
    return calculix_deck.deck(title, plain, law, parameters, prescribed, values, **options)


def read_progress(path):
    """(increments, iterations, share of the load reached) from a progress file of ccx (.sta).

    Raises InputError naming the line and the rule if the file is unreadable or malformed.
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
    """Run ccx on a static deck in an empty folder. Returns a Solution.

    text: of deck(). n_nodes: of its mesh. environment: of the process; None means the current one.
    processor: the one to bind it to, or None. Raises ComputationError if ccx finds no equilibrium,
    and InputError if its files are damaged.
    """
    done = _run(text, folder, environment, processor)
    increments, iterations, reached = read_progress(Path(folder) / "case.sta")
    if reached != 1:
        raise ComputationError(f"CalculiX stopped at {reached:.4f} of the load")
    return _solution(done, n_nodes, folder, increments, iterations)


def move(text, n_nodes, folder, motion, environment=None, processor=None):
    """Run ccx on the deck of a motion, an Explicit, in an empty folder. Returns the final Solution.

    If ccx considers the steps of the motion unstable, it takes more and shorter increments.
    Arguments as for solve(). Raises ComputationError if ccx breaks off or diverges, and InputError
    if its files are damaged.
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
    """The longest step, s, that ccx considers stable, from the deck of a short motion.

    Raises ComputationError if it reports none.
    """
    done = _run(text, folder, environment, None)
    told = re.search(r"COURANT initial stable time increment: *(\S+)", done.output)
    if not told:
        raise ComputationError("CalculiX reports no stable step")
    return float(told[1])


def _run(text, folder, environment, processor):
    """Runs ccx on a deck: clock.Clocked. Raises ComputationError if it fails."""
    (Path(folder) / "case.inp").write_text(text, encoding="ascii")
    done = clock.run([PROGRAM, "-i", "case"], folder, environment, processor)
    if done.code or not re.search(SECONDS, done.output):
        errors = re.findall(r"\*ERROR.*", done.output)
        reason = errors[-1] if errors else "no message"
        raise ComputationError(f"CalculiX ended with {done.code}: {reason}")
    return done


def _solution(done, n_nodes, folder, increments, iterations):
    """The Solution of a successful run."""
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
        raise InputError(
            f"{path}: cannot be read as an output file of CalculiX: {error}"
        ) from error
