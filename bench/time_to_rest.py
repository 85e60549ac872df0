"""Seconds to the answer of a quasi-static case: FEniCSx, CalculiX and Sandglass, in one run.

Usage: /usr/bin/python3 bench/time_to_rest.py [CASE] [--json FILE]
Needs the solver's binary: build/release/sandglass, or the one given by SANDGLASS_BINARY.
Programs that are not installed are named and skipped.
Exit codes: 0 done, 2 bad usage or input, 3 a computation failed (the others are still shown).
"""

import argparse
import importlib.util
import os
import shutil
import sys
import tempfile
import time
import types
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]
if importlib.util.find_spec("ufl") is None:
    # The list of laws, needed to check the case file, imports UFL. Without FEniCSx its energies are
    # never called, but the import must not fail.
    sys.modules["ufl"] = types.ModuleType("ufl")

import rest_records
from case_file import read_case
from common.accuracy import relative_errors
from common.command import exit_code, whole_number
from common.errors import ComputationError, InputError, suggestion
from common.files import read_toml, require_writable, write_json
from common.program import CASES, ROOT, binary, output_of
from common.result_file import last_displacement
from exchange import frd_file
from mesh_file import load_case_mesh, make_mesh
from reference_file import path_of, read_reference
from rivals.calculix import PROGRAM, CalculiX

METHODS = ("tl-mean-dilatation", "tl-perturbation")
ELEMENTS = ("C3D8", "C3D8R")
THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
NOTES = """
Seconds are wall time. Distances are max |u - u'| over the nodes / largest imposed displacement.
to 1 %, 0.1 %: from the start of the solution until u stays that close to the method's final u.
For Sandglass: the corresponding share of its force evaluations, times its seconds to rest.
to rest: until the method stops. FEniCSx: correction < 1e-10. CalculiX: residual and correction
< 1e-8; wall time of the process, including reading and set-up. Sandglass: residual < 1e-8, in
float also the rounding; median of three runs.
evaluations: of the forces, by Sandglass. load steps, iterations: of Newton's method, by
implicit programs.
""".strip()


class Unavailable(Exception):
    """A program is not installed or cannot run the case: it is named and skipped."""


class Job:
    """Shared by all programs: the case, its mesh, a working folder, an environment, options."""

    def __init__(self, options, folder):
        self.options, self.folder = options, Path(folder)
        self.path = case_path(options.case)
        require_quasi_static(self.path)
        self.case = read_case(self.path)
        self.mesh_path = self.folder / "mesh.h5"
        make_mesh(self.path, self.mesh_path)
        self.mesh, self.mesh_file = load_case_mesh(self.case, self.mesh_path)
        threads = {name: str(options.threads) for name in THREAD_VARIABLES}
        self.environment = {**os.environ, **threads}
        self.versions, self.records, self.exit_code = {}, [], 0
        self.displacements = []  # (record, displacement): to be compared with the golden
        self.golden = None

    def fail(self, text):
        """Report a failed computation; the others continue."""
        print(f"error: {self.case.name}: {text}", file=sys.stderr, flush=True)
        self.exit_code = 3


def case_path(name):
    """The absolute path of a case, given as a file or as the name of a case in cases/.

    Raises InputError.
    """
    for path in (Path(name), CASES / f"{name}.toml"):
        if path.is_file():
            return path.resolve()
    known = sorted(path.stem for path in CASES.glob("*.toml"))
    raise InputError(
        f"CASE: '{name}' is neither a file nor a known case; {suggestion(name, known)}"
    )


def require_quasi_static(path):
    """Raise InputError unless the case is quasi-static."""
    answer = read_toml(path)["case"].get("answer")
    if answer != "quasi-static":
        raise InputError(f"{path}: case.answer = {answer!r} must be 'quasi-static'")


