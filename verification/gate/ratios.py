"""Times two programs in turn and prints how their steps compare, with an interval of 99 %.

Usage: /usr/bin/python3 verification/gate/ratios.py BEFORE AFTER [--processes N] [--most PERCENT]
BEFORE and AFTER are two builds of `sandglass`. README.md beside this file explains the figures.
Exit codes: 0 no method is slower, 1 one is, 2 bad usage or input, 3 a program failed.
"""

import statistics
import sys
import tempfile
from pathlib import Path

from scipy.stats import binom

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parents[2]))

from common.command import command_line, option, whole_number
from common.errors import ComputationError, InputError
from common.files import read_json
from common.program import output_of

CONFIDENCE = 0.99
FEWEST = 8  # with fewer samples even their whole range contains the median with less confidence
# A mesh that fits into the cache, so that the comparison is of arithmetic and not of other
# programs' memory traffic. Many short processes are better than few long ones: the placement of a
# program in memory changes its best times by 1 %.
BENCH = ("--elements", 600, "--threads", 1, "--repetitions", 20)


def interval(samples):
    """(low, median, high) of FEWEST samples or more: contains the median of their distribution.

    A sample is below the median as often as above: how many of n are is binomial, and so is the
    chance that the median lies outside the range of samples without the k least and k greatest.
    """
    left_out = int(binom.ppf((1.0 - CONFIDENCE) / 2.0, len(samples), 0.5)) - 1
    samples = sorted(samples)
    return samples[left_out], statistics.median(samples), samples[-1 - left_out]


def times(program, folder):
    """(method, precision) -> best ns of an element and step in one process of `bench`."""
    file = Path(folder) / "bench.json"
    output_of(program, "bench", *BENCH, "--json", file)
    return {
        (r["method"], r["precision"]): r["ns_best"]
        for r in read_json(file)["records"]
        if r["ns_best"]
    }


def ratios(before, after, processes):
    """(method, precision) -> ratios of the times of two programs that take turns."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(processes):
            print(f"processes {number + 1} of {processes}", file=sys.stderr, flush=True)
            # Each goes first in turn, so that the other's effect on the machine evens out.
            order = (before, after) if number % 2 else (after, before)
            timed = {program: times(program, folder) for program in order}
            for key in timed[before].keys() & timed[after].keys():
                found.setdefault(key, []).append(timed[after][key] / timed[before][key])
    if not found:
        raise ComputationError("the programs have no method in common that was timed")
    return found


def run(options):
    """Prints the table; returns the exit code. Raises InputError and ComputationError."""
    for program in (options.before, options.after):
        if not program.is_file():
            raise InputError(f"{program}: no program there")
    if options.before.resolve() == options.after.resolve():
        raise InputError(f"{options.after}: must be another program than BEFORE")
    found = ratios(options.before, options.after, options.processes)
    slower = 0
    for (method, precision), samples in sorted(found.items()):
        low, median, high = interval(samples)
        is_slower = low > 1.0 + options.most / 100.0
        slower += is_slower
        said = "  SLOWER" if is_slower else "  faster" if high < 1.0 else ""
        print(f"{method:<26} {precision:<7} {median:.3f}  ({low:.3f} to {high:.3f}){said}")
    count = f"{slower} are more than {options.most:g} % slower"
    print(f"{len(found)} ratios of after over before; {count}")
    return 1 if slower else 0


main = command_line(
    run,
    __doc__,
    option("before", type=Path, metavar="BEFORE", help="a build of sandglass"),
    option("after", type=Path, metavar="AFTER", help="another one"),
    option("--processes", type=whole_number(FEWEST), default=12, metavar="N", help="of each (12)"),
    option(
        "--most", type=float, default=1.0, metavar="PERCENT", help="how much slower is allowed (1)"
    ),
    prog="ratios.py",
)


if __name__ == "__main__":
    sys.exit(main())
