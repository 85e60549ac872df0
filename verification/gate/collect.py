"""Runs the program and writes its figures as JSON files to a folder."""

import os
import subprocess
import tempfile
from pathlib import Path

import h5py

from common.files import write_json
from common.program import binary, output_of

# A mesh that stays in cache, so that arithmetic is compared, not the memory traffic of other
# programs. Many short processes are better than few long ones: the placement of a program in
# memory changes its best times by 1 %.
BENCH = ("--elements", 600, "--threads", 1, "--repetitions", 20)
PROCESSES = 12
# A quasi-static and a dynamic run; methods that answer by condensation have no motion.
BIT_CASES = {"column": (), "bar-wave": ("linear-condensed",)}


def verdicts(folder):
    """The file of `sandglass verify`, in double. Broken limits are left to ci/verify."""
    file = folder / "verdicts.json"
    output_of(binary(), "verify", "--no-costs", "--json", file, allowed=(0, 1))
    return file


def flops(folder):
    """The file of `sandglass flops`."""
    file = folder / "flops.json"
    output_of(binary(), "flops", "--json", file)
    return file


def bench(folder, name):
    """The file of one process of `bench`, by the program next to it that has scalar kernels.

    Wrong forces are reported in the file.
    """
    file = folder / f"{name}.json"
    program = binary().with_name("sandglass-scalar")
    output_of(program, "bench", *BENCH, "--json", file, allowed=(0, 1))
    return file


def _run(case, method, precision, threads, file):
    """Runs a case; its exit code."""
    command = [binary(), "run", case, "--method", method, "--precision", precision]
    command += ["--threads", str(threads), "-o", file]
    # Threads that spin would take the processor from those they wait for.
    environment = os.environ | {"OMP_WAIT_POLICY": "passive"}
    return subprocess.run(command, capture_output=True, env=environment).returncode


def _difference(one, two):
    """The differences between two result files, or an empty text."""
    if one.exists() != two.exists():
        return "only one of them has a result"
    if not one.exists() or one.read_bytes() == two.read_bytes():
        return ""
    with h5py.File(one) as a, h5py.File(two) as b:
        names = []
        a.visit(names.append)
        for name in names:
            if name not in b:
                return f"only one of them has /{name}"
            if isinstance(a[name], h5py.Dataset) and a[name][()].tobytes() != b[name][()].tobytes():
                return f"/{name} differs"
    return "the files differ"


def _bits(case, method, precision):
    """The differences between the runs of a case with 1 and 2 threads, or an empty text."""
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / "1-thread.h5", Path(folder) / "2-threads.h5"]
        codes = [
            _run(case, method, precision, threads, file)
            for threads, file in enumerate(files, start=1)
        ]
        return _difference(*files) if codes[0] == codes[1] else f"exit codes {codes}"


def bits(folder):
    """A file that states for every method whether 1 and 2 threads give the same bits."""
    methods = [
        line.split()[0] for line in output_of(binary(), "methods").splitlines() if line.strip()
    ]
    records = [
        {
            "name": f"{case}, {method}, {precision}, 1 and 2 threads",
            "differs": _bits(case, method, precision),
        }
        for case, without in BIT_CASES.items()
        for method in methods
        if method not in without
        for precision in ("double", "float")
    ]
    file = folder / "bits.json"
    write_json(file, {"records": records})
    return file
