"""Ranks against threads: a beam in motion and at rest, and a model of many machines.

Usage: /usr/bin/python3 bench/ranks.py [--width N] [--rounds N] [--json FILE]
Needs the solver built with MPI: build/mpi/sandglass (ci/setup mpi; ci/build mpi), or the one given
by SANDGLASS_BINARY. The beam has N x N x 5 N elements. One rank, two threads and two ranks take
turns. Strong scaling: the same beam. Weak scaling: a beam of twice the length, which may no longer
fit into the cache; then all wait for memory, whoever divides the work.
The model takes the measured time of an element and states its network; it is no measurement.
Exit codes: 0 done, 2 bad usage or input, 3 a computation failed.
"""

import argparse
import os
import re
import statistics
import sys
import tempfile
from pathlib import Path

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import growth
import time_to_rest
from common.command import exit_code, whole_number
from common.errors import InputError
from common.files import require_writable, write_json
from common.program import ROOT, output_of, under_mpirun

MOTION = """
[dynamics]
duration = {duration}
ramp_time = 1.0
frames = 1
"""
STEPS = 300  # about so many steps are timed

# The network of the model: the time of a message (s) and the bytes a second of one rank.
LATENCY, BANDWIDTH = 2e-6, 10e9
ROW, VECTOR = 32, 24  # bytes of a row as it is sent, and of three doubles
SMALLEST_CHUNK = 2048  # elements; solver/assembly/layout.cpp


def program():
    """The absolute Path of the solver with MPI. Raises InputError if it is not there."""
    path = Path(os.environ.get("SANDGLASS_BINARY", ROOT / "build/mpi/sandglass")).resolve()
    if os.access(path, os.X_OK):
        return path
    raise InputError(f"{path}: no program there; build it with `ci/setup mpi` and `ci/build mpi`")


def write_beam(folder, kind, width, length):
    """Write the case of a beam of `length` elements along its axis; returns its path."""
    text = growth.BEAM.format(width=width, length=length, ratio=0.49)
    end = f"{0.02 * length / width:g}"  # m, where the beam of growth.BEAM ends at 0.1
    text = text.replace("0.02, 0.1]", f"0.02, {end}]").replace("[0.1, 0.1]", f"[{end}, {end}]")
    if kind == "motion":
        step = 0.0012 / width  # s, about the stable one
        text = text.replace('"quasi-static"', '"dynamic"')
        text += MOTION.format(duration=STEPS * step)
    path = Path(folder) / f"{kind}-{length}.toml"
    path.write_text(text, encoding="utf-8")
    return path


def run(case, ranks, threads):
    """(ns per element and step, steps, bytes and messages of an exchange) of a run.

    At rest, steps are evaluations of the search, with all that belongs to it.
    """
    words, environment = under_mpirun(ranks, program(), "run", case, "--threads", threads)
    text = output_of(*words, env=environment)
    elements = int(re.search(r"(\d+) elements", text)[1])
    steps = int(re.search(r" (\d+) (?:steps|evaluations)", text)[1])
    seconds = float(re.search(r"(?:complete; |evaluations, )([\d.e+-]+) s", text)[1])
    time = 1e9 * seconds / elements / steps
    traffic = re.search(r"each of at most ([\d.]+) messages and (\d+) bytes", text)
    messages, sent = (float(traffic[1]), int(traffic[2])) if traffic else (0.0, 0)
    return time, steps, messages, sent


