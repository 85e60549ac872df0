"""Compares the solver with its baseline: accuracy, operations, bits, memory, ratios of times.

Sources not given as files are run: SANDGLASS_BINARY, else build/release/sandglass.
Exit codes: 0 no regression, 1 a regression, 2 bad usage or input, 3 the solver failed.
"""

import argparse
import datetime
import sys
from pathlib import Path

from common.command import exit_code
from common.errors import InputError, suggestion

from . import baseline as baselines
from . import collect, tell
from .bench import read_bench
from .compare import compare, undecided
from .records import Run, read_bits, read_flops, read_verdicts

# The areas of figures that a source provides.
SOURCES = {
    "accuracy": ("accuracy",),
    "operations": ("operations",),
    "bits": ("bits",),
    "speed": ("forces", "memory", "speed"),
}


def arguments(given):
    """The command line, parsed. Raises InputError."""
    parser = argparse.ArgumentParser(prog="ci/gate", description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("sources", nargs="*", metavar="SOURCE", help=f"{', '.join(SOURCES)}; all when left out")
    baseline = "verification/gate/baseline.json"
    add("--baseline", type=Path, default=baseline, help="default: %(default)s")
    add(
        "--verdicts",
        metavar="FILE",
        action="append",
        help="of sandglass verify --json, instead of a run",
    )
    add("--flops", metavar="FILE", action="append", help="of sandglass flops --json")
    add("--bits", metavar="FILE", action="append", help="bits.json of an earlier run")
    add("--bench", metavar="FILE", nargs="+", help="of processes of sandglass bench --json")
    add(
        "--most", type=int, default=32, help="processes of bench when few cannot tell (%(default)s)"
    )
    add("-o", "--output", type=Path, default="build/gate", help="folder (default: %(default)s)")
    add("--accept", action="store_true", help="make what is found the baseline; needs --reason")
    add("--reason", help="why, for the baseline's history")
    options = parser.parse_args(given)
    for source in options.sources:
        if source not in SOURCES:
            raise InputError(f"SOURCE: '{source}' is not known; {suggestion(source, SOURCES)}")
    if options.accept and not (options.reason or "").strip():
        raise InputError("--accept: --reason TEXT is required: why is this the new baseline?")
    if options.reason and not options.accept:
        raise InputError("--reason: goes with --accept")
    if options.most < collect.PROCESSES:
        raise InputError(f"--most = {options.most} must be {collect.PROCESSES} or more")
    options.sources = options.sources or list(SOURCES)
    options.areas = [area for source in options.sources for area in SOURCES[source]]
    return options


def say(text):
    """Prints a line of progress."""
    print(f"gate: {text}", file=sys.stderr, flush=True)


def find(options, baseline):
    """The Run, from files or, if there are none, from the program."""
    run = Run()
    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    readers = {
        "accuracy": (options.verdicts, collect.verdicts, read_verdicts),
        "operations": (options.flops, collect.flops, read_flops),
        "bits": (options.bits, collect.bits, read_bits),
    }
    for source, (files, collected, read) in readers.items():
        if source not in options.sources:
            continue
        if not files:
            say(f"running for {source}")
            files = [collected(folder)]
        for file in files:
            run.add(file, *read(file))
    if "speed" in options.sources:
        files = options.bench or bench_files(options, baseline, folder)
        records, _, document = read_bench(files)
        run.add(files[0], records, document)
    return run


def bench_files(options, baseline, folder):
    """Files of as many processes of bench as a decision takes, at most `most`."""
    files = []
    while True:
        say(f"running for speed, process {len(files) + 1}")
        files.append(collect.bench(folder, f"bench-{len(files) + 1}"))
        if len(files) < collect.PROCESSES:
            continue
        records, machine, _ = read_bench(files)
        outcomes = compare(baseline, Run(records, machine=machine), ["speed"])
        if len(files) >= options.most or not (options.accept or undecided(outcomes)):
            return files


def gate(given):
    """Runs the gate; returns the exit code. Raises InputError or ComputationError."""
    options = arguments(given)
    known = options.baseline.exists() or not options.accept
    baseline = baselines.read(options.baseline) if known else baselines.Baseline()
    run = find(options, baseline)
    date = str(datetime.date.today())
    outcomes = compare(baseline, run, options.areas)
    tell.write_all(options.output, outcomes, baseline, run, date)
    if not options.accept:
        print(tell.table(outcomes))
        return 1 if any(outcome.fails for outcome in outcomes) else 0
    changed = baselines.accept(baseline, run, options.areas, options.reason, date)
    baselines.write(options.baseline, baseline)
    told = "; ".join(f"{area}: {what}" for area, what in changed.items()) or "nothing changed"
    print(f"accepted in {options.baseline}: {told}")
    return 0


def main(given=None):
    """The command line. Returns the exit code."""
    return exit_code(gate, given)


if __name__ == "__main__":
    sys.exit(main())
