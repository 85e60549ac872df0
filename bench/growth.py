"""The growth of cost: seconds and evaluations to rest over mesh size and Poisson's ratio.

Usage: /usr/bin/python3 bench/growth.py [--json FILE] [--most N] [--most-implicit N]
A beam, clamped at one end and moved at the other, on ever finer meshes; Sandglass beside FEniCSx
and CalculiX, one thread each. Needs the solver: build/release/sandglass, or the one given by
SANDGLASS_BINARY. Programs that are not installed are named and skipped.
Exit codes: 0 done, 2 bad usage or input, 3 a computation failed (the others are still shown).
"""

import argparse
import os
import statistics
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import rest_records
import time_to_rest
from common.command import exit_code, whole_number
from common.errors import ComputationError, InputError
from common.files import require_writable, write_json
from common.program import binary, output_of

METHODS = ("tl-mean-dilatation", "tl-perturbation")
RATIOS = (0.3, 0.49, 0.4999)
WIDTHS = (4, 8, 16, 24, 34)  # elements across the beam; five times as many along it
ROUNDS = 3
BEAM = """
[case]
name = "beam"
requirement = "A soft beam, clamped at one end, bends when its other end is moved."
answer = "quasi-static"

[mesh]
generator = "box"
size = [0.02, 0.02, 0.1]
elements = [{width}, {width}, {length}]

[material]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = {ratio}
density = 1000.0

[sets]
clamped = {{ z = [0.0, 0.0] }}
moved = {{ z = [0.1, 0.1] }}

[[displacement]]
set = "clamped"
value = [0.0, 0.0, 0.0]

[[displacement]]
set = "moved"
value = [0.03, 0.0, 0.0]
"""


def time_sandglass(job):
    """(method, seconds, evaluations, None) of every method, the median of ROUNDS in turn."""
    found = {method: [] for method in METHODS}
    for _ in range(ROUNDS):
        for method in METHODS:
            command = (binary(), "run", job.path, "-m", method, "--threads", "1")
            found[method].append(rest_records.read_run("beam", method, output_of(*command)))
    for method, runs in found.items():
        seconds = statistics.median(run["seconds_to_rest"] for run in runs)
        yield method, seconds, runs[0]["evaluations"], None


def time_implicit(job):
    """(program, seconds, None, Newton iterations) of FEniCSx and CalculiX."""
    for name in ("golden", "calculix"):
        try:
            time_to_rest.PROGRAMS[name](job)
        except time_to_rest.Unavailable as reason:
            time_to_rest.note(f"{name} is skipped: {reason}")
    for record in job.records:
        yield record["program"], record["seconds_to_rest"], None, record["iterations"]


def time_beam(width, ratio, options, versions):
    """Records of one mesh and Poisson's ratio, as far as the programs got, and an exit code."""
    elements, found = 5 * width**3, []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "beam.toml"
        text = BEAM.format(width=width, length=5 * width, ratio=ratio)
        path.write_text(text, encoding="utf-8")
        given = SimpleNamespace(case=path, threads=1, load_steps=[1], elements=["C3D8"])
        job = time_to_rest.Job(given, folder)
        try:
            found += time_sandglass(job)
            if elements <= options.most_implicit:
                found += time_implicit(job)
        except ComputationError as error:
            job.fail(error)
        versions |= job.versions
    keys = "poisson_ratio", "elements", "name", "seconds", "evaluations", "iterations"
    return [dict(zip(keys, (ratio, elements, *of), strict=True)) for of in found], job.exit_code


def measure(options):
    """Measure, print, store. Returns the exit code. Raises InputError."""
    smallest = 5 * WIDTHS[0] ** 3
    if options.most < smallest:
        raise InputError(f"--most: {options.most} is less than {smallest}, the smallest mesh")
    if options.json:
        require_writable(options.json)
    place, records, worst = time_to_rest.machine(1), [], 0
    versions = {"sandglass": time_to_rest.version_of(binary())}
    for ratio in RATIOS:
        for width in WIDTHS:
            if 5 * width**3 > options.most:
                continue
            found, code = time_beam(width, ratio, options, versions)
            worst = max(worst, code)
            records += found
            for of in found:
                kind = "evaluations" if of["iterations"] is None else "iterations"
                words = "{poisson_ratio:<7} {elements:>7} {name:<20} {seconds:9.3f} s"
                print(words.format(**of), f"{of[kind]:5} {kind}", flush=True)
    place["load_average_after"] = os.getloadavg()[0]
    if options.json:
        write_json(options.json, {**place, "versions": versions, "records": records})
    return worst


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Seconds and evaluations to rest over mesh size and Poisson's ratio.",
        epilog="exit codes: 0 done, 2 bad usage or input, 3 a computation failed",
    )
    add = parser.add_argument
    add("--json", metavar="FILE", help="write the records and the machine to this file")
    add("--most", type=whole_number(1), default=200_000, metavar="N", help="elements")
    add(
        "--most-implicit",
        type=whole_number(0),
        default=3000,
        metavar="N",
        help="elements of the largest mesh for FEniCSx and CalculiX (default: 3000; 20480 takes "
        "them minutes and gigabytes)",
    )
    return exit_code(measure, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
