"""A block touched in the middle: the time that sleep saves, and the error it makes.

Usage: /usr/bin/python3 bench/local_touch.py [--elements NX NY NZ] [--shares 1% 0.1%] [--case FILE]
       /usr/bin/python3 bench/local_touch.py --survey 36
Runs `sandglass run` without and with each --sleep, in turn, and prints medians of the wall time and
the largest difference of displacements over all nodes, in percent of the depth.
--case keeps the case file, for other commands. --survey runs random blocks, patches, Poisson's
ratios and methods at 10 %, 2 % and 0.4 % and prints the error made over the error allowed.
The binary is build/release/sandglass, or the one given by SANDGLASS_BINARY.
Exit codes: 0 done, 2 bad usage or input, 3 a run failed.
"""

import random
import re
import statistics
import sys
import tempfile
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option, whole_number
from common.result_file import last_displacement
from measuring import rest_of

EDGE = 0.002  # m, of an element

CASE = Path(__file__).with_name("touched-block.toml.in").read_text()


def case_text(elements, patch, depth, poisson_ratio=0.49):
    """A block with this many elements, of which patch x patch are pushed in by depth (m)."""
    middle = [EDGE * (n // 2) for n in elements[:2]]
    reach = EDGE * (patch / 2 + 0.1)
    numbers = {
        "size": ", ".join(f"{EDGE * n:.6g}" for n in elements),
        "elements": ", ".join(map(str, elements)),
        "z": f"{EDGE * elements[2]:.6g}",
        "depth": f"{-depth:.6g}",
        "poisson_ratio": poisson_ratio,
    }
    for name, centre in zip("xy", middle):
        numbers[name] = f"{centre - reach:.6g}, {centre + reach:.6g}"
    return CASE.format(**numbers)


def run(case, method, folder, share=None):
    """Seconds, share of the elements awake and displacements (n, 3), m, of one run.

    Raises InputError or ComputationError if the solver does.
    """
    result = Path(folder) / "result.h5"
    sleep = ["--sleep", share] if share else []
    _, seconds, text = rest_of(case, method, "--output", result, *sleep)
    awake = re.search(r"awake: (\d+) of (\d+)", text)
    share_awake = int(awake[1]) / int(awake[2]) if awake else 1.0
    return seconds, share_awake, last_displacement(result)


def measure(case, method, shares, repetitions):
    """For None (no sleep) and each share: all seconds, the share awake, the displacements."""
    rows = {share: ([], 1.0, None) for share in [None, *shares]}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(repetitions):
            for share, (seconds, _, _) in rows.items():
                clocked, awake, u = run(case, method, folder, share)
                rows[share] = (seconds + [clocked], awake, u)
    return rows


def table(rows, depth):
    """The lines of the table; the run without sleep comes first."""
    whole, _, u = rows[None]
    lines = [
        f"{'may neglect':>12} {'awake %':>8} {'s (range)':>22} {'speed-up':>9} {'neglects %':>11}"
    ]
    for share, (seconds, awake, local) in rows.items():
        clocked = f"{statistics.median(seconds):.3g} ({min(seconds):.3g} to {max(seconds):.3g})"
        gain = statistics.median(whole) / statistics.median(seconds)
        neglected = 100 * np.linalg.norm(local - u, axis=1).max() / depth
        name = share or "nothing"
        lines.append(f"{name:>12} {100 * awake:8.3g} {clocked:>22} {gain:9.3g} {neglected:11.3g}")
    return lines


def touch(options):
    """The lines about the block given by the options."""
    with tempfile.TemporaryDirectory() as folder:
        case = options.case or Path(folder) / "touched-block.toml"
        case.write_text(case_text(options.elements, options.patch, options.depth))
        rows = measure(case, options.method, options.shares, options.repetitions)
    title = f"{' x '.join(map(str, options.elements))} elements, {options.method}"
    return [title, *table(rows, options.depth)]


def survey(count):
    """The lines about this many random blocks: the median, and the five worst."""
    draw = random.Random(3)
    found = []
    for _ in range(count):
        elements = [draw.choice([32, 48, 64]) for _ in range(2)] + [
            draw.choice([2, 3, 4, 6, 8, 12])
        ]
        patch, depth = draw.choice([0, 2, 4, 8]), EDGE * draw.choice([0.25, 0.5, 1.0])
        poisson_ratio = draw.choice([0.3, 0.45, 0.49, 0.499])
        method = draw.choice(["tl-perturbation", "linear", "tl-mean-dilatation"])
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "block.toml"
            case.write_text(case_text(elements, patch, depth, poisson_ratio))
            _, _, u = run(case, method, folder)
            for share in (0.1, 0.02, 0.004):
                _, awake, local = run(case, method, folder, str(share))
                ratio = np.linalg.norm(local - u, axis=1).max() / depth / share
                block = f"{' x '.join(map(str, elements))}, {patch} x {patch} faces by {depth:g} m"
                text = f"{block}, nu {poisson_ratio}, {method}, {100 * share:g} %"
                found += [(ratio, text)] if awake < 1.0 else []
    found.sort(reverse=True)
    median = statistics.median(ratio for ratio, _ in found)
    head = (
        f"{len(found)} runs in which something slept; neglected over allowed: median {median:.2f}"
    )
    return [head] + [f"{ratio:6.2f}  {text}" for ratio, text in found[:5]]


def show(options):
    """Measures and prints. Raises InputError or ComputationError."""
    print("\n".join(survey(options.survey) if options.survey else touch(options)))


COUNT = whole_number(1)
main = command_line(
    show,
    __doc__,
    option("--elements", nargs=3, type=COUNT, default=[182, 182, 6], metavar=("NX", "NY", "NZ")),
    option("--patch", type=COUNT, default=4, help="touched faces along x and y"),
    option("--depth", type=float, default=EDGE, help="of the touch, m"),
    option("--method", default="tl-perturbation"),
    option("--shares", nargs="+", default=["1%", "0.1%"], help="what to neglect"),
    option("--repetitions", type=COUNT, default=3),
    option("--case", type=Path, help="keep the case file there"),
    option("--survey", type=COUNT, metavar="N", help="run N random blocks instead"),
)

if __name__ == "__main__":
    sys.exit(main())
