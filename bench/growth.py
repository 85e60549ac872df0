"""The growth of cost: seconds and evaluations to rest over mesh size and Poisson's ratio.

Usage: /usr/bin/python3 bench/growth.py [--json FILE] [--most N] [--most-implicit N]
A beam, clamped at one end and moved at the other, on ever finer meshes; Sandglass beside FEniCSx
and CalculiX, one thread each. Needs the solver: build/release/sandglass, or the one given by
SANDGLASS_BINARY. Programs that are not installed are named and skipped.
Exit codes: 0 done, 2 bad usage or input, 3 a computation failed (the others are still shown).
"""

import importlib.util
import os
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import measuring  # first: reference/ may then do without UFL

import peer_runs
from common.command import command_line, option, whole_number
from common.errors import ComputationError, InputError
from common.files import write_json
from rivals.calculix import CalculiX
from rivals.fenicsx import FEniCSx
from rivals.program import Element

METHODS = ("tl-mean-dilatation", "tl-perturbation")
RATIOS = (0.3, 0.49, 0.4999)
WIDTHS = (4, 8, 16, 24, 34)  # elements across the beam; five times as many along it
ROUNDS = 3
BEAM = Path(__file__).with_name("beam.toml.in").read_text()


def time_sandglass(path):
    """(method, seconds, evaluations, None) of every method, each the median of ROUNDS in turn."""
    found = {method: [] for method in METHODS}
    for _ in range(ROUNDS):
        for method in METHODS:
            evaluations, seconds, _ = measuring.rest_of(path, method, "--threads", "1")
            found[method].append((seconds, evaluations))
    for method, runs in found.items():
        yield method, statistics.median(seconds for seconds, _ in runs), runs[0][1], None


def implicit_programs():
    """FEniCSx and CalculiX, each with an element; names those that are not installed."""
    found = []
    has_fenicsx = importlib.util.find_spec("dolfinx") is not None
    for program, path, element in (
        (FEniCSx, sys.executable if has_fenicsx else None, "Q1-P0-in-1-step"),
        (CalculiX, shutil.which("ccx"), "C3D8"),
    ):
        if path is None:
            print(f"note: {program.name} is skipped: install {program.package}", file=sys.stderr)
        else:
            found.append((program([path]), Element(element)))
    return found


def time_implicit(path, folder, versions, programs):
    """(program, seconds, None, Newton iterations) of each implicit program."""
    bench = peer_runs.Bench(path, folder)
    for program, element in programs:
        program.environment, program.processor = bench.environment, bench.processor
        run = peer_runs.run_of(bench, program, element, path)()
        versions[program.name] = program.version
        yield program.name, run.seconds, None, run.iterations


def time_beam(width, ratio, programs, versions):
    """Records of one mesh and Poisson's ratio from all programs that succeeded; an exit code."""
    found, code = [], 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "beam.toml"
        text = BEAM.format(width=width, length=5 * width, ratio=ratio)
        path.write_text(text, encoding="utf-8")
        try:
            found += time_sandglass(path)
            found += time_implicit(path, folder, versions, programs) if programs else ()
        except ComputationError as error:
            print(f"error: {5 * width**3} elements: {error}", file=sys.stderr, flush=True)
            code = 3
    keys = "poisson_ratio", "elements", "name", "seconds", "evaluations", "iterations"
    return [dict(zip(keys, (ratio, 5 * width**3, *of), strict=True)) for of in found], code


def measure(options):
    """Measures, prints, stores. Returns the exit code. Raises InputError."""
    smallest = 5 * WIDTHS[0] ** 3
    if options.most < smallest:
        raise InputError(f"--most: {options.most} is less than {smallest}, the smallest mesh")
    place, records, worst = measuring.machine(), [], 0
    implicit = implicit_programs() if options.most_implicit >= smallest else []
    for ratio in RATIOS:
        for width in WIDTHS:
            if 5 * width**3 > options.most:
                continue
            programs = implicit if 5 * width**3 <= options.most_implicit else []
            found, code = time_beam(width, ratio, programs, place["versions"])
            worst = max(worst, code)
            records += found
            for of in found:
                kind = "evaluations" if of["iterations"] is None else "iterations"
                words = "{poisson_ratio:<7} {elements:>7} {name:<20} {seconds:9.3f} s"
                print(words.format(**of), f"{of[kind]:5} {kind}", flush=True)
    place["load_average_after"] = os.getloadavg()[0]
    if options.json:
        write_json(options.json, {**place, "records": records})
    return worst


main = command_line(
    measure,
    __doc__,
    measuring.JSON,
    option("--most", type=whole_number(1), default=200_000, metavar="N", help="elements"),
    option(
        "--most-implicit",
        type=whole_number(0),
        default=3000,
        metavar="N",
        help="elements of the largest mesh for FEniCSx and CalculiX (default: 3000; 20480 takes "
        "them minutes and gigabytes)",
    ),
)

if __name__ == "__main__":
    sys.exit(main())
