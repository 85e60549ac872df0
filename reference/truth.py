"""Truths: Taylor-Hood tetrahedra on meshes graded towards the edges of held and driven sets.

Usage: /usr/bin/python3 reference/truth.py CASE... [-o FILE] [--keep FOLDER]
Solves a case on meshes that become finer at those edges, and stores the finest answer with the
distance from the limit of the sequence. Needs the solver's binary, which makes the meshes.
Exit codes: 0 done, 2 bad usage or input, 3 no equilibrium found.
"""

import dataclasses
import hashlib
import logging
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

import newton
from case_file import find_case
from common.accuracy import relative_errors
from common.command import command_line, option
from common.errors import ComputationError, InputError, suggestion
from common.files import require_writable, writing
from common.program import CASES
from convergence import attributes_of
from mesh_file import case_with_mesh
from reference_file import path_of, write_reference
from solve import NEWTON_TOLERANCE, origin
from symmetry import expand, halve
from taylor_hood import DEGREE, TaylorHoodProblem
from tetrahedra import cut


ASSUMED_ORDER = 1.0  # for two meshes: the order at singular edges


@dataclass(frozen=True)
class Grading:
    """The meshes of a truth: how often their elements are split.

    edges: node set -> number of splits at its edge on each mesh. layers: of elements there. whole:
    number of splits of all elements, on every mesh. parts: element set -> how often its elements
    are, a number for each mesh. steps: load steps. inside: the mesh, counted from 0, that
    is solved with a finer inside as well, None if that costs too much; its edges must be split more
    often than the rest. starts: mesh -> those whose answers it starts from, if not the one before.
    sequences: the meshes that show how fast the answer converges, all in one sequence if empty;
    what is left at the end of each is added up.
    """

    edges: dict
    layers: int = 1
    whole: int = 0
    parts: dict = dataclasses.field(default_factory=dict)
    steps: int = 1
    inside: int | None = 0
    starts: dict = dataclasses.field(default_factory=dict)
    sequences: tuple = ()

    def tables(self, level):
        """The text to add to a case file for its mesh on a level, counted from 0."""
        text = "\n[element_sets.everything]\nx = [-inf, inf]\n"
        text += _refine("elements", "everything", self.whole)
        for name, splits in self.parts.items():
            text += _refine("elements", name, splits[level])
        for name, splits in self.edges.items():
            text += _refine("around", name, splits[level], f"layers = {self.layers}")
        return text

    def with_finer_inside(self):
        """The Grading with all elements split once more, except the smallest ones at the edges."""
        return dataclasses.replace(self, whole=self.whole + 1, layers=2 * self.layers)

    def levels(self):
        """The number of meshes."""
        return len(next(iter(self.edges.values())))


def _refine(what, name, depth, more=""):
    """A table [[refine]], or nothing if nothing is split."""
    return f'[[refine]]\n{what} = "{name}"\ndepth = {depth}\n{more}\n' if depth else ""


PLATES = {"bottom": (1, 2, 3), "top": (1, 2, 3)}
GRADINGS = {
    "column": Grading({"bottom": (2, 3, 4), "top": (2, 3, 4)}, whole=1),
    "cylinder-stretch": Grading(PLATES),
    "ellipsoid-indentation": Grading(
        {"indenter": (0, 1, 0, 2, 2), "support": (0, 0, 1, 0, 1)},
        steps=4,
        inside=None,
        starts={2: [0], 3: [1], 4: [3, 2]},
        sequences=((0, 1, 3), (0, 2)),
    ),
    "ellipsoid-touch": Grading({"indenter": (1, 2, 3), "support": (1, 2, 3)}),
    "pressed-beam": Grading({"foot": (1, 2, 3)}, whole=1, inside=1),
    "stiff-core": Grading(PLATES, whole=1, parts={"core": (1, 2, 3)}, inside=1),
    "twist": Grading(PLATES, whole=1, steps=10, inside=1),
}
# Bars of all variants have elements of a quarter of their thickness.
for _elements, _whole in ((1, 2), (2, 1), (4, 0)):
    for _nu in ("0.25", "0.45", "0.49", "0.499"):
        _root = (_whole + 2, _whole + 3, _whole + 4)
        GRADINGS[f"bending-{_elements}-nu{_nu}"] = Grading({"root": _root}, layers=2, whole=_whole)


