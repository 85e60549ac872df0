"""CalculiX (ccx): running it on the deck of a case and reading the displacements back.

Deck and result file are those of exchange/, which tells what they hold.
"""

import re
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from common.errors import ComputationError, InputError
from exchange import calculix_deck, frd_file
from exchange.foreign_mesh import HexMesh

PROGRAM, PACKAGE = "ccx", "calculix-ccx"


@dataclass(frozen=True)
class Solution:
    """What ccx answered: displacement (n, 3) in m, and what it cost.

    process_seconds: from start to end of the process. solver_seconds: what ccx says of itself, the
    reading of the deck included. increments: those that converged. iterations: all, those of
    increments that were cut included. version: ccx's own, as text.
    """

    displacement: np.ndarray
    process_seconds: float
    solver_seconds: float
    increments: int
    iterations: int
    version: str


def deck(title, mesh, law, material, element="C3D8", tolerance=None):
    """The input deck of a case, as text.

    title: one line. mesh: HexMesh of reference/. law: name out of LAWS. material: dict of its
    numbers (SI). element, tolerance: as calculix_deck.deck takes them. Raises InputError for a law
    that ccx lacks.
    """
    prescribed, values = mesh.imposed()
    plain = HexMesh(mesh.points, mesh.cells, {})
    options = {"element": element, "tolerance": tolerance}
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


def solve(text, n_nodes, folder, environment=None):
    """Run ccx on a deck in an empty folder. Returns a Solution.

    text: of deck(). n_nodes: of its mesh. environment: of the process; None takes the present one.
    Raises ComputationError when ccx finds no equilibrium, InputError when its files are damaged.
    """
    folder = Path(folder)
    (folder / "case.inp").write_text(text, encoding="ascii")
    started = time.perf_counter()
    done = subprocess.run(
        [PROGRAM, "-i", "case"], cwd=folder, env=environment, capture_output=True, text=True
    )
    seconds = time.perf_counter() - started
    said = re.search(r"Total CalculiX Time: *([\d.]+)", done.stdout)
    if done.returncode or not said:
        errors = re.findall(r"\*ERROR.*", done.stdout)
        reason = errors[-1] if errors else "no message"
        raise ComputationError(f"CalculiX ended with {done.returncode}: {reason}")
    increments, iterations, reached = read_progress(folder / "case.sta")
    if reached != 1:
        raise ComputationError(f"CalculiX stopped at {reached:.4f} of the load")
    version = re.search(r"CalculiX Version ([\w.]+)", done.stdout)
    return Solution(
        frd_file.read_displacement(folder / "case.frd", n_nodes),
        seconds,
        float(said[1]),
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