def time_golden(job):
    """Adds the golden's records, with FEniCSx, and keeps the golden. Raises Unavailable."""
    if importlib.util.find_spec("dolfinx") is None:
        raise Unavailable("dolfinx is not installed; package python3-dolfinx (ci/setup test)")
    if not any(Path("/usr/lib").glob("*/openblas-pthread/libopenblas.so.0")):
        note("package libopenblas0-pthread is not installed: FEniCSx is several times slower")
    for steps in job.options.load_steps:
        try:
            timed, displacement = _golden(job, steps)
        except ComputationError as error:
            job.fail(error)
            continue
        if job.golden is None:
            job.golden = displacement
        job.records.append(timed)
        job.displacements.append((timed, displacement))


def _golden(job, load_steps):
    """(record, displacement (n, 3) in m) of the golden with load_steps; 0: the reference's number.

    Raises ComputationError.
    """
    folder = job.folder / f"golden-{load_steps}"
    folder.mkdir()
    output = folder / "golden.npz"
    command = [sys.executable, ROOT / "bench" / "golden_timing.py", job.path]
    command += ["--mesh", job.mesh_path, "-o", output]
    if load_steps:
        command += ["--load-steps", load_steps]
    # An empty cache, so that compilation does not depend on earlier runs.
    environment = {**job.environment, "XDG_CACHE_HOME": str(folder / "cache")}
    started = time.perf_counter()
    output_of(*command, env=environment)
    seconds = time.perf_counter() - started
    with np.load(output) as found:
        figures = {key: found[key].item() for key in found if key != "displacement"}
        displacement = found["displacement"]
    job.versions["dolfinx"] = figures.pop("version")
    timed = rest_records.record(
        program="FEniCSx",
        case=job.case.name,
        method=f"Q1-P0, load steps: {load_steps}" if load_steps else "golden Q1-P0",
        precision="double",
        load_steps=figures.pop("load_steps"),
        process_seconds=seconds,
        **figures,
    )
    return timed, displacement


def time_calculix(job):
    """Adds a record of CalculiX for every requested element. Raises Unavailable."""
    path = shutil.which(PROGRAM)
    if path is None:
        raise Unavailable(
            f"{PROGRAM} is not installed; package {CalculiX.package} (ci/setup bench)"
        )
    program = CalculiX([path])
    program.environment = job.environment
    for element in job.options.elements:
        deck = job.folder / element / "deck.inp"
        deck.parent.mkdir()
        words = ["mesh", job.path, "--deck", program.deck, "--element", element, "-o", deck]
        try:
            output_of(binary(), *words)
        except InputError as error:
            raise Unavailable(str(error)) from error
        try:
            run = program.run(deck, None)
        except ComputationError as error:
            job.fail(f"{element}: {error}")
            continue
        job.versions["ccx"] = program.version
        timed = rest_records.record(
            program=program.name,
            case=job.case.name,
            method=element,
            precision="double",
            load_steps=run.steps,
            iterations=run.iterations,
            seconds_to_rest=run.seconds,
            process_seconds=run.seconds,
        )
        job.records.append(timed)
        displacement = frd_file.read_displacement(run.answer, len(job.mesh.points))
        job.displacements.append((timed, displacement))


def time_sandglass(job):
    """Adds the records of `sandglass bench --rest`. Raises ComputationError or InputError."""
    solver = binary()
    job.versions["sandglass"] = version_of(solver)
    output = job.folder / "rest.json"
    try:
        output_of(solver, "bench", "--rest", job.path, "--json", output)
    except ComputationError as error:
        job.fail(error)
    # The file contains the runs that came to rest, even if others did not.
    records = rest_records.read_solver_records(output) if output.exists() else []
    for timed in records:
        if timed["precision"] == "double" and timed["method"] in METHODS:
            # Run again for the displacement: writing frames must not count.
            result = job.folder / f"{timed['method']}.h5"
            output_of(solver, "run", job.path, "-m", timed["method"], "-o", result)
            job.displacements.append((timed, last_displacement(result)))
    job.records += records


PROGRAMS = {"golden": time_golden, "calculix": time_calculix, "sandglass": time_sandglass}