def graded_mesh(name, grading, level):
    """The Case and the HexMesh with hanging nodes (but no ties) of a case on a level."""
    path = find_case(CASES, name)
    with tempfile.TemporaryDirectory() as folder:
        changed = Path(folder) / path.name
        changed.write_text(path.read_text(encoding="utf-8") + grading.tables(level), "utf-8")
        case, mesh, _ = case_with_mesh(changed, name)
    return case, dataclasses.replace(mesh, ties=None)


def solve_levels(name, grading, mesh, keep=None):
    """Displacements (n, 3) in m of a case on each level, at the nodes of its own HexMesh.

    Each mesh starts from the answer on the one before, or on those that `starts` names, or, if that
    fails, undeformed. keep: as of an Answer. Returns (list of them; (n, 3), m, by how much a finer
    inside changes one, None if not measured; what the last mesh took: dict of attributes). Raises
    ComputationError.
    """
    answers, fields, inside = [], [], None
    for level in range(grading.levels()):
        starts = [answers[n] for n in grading.starts.get(level, range(level)[-1:])]
        answers.append(Answer(name, grading, level, starts, keep))
        fields.append(answers[-1].field[: len(mesh.points)])
        before = fields[max(grading.starts.get(level, [level - 1]))] if level else None
        report(f"{name}, mesh {level + 1}", answers[-1], before, fields[-1], mesh.largest_imposed())
        if level == grading.inside:
            finer = Answer(name, grading.with_finer_inside(), level, answers[-1:])
            there = finer.field[: len(mesh.points)]
            report(f"{name}, finer inside", finer, fields[-1], there, mesh.largest_imposed())
            inside = there - fields[-1]
    splits = max(splits[-1] for splits in grading.edges.values())
    return fields, inside, answers[-1].facts | {"refinements": splits}


class Answer:
    """The answer on a mesh of a Grading, started from Answers on others or undeformed.

    starts: list of Answers, at most two. keep: a folder where answers are stored, from which an
    interrupted run can be resumed. Attributes: problem; field (n, 3), m, at the nodes of the mesh
    with those that hang; facts (attributes of the file); seconds. Raises ComputationError.
    """

    def __init__(self, name, grading, level, starts, keep=None):
        started = time.perf_counter()
        case, graded = graded_mesh(name, grading, level)
        part, halves = halve(graded)
        self.problem = TaylorHoodProblem(cut(part), case.materials)
        outcome = None
        kept = keep and Path(keep) / f"{name}-{_digest(graded)}.npz"
        if kept and kept.exists():
            with np.load(kept) as found:
                self.problem.displacement.array[:] = found["state"]
                outcome, before = newton.Outcome(*found["outcome"]), float(found["seconds"])
                started -= before
        else:
            try:
                outcome = self._solve(starts, grading.steps)
            except ComputationError as error:
                raise ComputationError(f"{name}, mesh {level + 1}: {error}") from error
        self.field = expand(halves, self.problem.nodal_displacement()[: len(part.points)])
        self.facts = {
            "mirror_planes": "".join("xyz"[half.axis] for half in halves),
            **dataclasses.asdict(outcome),
        }
        self.seconds = time.perf_counter() - started
        if kept and not kept.exists():
            row = dataclasses.astuple(outcome)
            state = self.problem.displacement.array
            np.savez(kept, state=state, outcome=row, seconds=self.seconds)

    def _solve(self, starts, steps):
        """Solves for the answer. Returns an Outcome."""
        for number, start in enumerate(starts):
            share = self._share(*starts[::-1]) if number else None
            self.problem.start_from(start.problem, share)
        return newton.solve(self.problem, steps, NEWTON_TOLERANCE, guessed=bool(starts))

    def _share(self, one, other):
        """The weight of one of two Answers at the problem's nodes (n,): 1 where its mesh is finer
        than the other's, 0 where it is coarser."""
        points = [answer.problem.mesh.points for answer in (one, other)]
        size = np.ptp(points[0])
        gaps = []
        for here, there in (points, points[::-1]):
            own = here[cKDTree(there).query(here)[0] > 1e-9 * size]
            gaps.append(cKDTree(own).query(self.problem.mesh.points)[0])
        near = gaps[1] / (gaps[0] + gaps[1])
        return near**2 * (3 - 2 * near)


