"""Seconds per simulated second: predicted by `sandglass choose`, and measured by a simulation.

Usage: /usr/bin/python3 bench/real_time.py [CASE...] [--methods M...] [--json FILE]
For each quasi-static case `choose --realtime --all` predicts the cost of a simulated second on the
case's own mesh. Then a `Simulation` of the Python module follows the same damped motion, frame by
frame, with every method, in double and in float, and its processor time is measured. Pairs that
differ by more than 30 % are measured twice more, both ways, since other programs may have run at
the time, and the medians count. Prints both and their ratio; "off" marks those that still differ.
Needs the Python module (build/release/python, or the folder in SANDGLASS_PYTHON_FOLDER).
Exit codes: 0 all are within 30 %, 1 one is off, 2 bad usage or input, 3 a computation failed.
"""

import json
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option, writable
from common.files import write_json
from common.program import CASES, ROOT, binary, output_of

CANONICAL = (
    "column",
    "twist",
    "ellipsoid-indentation",
    "ellipsoid-touch",
    "cylinder-compression",
    "cylinder-stretch",
)
WITHIN = 0.3
STEPS = 10  # of a frame; driven nodes move at its end
FOLDER = os.environ.get("SANDGLASS_PYTHON_FOLDER", str(ROOT / "build" / "release" / "python"))


def predictions(case, methods, folder):
    """(motion, candidates) of `choose`: those on the own mesh with a step and automatic kappa.

    motion: duration (s) and damping (1/s) of the case's own motion. candidates: its records.
    """
    file = Path(folder) / "choice.json"
    words = [binary(), "choose", case, "--realtime", "--all", "--json", file]
    if methods:
        words += ["--methods", *methods]
    output_of(*words, allowed=(0, 1))
    document = json.loads(file.read_text())
    candidates = [
        candidate
        for candidate in document["rungs"]
        if candidate["mesh"] == "own mesh" and candidate["step_size"] and candidate["kappa"] is None
    ]
    return document["own_motion"], candidates


def smooth(share):
    """The loading curve, eq. 15 of the paper."""
    return share**3 * (10 - 15 * share + 6 * share**2)


def case_with_method(case, candidate, folder):
    """A copy of the case that names the candidate's method and accuracy."""
    text = (CASES / f"{case}.toml").read_text()
    lines = ["", "[method]", f'name = "{candidate["method"]}"']
    if candidate["accuracy"] is not None:
        lines.append(f"accuracy = {candidate['accuracy']!r}")
    path = Path(folder) / f"{case}.toml"
    path.write_text(text + "\n".join(lines) + "\n")
    return path


def simulated(sandglass, path, precision, motion):
    """Processor seconds per simulated second of the case's own motion: the median of three
    simulations, or of as many as fit into half a second."""
    found = []
    while len(found) < 3 or sum(found) * motion["duration"] < 0.5:
        body = sandglass.Simulation(path, precision=precision, damping=motion["damping"])
        start = time.process_time()
        while body.time < motion["duration"]:
            frame = STEPS * body.step_size
            body.impose(smooth(min(1.0, (body.time + frame) / motion["duration"])))
            body.advance(frame)
        found.append((time.process_time() - start) / body.time)
    return statistics.median(found)


def measured(sandglass, case, methods):
    """{(method, accuracy, precision): (predicted, simulated)} in s per simulated second."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        motion, candidates = predictions(case, methods, folder)
        for candidate in candidates:
            path = case_with_method(case, candidate, folder)
            seconds = simulated(sandglass, path, candidate["precision"], motion)
            key = (candidate["method"], candidate["accuracy"], candidate["precision"])
            found[key] = (candidate["seconds_per_simulated_second"], seconds)
    return found


def is_near(pair):
    """Whether prediction and simulation agree."""
    predicted, seconds = pair
    return 1 / (1 + WITHIN) <= seconds / predicted <= 1 + WITHIN


def pairs_of(sandglass, case, methods):
    """As `measured`, but pairs that differed are medians of three measurements."""
    found = measured(sandglass, case, methods)
    far = {key: [pair] for key, pair in found.items() if not is_near(pair)}
    for _ in range(2 if far else 0):
        again = measured(sandglass, case, sorted({method for method, _, _ in far}))
        for key, pairs in far.items():
            pairs.append(again[key])
    return found | {
        key: tuple(map(statistics.median, zip(*pairs, strict=True))) for key, pairs in far.items()
    }


def work(options):
    """Predicts, simulates and prints. Returns the exit code."""
    sys.path.insert(1, FOLDER)
    import sandglass

    records = []
    ratios = []
    print(f"{'case':24}{'method':26}{'numbers':9}{'predicted':>10}{'simulated':>10}{'ratio':>7}")
    for case in options.cases or CANONICAL:
        for key, pair in pairs_of(sandglass, case, options.methods).items():
            method, accuracy, precision = key
            predicted, seconds = pair
            records.append(
                {
                    "case": case,
                    "method": method,
                    "accuracy": accuracy,
                    "precision": precision,
                    "predicted": predicted,
                    "simulated": seconds,
                }
            )
            ratios.append(seconds / predicted)
            name = f"{method} {accuracy:g}" if accuracy else method
            print(
                f"{case:24}{name:26}{precision:9}{predicted:10.4f}{seconds:10.4f}"
                f"{ratios[-1]:7.2f}{'' if is_near(pair) else '  off'}",
                flush=True,
            )
    if options.json:
        write_json(options.json, {"records": records})
    far = [record for record in records if not is_near((record["predicted"], record["simulated"]))]
    print(f"{len(ratios)} ratios from {min(ratios):.2f} to {max(ratios):.2f}, {len(far)} off")
    return 1 if far else 0


main = command_line(
    work,
    __doc__,
    option("cases", nargs="*", help=f"quasi-static cases; {', '.join(CANONICAL)}"),
    option("--methods", nargs="+", default=[], help="only these"),
    option("--json", type=writable, help="write both to this file"),
)

if __name__ == "__main__":
    sys.exit(main())
