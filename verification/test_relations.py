"""Interrupted runs leave no partial file, what was complete is readable, and the same command then
ends with the bytes of an uninterrupted run.

SANDGLASS_INTERRUPTS in the environment is the number of interrupts, by default 12.
"""

import os
import random
import signal
import subprocess
import time

import h5py
import pytest
from command_line import PATIENCE
from test_checkpoint import RUNS, bytes_of_results, command

from common.result_file import text_of

INTERRUPTS = int(os.environ.get("SANDGLASS_INTERRUPTS", "12"))
SEED = int(os.environ.get("SANDGLASS_SEED", "1"))


def interrupt_at_random(call, folder, longest, sent):
    """The exit code and the errors of a run that gets a signal while it starts, computes or
    writes."""
    process = subprocess.Popen(
        call, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    moment = random.choice(["start", "any", "writing"])
    if moment == "writing":
        while process.poll() is None and not list(folder.glob("*.part")):
            pass
    try:
        process.wait({"start": 0.05, "any": longest, "writing": 0.01}[moment] * random.random())
    except subprocess.TimeoutExpired:
        process.send_signal(sent)
    _, errors = process.communicate(timeout=60 * PATIENCE)
    return process.returncode, errors


@pytest.mark.parametrize("name", RUNS)
def test_interrupted_runs_leave_no_partial_file(tmp_path, name):
    random.seed(f"{SEED} {name}")
    text, options = RUNS[name]
    case = tmp_path / "case.toml"
    case.write_text(text)
    again = command(case, options, 1)
    start = time.monotonic()
    whole = subprocess.run(command(case, options, 1, "whole.h5"), cwd=tmp_path, capture_output=True)
    longest = time.monotonic() - start
    assert whole.returncode == 0
    before = sorted(file.name for file in tmp_path.iterdir())
    codes = []
    for _ in range(-(-INTERRUPTS // len(RUNS))):
        sent = random.choice([signal.SIGINT, signal.SIGTERM])
        code, errors = interrupt_at_random(again, tmp_path, longest, sent)
        codes.append(code)
        assert code in (0, 3, -sent), errors
        assert not list(tmp_path.glob("*.part"))
        result = tmp_path / "killed.h5"
        if code == -sent:  # before it started computing
            assert not result.exists()
        elif code == 3:
            assert "interrupted" in errors
            with h5py.File(result) as file:
                assert text_of(file.attrs["status"]).startswith("interrupted")
                assert file["frames/0000/displacement"].shape[1] == 3
        resumed = subprocess.run(again, cwd=tmp_path, capture_output=True, text=True)
        assert resumed.returncode == 0, resumed.stderr
        assert bytes_of_results(tmp_path, "killed")[0] == bytes_of_results(tmp_path, "whole")[0]
        for ending in (".h5", ".xdmf"):
            (tmp_path / f"killed{ending}").unlink()
        assert sorted(file.name for file in tmp_path.iterdir()) == before
    print(f"{name}: {len(codes)} interrupts, exit codes {sorted(codes)}")
