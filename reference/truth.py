"""Truths: Taylor-Hood tetrahedra on meshes graded towards the edges of what is held and driven.

Usage: /usr/bin/python3 reference/truth.py CASE... [-o FILE]
Solves a case on meshes that become finer at those edges, and stores the finest answer with the
distance from the limit of the sequence. Needs the solver's binary, which makes the meshes.
Exit codes: 0 done, 2 bad usage or input, 3 no equilibrium found.
"""

import argparse
import dataclasses
import logging
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import dolfinx
import numpy as np

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

import newton
from case_file import find_case, read_case
from common.accuracy import relative_errors
from common.command import exit_code
from common.errors import ComputationError, InputError, suggestion
from common.files import require_writable
from common.program import CASES
from convergence import attributes_of
from mesh_file import load_case_mesh, make_mesh
from reference_file import path_of, write_reference
from solve import BOUNDARY_RULE, NEWTON_TOLERANCE
from symmetry import expand, halve
from taylor_hood import DEGREE, TaylorHoodProblem
from tetrahedra import cut


ASSUMED_ORDER = 1.0  # of two meshes: that of the singular edges


@dataclass(frozen=True)
class Grading:
    """The meshes of a truth: how often elements are split on each of them.

    edges: node set -> how often those at its edge are, a number for each mesh. layers: of elements
    there. whole: how often all elements are, on every mesh. parts: element set -> how often its
    elements are, a number for each mesh. steps: load steps from rest.
    """

    edges: dict
    layers: int = 1
    whole: int = 0
    parts: dict = dataclasses.field(default_factory=dict)
    steps: int = 1

    def tables(self, level):
        """The text to add to a case file for its mesh on a level, counted from 0."""
        text = "\n[element_sets.everything]\nx = [-inf, inf]\n"
        text += _refine("elements", "everything", self.whole)
        for name, splits in self.parts.items():
            text += _refine("elements", name, splits[level])
        for name, splits in self.edges.items():
            text += _refine("around", name, splits[level], f"layers = {self.layers}")
        return text

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
    "ellipsoid-indentation": Grading({"indenter": (0, 1, 2), "support": (0, 1, 1)}, steps=4),
    "ellipsoid-touch": Grading({"indenter": (1, 2, 3), "support": (1, 2, 3)}),
    "pressed-beam": Grading({"foot": (1, 2, 3)}, whole=1),
    "stiff-core": Grading(PLATES, whole=1, parts={"core": (1, 2, 3)}),
    "twist": Grading(PLATES, whole=1, steps=10),
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
        make_mesh(changed, Path(folder) / "mesh.h5", name)
        case = read_case(changed, name)
        mesh, _ = load_case_mesh(case, Path(folder) / "mesh.h5")
    return case, dataclasses.replace(mesh, ties=None)


def solve_levels(name, grading, mesh):
    """Displacements (n, 3) in m of a case on each level, at the nodes of its own HexMesh.

    Each mesh starts from the answer on the one before or, if that inverts elements, from rest.
    Returns (list of them, what the last mesh took: dict of attributes). Raises ComputationError.
    """
    n_nodes, unit = len(mesh.points), mesh.largest_imposed()
    fields, facts, coarse = [], {}, None
    for level in range(grading.levels()):
        started = time.perf_counter()
        case, graded = graded_mesh(name, grading, level)
        part, halves = halve(graded)
        problem = TaylorHoodProblem(cut(part), case.materials)
        if coarse:
            problem.start_from(coarse)
        try:
            outcome = newton.solve(problem, grading.steps, NEWTON_TOLERANCE, guessed=bool(coarse))
        except ComputationError as error:
            raise ComputationError(f"{name}, mesh {level + 1}: {error}") from error
        answer = expand(halves, problem.nodal_displacement()[: len(part.points)])
        fields.append(answer[:n_nodes])
        coarse = problem
        facts = {
            "law": ", ".join(material.law for material in case.materials),
            "mirror_planes": "".join("xyz"[half.axis] for half in halves),
            "refinements": max(splits[level] for splits in grading.edges.values()),
            "load_steps": outcome.load_steps,
            "newton_iterations": outcome.newton_iterations,
            "residual": outcome.residual,
            "last_correction": outcome.last_correction,
        }
        _report(name, level, problem, time.perf_counter() - started, fields, unit)
    return fields, facts


def _report(name, level, problem, seconds, fields, unit):
    """A line on what a mesh took and changed. unit: m, or 0 for the largest displacement."""
    text = f"{name}, mesh {level + 1}: {problem.size()}, {seconds:.0f} s"
    if len(fields) > 1:
        unit = unit or np.linalg.norm(fields[-1], axis=1).max()
        most, rms = relative_errors(fields[-2], fields[-1], unit)
        text += f", changed by {100 * most:.3g} % (rms {100 * rms:.3g} %)"
    print(text, flush=True)


def make_truth(name, output):
    """Computes a case's truth and stores it. Raises InputError or ComputationError."""
    started = time.perf_counter()
    logging.disable(logging.INFO)  # FFCx reports every compiler call otherwise
    if name not in GRADINGS:
        raise InputError(f"CASE: {name!r} has no meshes in GRADINGS; {suggestion(name, GRADINGS)}")
    require_writable(output)
    path = find_case(CASES, name)
    with tempfile.TemporaryDirectory() as folder:
        make_mesh(path, Path(folder) / "mesh.h5", name)
        mesh, file = load_case_mesh(read_case(path, name), Path(folder) / "mesh.h5")
    fields, facts = solve_levels(name, GRADINGS[name], mesh)
    displacement = fields[-1].copy()
    prescribed, values = mesh.imposed()
    displacement[prescribed] = values[prescribed]  # the same but for rounding
    unit = mesh.largest_imposed() or np.linalg.norm(displacement, axis=1).max()
    most, rms = relative_errors(fields[-2], displacement, unit)
    attributes = {
        "case": name,
        "case_hash": file.case_hash,
        "mesh_hash": file.mesh_hash,
        "kind": "truth",
        "element": "P2-P1",
        "quadrature": f"degree {DEGREE}",
        "boundary_rule": BOUNDARY_RULE,
        "largest_imposed": unit,
        "newton_tolerance": NEWTON_TOLERANCE,
        "dolfinx_version": dolfinx.__version__,
        "wall_seconds": time.perf_counter() - started,
        "discretisation_error_max": most,
        "discretisation_error_rms": rms,
        "discretisation_error_note": "difference to the mesh before",
        **facts,
        **attributes_of(fields, displacement, unit, "there are only two meshes", ASSUMED_ORDER),
    }
    write_reference(output, mesh.points, displacement, attributes)


def run(options):
    """Computes the named truths. Raises InputError or ComputationError."""
    if options.output and len(options.cases) > 1:
        raise InputError(f"-o: {options.output} is one file for {len(options.cases)} cases")
    for name in options.cases or GRADINGS:
        make_truth(name, options.output or path_of("truth", name))


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Compute truths with Taylor-Hood tetrahedra on graded meshes.",
        epilog="exit codes: 0 done, 2 bad usage or input, 3 no equilibrium found",
    )
    add = parser.add_argument
    add("cases", nargs="*", metavar="CASE", help="default: all in GRADINGS")
    add("-o", "--output", metavar="FILE", help="HDF5 file to write (default: the stored truth)")
    return exit_code(run, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