def _digest(mesh):
    """The name of a stored answer on a mesh."""
    return hashlib.sha256(mesh.points.tobytes() + mesh.cells.tobytes()).hexdigest()[:16]


def report(what, answer, before, after, unit):
    """A line on cost and change of a mesh. unit: m, or 0 for the largest displacement."""
    text = f"{what}: {answer.problem.size()}, {answer.seconds:.0f} s"
    if before is not None:
        unit = unit or np.linalg.norm(after, axis=1).max()
        most, rms = relative_errors(before, after, unit)
        text += f", changed by {100 * most:.3g} % (rms {100 * rms:.3g} %)"
    print(text, flush=True)


def error_bar(sequences, inside, unit):
    """The attributes that state how far a truth is from the exact answer.

    sequences: lists of fields (n, 3), m, coarse to fine. inside: as solve_levels() has it. unit: m,
    for relative errors. The remaining errors of the sequences, by Richardson's extrapolation, and
    the error of the inside are added, maxima and root mean squares: a finer inside changes the
    answer by 3/4 of that error if it reduces it to a quarter.
    """
    few = "there are only two meshes"
    bars = [attributes_of(fields, fields[-1], unit, few, ASSUMED_ORDER) for fields in sequences]
    note = " and ".join(one["own_error_note"] for one in bars)
    if inside is None:
        note, most, rms = f"edges alone: {note}", 0.0, 0.0
    else:
        most, rms = relative_errors(4 / 3 * inside, 0, unit)
        note = f"inside {100 * most:.2g} % (rms {100 * rms:.2g} %), edges: {note}"
    return bars[0] | {
        "own_error_max": most + sum(one["own_error_max"] for one in bars),
        "own_error_rms": rms + sum(one["own_error_rms"] for one in bars),
        "own_error_note": note,
    }


def make_truth(name, output, keep=None):
    """Computes a case's truth and stores it. Raises InputError or ComputationError.

    keep: as of an Answer.
    """
    started = time.perf_counter()
    logging.disable(logging.INFO)  # FFCx reports every compiler call otherwise
    if name not in GRADINGS:
        raise InputError(f"CASE: {name!r} has no meshes in GRADINGS; {suggestion(name, GRADINGS)}")
    require_writable(output)
    case, mesh, file = case_with_mesh(find_case(CASES, name), name)
    grading = GRADINGS[name]
    fields, inside, facts = solve_levels(name, grading, mesh, keep)
    orders = grading.sequences or (range(grading.levels()),)
    sequences = [[fields[level] for level in order] for order in orders]
    displacement = fields[-1].copy()
    prescribed, values = mesh.imposed()
    displacement[prescribed] = values[prescribed]  # the same except for rounding
    unit = mesh.largest_imposed() or np.linalg.norm(displacement, axis=1).max()
    most, rms = relative_errors(fields[-2], displacement, unit)
    attributes = origin(case, file, "truth", started) | {
        "element": "P2-P1",
        "quadrature": f"degree {DEGREE}",
        "largest_imposed": unit,
        "newton_tolerance": NEWTON_TOLERANCE,
        "discretisation_error_max": most,
        "discretisation_error_rms": rms,
        "discretisation_error_note": "difference to the mesh before",
        **facts,
        **error_bar(sequences, inside, unit),
    }
    write_reference(output, mesh.points, displacement, attributes)


def run(options):
    """Computes the named truths. Raises InputError or ComputationError."""
    if options.output and len(options.cases) > 1:
        raise InputError(f"-o: {options.output} is one file for {len(options.cases)} cases")
    if options.keep:
        with writing(options.keep):
            Path(options.keep).mkdir(parents=True, exist_ok=True)
    for name in options.cases or GRADINGS:
        make_truth(name, options.output or path_of("truth", name), options.keep)


main = command_line(
    run,
    __doc__,
    option("cases", nargs="*", metavar="CASE", help="default: all in GRADINGS"),
    option("-o", "--output", metavar="FILE", help="HDF5 file to write (default: the stored truth)"),
    option("--keep", metavar="FOLDER", help="where answers on each mesh are stored and searched"),
)


if __name__ == "__main__":
    sys.exit(main())