def compare(job):
    """Fill in every record's distance from the golden of this run or, if none, the stored one.

    Raises InputError if the stored one is damaged.
    """
    golden = job.golden
    if golden is None:
        stored = path_of("golden", job.case.name)
        if not stored.exists():
            note("no golden: distances are not computed")
            return
        _, golden, attributes = read_reference(stored)
        if attributes["mesh_hash"] != job.mesh_file.mesh_hash or (
            attributes["case_hash"] != job.mesh_file.case_hash
        ):
            note(f"{stored}: belongs to another version of the case: distances are not computed")
            return
        note(f"compared with the stored golden {stored}")
    unit = job.mesh.largest_imposed() or np.linalg.norm(golden, axis=1).max()
    for timed, displacement in job.displacements:
        errors = relative_errors(displacement, golden, unit)
        timed["error_to_golden_max"], timed["error_to_golden_rms"] = map(float, errors)


def version_of(solver):
    """The version that the solver's binary reports."""
    return output_of(solver, "--version").split(maxsplit=1)[-1].strip()


def machine(threads):
    """The machine that the seconds were measured on, as a dict."""
    name = "unknown"
    if os.path.exists("/proc/cpuinfo"):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                name = line.partition(": ")[2]
                break
    return {
        "processor": name,
        "cores": os.cpu_count(),
        "threads_of_implicit_programs": threads,
        "load_average_before": os.getloadavg()[0],
    }


def note(text):
    """Print a message that is not an error."""
    print(f"note: {text}", file=sys.stderr, flush=True)


def show(job, place):
    """Print the measurements and the machine. place: from machine()."""
    loads = f"{place['load_average_before']:.2f} to {place['load_average_after']:.2f}"
    print(f"{job.case.name}: {len(job.mesh.points)} nodes, {len(job.mesh.cells)} elements")
    print(
        f"on {place['processor']}, {place['cores']} cores, load {loads}; implicit programs with "
        f"{place['threads_of_implicit_programs']} threads, Sandglass with one"
    )
    print(", ".join(f"{name} {version}" for name, version in job.versions.items()))
    print(f"\n{rest_records.table(job.records)}\n\n{NOTES}")


def measure(options):
    """Measure, print, store. Returns the exit code. Raises InputError."""
    if options.json:
        require_writable(options.json)
    place = machine(options.threads)
    with tempfile.TemporaryDirectory() as folder:
        job = Job(options, folder)
        for name in options.programs:
            print(f"{job.case.name}: {name}", file=sys.stderr, flush=True)
            try:
                PROGRAMS[name](job)
            except Unavailable as reason:
                note(f"{name} is skipped: {reason}")
            except ComputationError as error:
                job.fail(error)
        place["load_average_after"] = os.getloadavg()[0]
        compare(job)
    if job.records:
        show(job, place)
    if options.json:
        document = {**place, "versions": job.versions, "records": job.records}
        write_json(options.json, document)
    return job.exit_code


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Seconds to the answer of a case: FEniCSx, CalculiX and Sandglass in one run.",
        epilog="exit codes: 0 done, 2 bad usage or input, 3 a computation failed",
    )
    add = parser.add_argument
    add("case", nargs="?", metavar="CASE", default="ellipsoid-indentation", help="name or file")
    add("--json", metavar="FILE", help="write the records and the machine to this file")
    add("--programs", nargs="+", choices=PROGRAMS, default=list(PROGRAMS), help="default: all")
    add("--elements", nargs="+", choices=ELEMENTS, default=["C3D8"], help="of CalculiX")
    add(
        "--load-steps",
        nargs="+",
        type=whole_number(0),
        default=[0, 1],
        metavar="N",
        help="of FEniCSx, timed in turn; 0: those of the reference; default: 0 1, as one is faster",
    )
    add(
        "--threads",
        type=whole_number(1),
        default=len(os.sched_getaffinity(0)),
        metavar="N",
        help="of each implicit program; default: all processors",
    )
    return exit_code(measure, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