def measure_beam(folder, kind, width, rounds):
    """Records of one rank, two threads and two ranks, which take turns, and of weak scaling."""
    short, long = (write_beam(folder, kind, width, length * width) for length in (5, 10))
    setups = {
        "1 rank": (short, 1, 1, 5),
        "2 threads": (short, 1, 2, 5),
        "2 ranks": (short, 2, 1, 5),
        "2 threads, twice the length": (long, 1, 2, 10),
        "2 ranks, twice the length": (long, 2, 1, 10),
    }
    found = {name: [] for name in setups}
    for _ in range(rounds):
        for name, (case, ranks, threads, _length) in setups.items():
            found[name].append(run(case, ranks, threads))
    for name, (_case, ranks, threads, length) in setups.items():
        times = [of[0] for of in found[name]]
        _time, steps, messages, sent = found[name][0]
        yield {
            "kind": kind,
            "name": name,
            "elements": width**2 * length * width,
            "ranks": ranks,
            "threads": threads,
            "ns_per_element_step": statistics.median(times),
            "spread": (max(times) - min(times)) / statistics.median(times),
            "steps": steps,
            "messages": messages,
            "bytes": sent,
            "least_bytes": VECTOR * (width + 1) ** 2 if ranks > 1 else 0,
        }


def modelled_efficiency(ranks, layer, layers, nanoseconds):
    """The efficiency to expect of a step on `ranks` ranks, one or more slabs of layers each.

    layer, layers: elements of a layer across the body, and their number. nanoseconds: measured
    time of an element and step. Each rank computes one chunk of its neighbour besides its own
    share, and waits for two messages to and from each side where they take longer than the rest.
    None where there are more ranks than pairs of chunks.
    """
    elements = layer * layers
    chunk = max(SMALLEST_CHUNK, layer)
    if ranks > elements // chunk // 2:
        return None
    own = elements / ranks
    rim = 4 * chunk  # computed before the messages leave
    nodes = chunk / layer * (layer**0.5 + 1) ** 2
    message = LATENCY + ROW * nodes / BANDWIDTH
    hidden = max(0.0, own - rim) * nanoseconds * 1e-9
    step = (own + chunk) * nanoseconds * 1e-9 + max(0.0, 2 * message - hidden)
    return own * nanoseconds * 1e-9 / step


def model(nanoseconds):
    """Records of the model: a beam and a cube of 1e7 elements on 16 to 1,024 ranks."""
    for body, layer, layers in (("beam 1:100", 47**2, 4700), ("cube", 215**2, 215)):
        for ranks in (16, 64, 256, 1024):
            yield {
                "body": body,
                "elements": layer * layers,
                "ranks": ranks,
                "efficiency": modelled_efficiency(ranks, layer, layers, nanoseconds),
            }


def measure(options):
    """Measure, print, store. Returns the exit code. Raises InputError and ComputationError."""
    if options.json:
        require_writable(options.json)
    program()
    document = {**time_to_rest.machine(1), "records": [], "model": []}
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("motion", "rest"):
            for record in measure_beam(folder, kind, options.width, options.rounds):
                document["records"].append(record)
                print(
                    "{kind:6} {name:27} {elements:>8} elements {ns_per_element_step:8.2f} ns "
                    "(spread {spread:4.0%}) {steps:>5} steps {messages:3g} messages of {bytes:>7} "
                    "bytes, least {least_bytes}".format(**record),
                    flush=True,
                )
    alone = document["records"][0]["ns_per_element_step"]
    network = f"{LATENCY * 1e6:g} us a message, {BANDWIDTH * 1e-9:g} GB/s a rank"
    print(f"model, not measured: {alone:.1f} ns an element, {network}")
    for record in model(alone):
        document["model"].append(record)
        share = record["efficiency"]
        text = "more ranks than slabs" if share is None else f"{share:.0%}"
        print("{body:10} {elements:>9} elements {ranks:>5} ranks ".format(**record) + text)
    if options.json:
        write_json(options.json, document)
    return 0


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Ranks against threads, and a model of many machines.",
        epilog="exit codes: 0 done, 2 bad usage or input, 3 a computation failed",
    )
    add = parser.add_argument
    add("--width", type=whole_number(8), default=35, metavar="N", help="elements (default: 35)")
    add("--rounds", type=whole_number(1), default=5, metavar="N", help="default: 5")
    add("--json", metavar="FILE", help="write the records and the machine to this file")
    return exit_code(measure, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
