"""Seconds per simulated second: what `sandglass choose` predicts beside what a simulation takes.

Usage: /usr/bin/python3 bench/real_time.py [CASE...] [--methods M...] [--json FILE]
For each quasi-static case `choose --realtime --all` predicts what a simulated second costs on the
case's own mesh. Then a `Simulation` of the Python module follows the same damped motion, frame by
frame, with every method, in double and in float, and its processor time is measured. Prints both
and their ratio; "off" marks those that differ by more than 30 %.
Needs the Python module (build/release/python, or the folder in SANDGLASS_PYTHON_FOLDER).
Exit codes: 0 all are within 30 %, 1 one is off, 2 bad usage or input, 3 a computation failed.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import exit_code
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
STEPS = 10  # of a frame, at whose end driven nodes are moved
FOLDER = os.environ.get("SANDGLASS_PYTHON_FOLDER", str(ROOT / "build" / "release" / "python"))


def predictions(case, methods, folder):
    """(motion, rungs) of `choose`: of the case's own mesh, as methods come, with a step.

    motion: duration (s) and damping (1/s) of the case's own motion. rungs: its records.
    """
    file = Path(folder) / "choice.json"
    words = [binary(), "choose", case, "--realtime", "--all", "--json", file]
    if methods:
        words += ["--methods", *methods]
    output_of(*words, allowed=(0, 1))
    document = json.loads(file.read_text())
    rungs = [
        rung
        for rung in document["rungs"]
        if rung["mesh"] == "own mesh" and rung["step_size"] and rung["kappa"] is None
    ]
    return document["own_motion"], rungs


def smooth(share):
    """The loading curve, eq. 15 of the paper."""
    return share**3 * (10 - 15 * share + 6 * share**2)


def case_with_method(case, rung, folder):
    """A copy of the case that names the rung's method and accuracy."""
    text = (CASES / f"{case}.toml").read_text()
    lines = ["", "[method]", f'name = "{rung["method"]}"']
    if rung["accuracy"] is not None:
        lines.append(f"accuracy = {rung['accuracy']!r}")
    path = Path(folder) / f"{case}.toml"
    path.write_text(text + "\n".join(lines) + "\n")
    return path


def simulated(sandglass, path, precision, motion):
    """Processor seconds per simulated second of a simulation of the case's own motion."""
    body = sandglass.Simulation(path, precision=precision, damping=motion["damping"])
    start = time.process_time()
    while body.time < motion["duration"]:
        frame = STEPS * body.step_size
        body.impose(smooth(min(1.0, (body.time + frame) / motion["duration"])))
        body.advance(frame)
    return (time.process_time() - start) / body.time


def work(options):
    """Predicts, simulates and prints. Returns the exit code."""
    sys.path.insert(1, FOLDER)
    import sandglass

    records = []
    print(f"{'case':24}{'method':26}{'numbers':9}{'predicted':>10}{'simulated':>10}{'ratio':>7}")
    with tempfile.TemporaryDirectory() as folder:
        for case in options.cases or CANONICAL:
            motion, rungs = predictions(case, options.methods, folder)
            for rung in rungs:
                path = case_with_method(case, rung, folder)
                seconds = simulated(sandglass, path, rung["precision"], motion)
                predicted = rung["seconds_per_simulated_second"]
                ratio = seconds / predicted
                records.append(
                    {
                        "case": case,
                        "method": rung["method"],
                        "accuracy": rung["accuracy"],
                        "precision": rung["precision"],
                        "predicted": predicted,
                        "simulated": seconds,
                    }
                )
                off = "" if 1 / (1 + WITHIN) <= ratio <= 1 + WITHIN else "  off"
                accuracy = f" {rung['accuracy']:g}" if rung["accuracy"] else ""
                print(
                    f"{case:24}{rung['method'] + accuracy:26}{rung['precision']:9}"
                    f"{predicted:10.4f}{seconds:10.4f}{ratio:7.2f}{off}",
                    flush=True,
                )
    if options.json:
        write_json(options.json, {"records": records})
    ratios = [record["simulated"] / record["predicted"] for record in records]
    far = [ratio for ratio in ratios if not 1 / (1 + WITHIN) <= ratio <= 1 + WITHIN]
    print(f"{len(ratios)} ratios from {min(ratios):.2f} to {max(ratios):.2f}, {len(far)} off")
    return 1 if far else 0


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", help=f"quasi-static cases; {', '.join(CANONICAL)}")
    parser.add_argument("--methods", nargs="+", default=[], help="only these")
    parser.add_argument("--json", type=Path, help="write both to this file")
    return exit_code(work, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
