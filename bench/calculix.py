"""CalculiX (ccx): input deck of a case, running it, reading the displacements back.

ccx solves the same problem with its own eight-node brick: *STATIC with NLGEOM, Newton's method and
a sparse direct solver. Its neo-Hookean energy C10 (J^(-2/3) I1 - 3) + (J - 1)^2 / D1 is that of the
project, mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2, with C10 = mu / 2 and D1 = 2 / K.
"""

import re
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from errors import DivergenceError, InputError

PROGRAM, PACKAGE = "ccx", "calculix-ccx"
# ccx cuts and stretches the increments by itself, so this only sets the speed: of 0.1, 0.25 and 1
# it needs the fewest iterations on ellipsoid-indentation.
FIRST_INCREMENT = 0.25
MOST_INCREMENTS = 10000
NUMBER = re.compile(r"[-+]?\d\.\d+E[-+]\d{2,3}")


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


def neo_hookean(material):
    """The lines of *HYPERELASTIC for the project's neo-Hookean law. material: dict, SI units."""
    young, poisson = material["young_modulus"], material["poisson_ratio"]
    mu, bulk = young / 2 / (1 + poisson), young / 3 / (1 - 2 * poisson)
    return ["*HYPERELASTIC, NEO HOOKE", f"{_number(mu / 2)}, {_number(2 / bulk)}"]


# Laws that ccx has, by the project's name.
LAWS = {"neo-hookean": neo_hookean}


def deck(title, mesh, law, material, element="C3D8", tolerance=None):
    """The input deck of a case, as text.

    title: one line. mesh: HexMesh; node and element i becomes i + 1, as ccx counts from one. law:
    name out of LAWS. material: dict of its numbers (SI). element: ccx's name of an eight-node
    brick. tolerance: of force residual and displacement correction; None takes ccx's own (0.005
    and 0.01). Raises InputError for a law that ccx lacks.
    """
    if law not in LAWS:
        raise InputError(
            f"material.law = {law!r}: CalculiX has no such law; allowed: {', '.join(sorted(LAWS))}"
        )
    prescribed, values = mesh.imposed()
    lines = ["*HEADING", " ".join(title.split()), "*NODE, NSET=ALL"]
    for i, point in enumerate(mesh.points):
        lines.append(f"{i + 1}, " + ", ".join(map(_number, point)))
    lines.append(f"*ELEMENT, TYPE={element}, ELSET=ALL")
    # VTK and ccx number the vertices of a brick alike.
    for i, nodes in enumerate(mesh.cells):
        lines.append(f"{i + 1}, " + ", ".join(str(node + 1) for node in nodes))
    lines += ["*MATERIAL, NAME=SOLID", *LAWS[law](material)]
    lines += ["*SOLID SECTION, ELSET=ALL, MATERIAL=SOLID"]
    lines += [f"*STEP, NLGEOM, INC={MOST_INCREMENTS}", "*STATIC", f"{FIRST_INCREMENT:g}, 1"]
    if tolerance is not None:
        # The first two numbers: largest residual and largest correction, relative.
        lines += ["*CONTROLS, PARAMETERS=FIELD", f"{tolerance:g}, {tolerance:g}"]
    lines.append("*BOUNDARY")
    for node, axis in np.argwhere(prescribed):
        lines.append(f"{node + 1}, {axis + 1}, {axis + 1}, {_number(values[node, axis])}")
    # Of all increments only the last is written, which ccx always does.
    lines += [f"*NODE FILE, FREQUENCY={MOST_INCREMENTS}", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


def _number(value):
    """A number for ccx, which reads the first 20 characters of a field: never longer than that."""
    return f"{value:.12e}"


def read_displacement(path, n_nodes):
    """The last displacement block of a result file of ccx (.frd, ASCII): (n_nodes, 3) in m.

    ccx writes six digits. Raises InputError naming the line and the rule when the file cannot be
    read, has no such block, or the block has not each node 1..n_nodes once with three numbers.
    """
    found, block, inside, ended = {}, 0, False, False
    for number, line in enumerate(_text(path).splitlines(), start=1):
        if line.startswith(" -4"):
            inside = line.split()[1:2] == ["DISP"]
            if inside:
                found, block, ended = {}, number, False
        elif inside and line.startswith(" -3"):
            inside, ended = False, True
        elif inside and line.startswith(" -1"):
            # Neighbours may touch: fields are 12 wide, and a sign fills the whole of one.
            node, numbers = line[3:13].strip(), NUMBER.findall(line[13:])
            whole = "".join(numbers) == "".join(line[13:].split())
            if not (node.isdigit() and whole and len(numbers) == 3):
                raise InputError(
                    f"{path}:{number}: {line.strip()!r}: ' -1', a node number and three numbers "
                    "are required"
                )
            if not 1 <= int(node) <= n_nodes or int(node) in found:
                raise InputError(
                    f"{path}:{number}: node {node}: every node 1..{n_nodes} is required once"
                )
            found[int(node)] = [float(word) for word in numbers]
    if not block:
        raise InputError(f"{path}: no displacements: a block ' -4  DISP' is required")
    if not ended:
        raise InputError(f"{path}:{block}: the block DISP has no end: ' -3' is required")
    if len(found) != n_nodes:
        lacking = next(node for node in range(1, n_nodes + 1) if node not in found)
        raise InputError(f"{path}:{block}: the block DISP lacks node {lacking} of 1..{n_nodes}")
    return np.array([found[node] for node in range(1, n_nodes + 1)])


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
    Raises DivergenceError when ccx finds no equilibrium, InputError when its files are damaged.
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
        raise DivergenceError(f"CalculiX ended with {done.returncode}: {reason}")
    increments, iterations, reached = read_progress(folder / "case.sta")
    if reached != 1:
        raise DivergenceError(f"CalculiX stopped at {reached:.4f} of the load")
    version = re.search(r"CalculiX Version ([\w.]+)", done.stdout)
    return Solution(
        read_displacement(folder / "case.frd", n_nodes),
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
        raise InputError(f"{path}: cannot read what CalculiX wrote: {error}") from error
