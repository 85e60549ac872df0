"""Reads files of other programs that all hold the same body (writers.py), and mutilated ones.

    /usr/bin/python3 exchange/tests/generated.py --count 300 --seed 1
    /usr/bin/python3 exchange/tests/generated.py --mutilate 5000 --seed 1

Read, a file must give the body: its nodes, elements and sets, however numbered; or it must be
refused as foreseen. A mutilated file must be refused, or read; what differs from the body then is
counted by kind.
"""

import argparse
import contextlib
import io
import os
import sys
import tempfile
from collections import Counter
from pathlib import Path

import h5py
import numpy as np

if __name__ == "__main__":
    sys.path.append(str(Path(__file__).resolve().parents[2]))
from bodies import Body  # noqa: E402
from writers import KINDS  # noqa: E402

from exchange import convert  # noqa: E402


def read(path):
    """(exit code, message, warnings, Body or None)."""
    output, said, warned = path.with_name("read.h5"), io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(warned):
        code = convert.main(["mesh", str(path), str(output)])
    if code:
        return code, said.getvalue(), warned.getvalue(), None
    with h5py.File(output) as file:
        groups = [
            {name: some[...] for name, some in file.get("mesh/" + key, {}).items()}
            for key in ("sets", "element_sets")
        ]
        body = Body(file["mesh/points"][...], file["mesh/cells"][...], *groups)
    return code, "", warned.getvalue(), body


def difference(found, body):
    """What differs from a body, or ""; its first word is the kind."""
    if found.points.shape != body.points.shape or found.cells.shape != body.cells.shape:
        return f"numbers: {found.points.shape} points, {found.cells.shape} cells"
    gaps = np.linalg.norm(found.points[:, None] - body.points, axis=2)
    node, apart = gaps.argmin(axis=1), gaps.min(axis=1).max()
    if not apart < 1e-6 * np.linalg.norm(np.ptp(body.points, axis=0)) or len(set(node)) < len(node):
        return f"points: off by {apart:.2g}"
    wanted = {tuple(sorted(cell)): e for e, cell in enumerate(body.cells.tolist())}
    element = [wanted.get(tuple(sorted(cell)), -1) for cell in node[found.cells].tolist()]
    if sorted(element) != list(range(len(element))):
        return "cells: other nodes"
    for kind, own, numbers, right in (
        ("sets", found.sets, node, body.sets),
        ("element sets", found.element_sets, np.array(element), body.element_sets),
    ):
        if set(own) != set(right):
            return f"names: {kind} {sorted(own)} instead of {sorted(right)}"
        for name in own:
            if sorted(numbers[own[name]].tolist()) != sorted(right[name].tolist()):
                return f"{kind}: {name} differs"
    return ""


def check(folder, seed, name):
    """Writes a file of a kind, reads it; "" or what is wrong."""
    ending, write, message = KINDS[name]
    path = folder / ("body" + ending)
    data, body = write(np.random.default_rng(seed))
    path.write_bytes(data)
    code, said, _, found = read(path)
    if message:
        fine = code == 2 and message in said and str(path) in said
        return "" if fine else f"code {code}: {said!r}; expected {message}"
    return difference(found, body) if code == 0 else f"code {code}: {said}"


def mutilated(rng, data):
    """Data with bytes changed, left out or doubled, cut off, or with lines that change places."""
    data = bytearray(data)
    at, to = sorted(rng.integers(0, len(data), 2).tolist())
    way = rng.integers(5)
    if way == 0:
        return bytes(data[:at])
    if way == 1:
        for i in rng.integers(0, len(data), rng.integers(1, 5)):
            data[i] = rng.integers(0, 256)
    elif way == 2:
        del data[at : at + int(rng.integers(1, 40))]
    elif way == 3:
        data[at:at] = data[to : to + int(rng.integers(1, 40))]
    else:
        lines = bytes(data).split(b"\n")
        i, j = rng.integers(0, len(lines), 2)
        lines[i], lines[j] = lines[j], lines[i]
        return b"\n".join(lines)
    return bytes(data)


def mutilate(folder, count, seed, keep=False):
    """Reads mutilated files; Counter of results.

    A result is 2 (refused), 0 (read as the body), the name and kind of a difference from the body,
    or a text that begins with WRONG: another exit code, an exception, or a file that takes long.
    keep: whether the files that are read and differ, or are WRONG, are kept, too.
    """
    rng, results = np.random.default_rng(seed), Counter()
    kinds = {name: kind for name, kind in KINDS.items() if not kind[2]}
    for i in range(count):
        name = list(kinds)[i % len(kinds)]
        ending, write, _ = kinds[name]
        data, body = write(rng)
        path = folder / ("damaged" + ending)
        path.write_bytes(mutilated(rng, data))
        before = os.times().user
        try:
            code, said, warned, found = read(path)
            if code not in (0, 2) or (code and not (said.strip() and path.name in said)):
                result = f"WRONG {code} {name}: {said}"
            elif other := "" if code else difference(found, body):
                result = f"{name}: {'warned, ' if warned else ''}{other.partition(':')[0]}"
            else:
                result = code
        except BaseException as error:  # of any kind: it is what the test looks for
            result = f"WRONG {name}: {type(error).__name__}: {error}"
        if os.times().user - before > 5:
            result = f"WRONG {name}: slow"
        if keep and isinstance(result, str):
            name = f"{i}-{result[:40]}".replace(" ", "-").replace(":", "").replace("/", "")
            (folder / (name + ending)).write_bytes(path.read_bytes())
            (folder / (name + "-good" + ending)).write_bytes(data)
        results[result] += 1
    return results


def main():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--mutilate", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for the files")
    options = parser.parse_args()
    names, wrong = list(KINDS), 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        for i in range(options.count):
            name = names[i % len(names)]
            if message := check(folder, options.seed * 10**6 + i, name):
                wrong += 1
                print(f"{name} {i}: {message}")
        if options.count:
            print(f"{options.count} files, {wrong} misread or refused without need")
        if options.mutilate:
            results = mutilate(folder, options.mutilate, options.seed, bool(options.keep))
            for result, times in sorted(results.items(), key=str):
                print(f"{times:6} {result}")
            wrong += sum(times for result, times in results.items() if "WRONG" in str(result))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
