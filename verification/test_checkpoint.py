"""Runs that are killed at any time and resumed end with the same bytes.

SANDGLASS_KILLS in the environment is the number of kills per run, by default 5.
"""

import os
import random
import resource
import shutil
import signal
import subprocess
import time

import pytest
from command_line import BINARY, BLOCK, dynamic, interrupted, ran, sandglass

KILLS = int(os.environ.get("SANDGLASS_KILLS", "5"))

LOAD = '[[force]]\nset = "head"\ntotal = [0.02, 0.05, 0.0]\n'
RELAXING = (
    BLOCK.replace('"neo-hookean"', '"viscoelastic-neo-hookean"').replace(
        "density", "relaxation_1 = 0.45\ntime_1 = 0.5\nrelaxation_2 = 0.365\ntime_2 = 50.0\ndensity"
    )
    + LOAD
)
SMALL = "[2, 2, 4]"


# Name, case, options. Each takes about a second, most of it for checkpoints, so that kills hit all
# activities of a run: steps, writing of checkpoints, writing of results.
RUNS = {
    "dynamic": (
        dynamic(RELAXING.replace(SMALL, "[6, 6, 12]"), duration=1.0, frames=9),
        ["--method", "ul-enhanced"],
    ),
    "dynamic-float": (
        dynamic(BLOCK.replace(SMALL, "[8, 8, 16]") + LOAD, duration=1.0, frames=9),
        ["--precision", "float"],
    ),
    "quasi-static": (
        RELAXING.replace(SMALL, "[8, 8, 16]") + "[relaxation]\nlevels = 25\n",
        ["--method", "ul-perturbation"],
    ),
    "quasi-static-float": (
        BLOCK.replace(SMALL, "[8, 8, 16]") + LOAD + "[relaxation]\nlevels = 25\n",
        ["--method", "tl-mean-dilatation", "--precision", "float"],
    ),
}


def bytes_of_results(folder, name):
    return [(folder / (name + ending)).read_bytes() for ending in (".h5", ".xdmf")]


def command(case, options, threads, output="killed.h5"):
    text = [BINARY, "run", case.name, *options, "--threads", str(threads), "-o", output]
    return [*text, "--checkpoint", "run.checkpoint", "--checkpoint-every", "0"]


def kill_at_random(call, folder, longest):
    """Whether the run was killed; it may have finished before."""
    with subprocess.Popen(
        call, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            process.wait(random.uniform(0.0, longest))
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
        errors = process.stderr.read()
    assert process.returncode in (0, -signal.SIGKILL), errors
    return process.returncode != 0


@pytest.mark.parametrize("name", RUNS)
def test_killed_runs_end_with_the_same_bytes(tmp_path, name):
    text, options = RUNS[name]
    case = tmp_path / "case.toml"
    case.write_text(text)
    start = time.monotonic()
    first = ran(*command(case, options, 1, "whole.h5"), cwd=tmp_path)
    longest = 1.2 * (time.monotonic() - start)
    assert first.returncode == 0, first.stderr
    sandglass("run", case.name, *options, "-o", "plain.h5", cwd=tmp_path, code=0)
    # Only the name of the file differs in the second one.
    assert bytes_of_results(tmp_path, "plain")[0] == bytes_of_results(tmp_path, "whole")[0]
    kills = completed = went_on = 0
    while kills < KILLS or not completed:
        threads = random.choice([1, 2])
        went_on += (tmp_path / "run.checkpoint").exists()
        if kills < KILLS and kill_at_random(command(case, options, threads), tmp_path, longest):
            kills += 1
            continue
        if kills >= KILLS:
            last = subprocess.run(
                command(case, options, threads), cwd=tmp_path, capture_output=True
            )
            assert last.returncode == 0, last.stderr
        completed += 1
        assert bytes_of_results(tmp_path, "killed")[0] == bytes_of_results(tmp_path, "plain")[0]
        assert sorted(file.name for file in tmp_path.iterdir()) == [
            "case.toml",
            *(
                f"{run}.{ending}"
                for run in ("killed", "plain", "whole")
                for ending in ("h5", "xdmf")
            ),
        ], "a checkpoint or a part of a file was left"
        (tmp_path / "killed.h5").unlink()
    print(f"{name}: {kills} kills, {went_on} restarts from a checkpoint, {completed} completed")


def checkpoint_of(case, *options):
    """Writes the checkpoint of an interrupted run; returns its name."""
    file = case.parent / "run.checkpoint"
    call = [
        BINARY,
        "run",
        str(case),
        *options,
        "--checkpoint",
        str(file),
        "--checkpoint-every",
        "0",
    ]
    with subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        while not file.exists() and process.poll() is None:
            time.sleep(0.01)
        process.kill()
    assert file.exists()
    return file


@pytest.fixture
def stopped(block):
    """A long case, and the checkpoint of its killed run."""
    block.write_text(dynamic(BLOCK, duration=1e6, frames=9))
    return block, checkpoint_of(block)


@pytest.mark.parametrize(
    "options, name",
    [
        (
            ["--method", "tl-full"],
            "method: 'tl-perturbation' in the checkpoint, 'tl-full' in this run",
        ),
        (["--kappa", "0.01"], "kappa: 'auto' in the checkpoint, '0.01' in this run"),
        (["--kappa-modulus", "shear"], "kappa_modulus: 'p-wave' in the checkpoint, 'shear'"),
        (["--precision", "float"], "precision: 'double' in the checkpoint, 'float' in this run"),
    ],
    ids=lambda value: value[0] if isinstance(value, list) else "",
)
def test_other_options_are_refused(stopped, options, name):
    case, file = stopped
    before = file.read_bytes()
    outcome = sandglass("run", case, *options, "--checkpoint", file, code=2)
    assert f"{file}: is the checkpoint of another run" in outcome.stderr
    assert name in outcome.stderr
    assert "delete it to start again" in outcome.stderr
    assert file.read_bytes() == before


def test_an_edited_case_is_refused(stopped):
    case, file = stopped
    case.write_text(case.read_text().replace("frames = 9", "frames = 10"))
    outcome = sandglass("run", case, "--checkpoint", file, code=2, message="input_hash")
    assert "case_hash: " not in outcome.stderr  # the answer does not depend on what is stored of it


def test_another_program_is_refused(stopped, tmp_path):
    case, file = stopped
    other = tmp_path / "other-program"
    other.write_bytes(open(BINARY, "rb").read() + b"\0")
    shutil.copymode(BINARY, other)
    outcome = ran(other, "run", case, "--checkpoint", file)
    assert outcome.returncode == 2
    assert "program_hash" in outcome.stderr


def test_a_damaged_checkpoint_is_refused(stopped):
    case, file = stopped
    good = file.read_bytes()
    middle = len(good) // 2
    for bad in (good[:middle], good[:middle] + bytes([good[middle] ^ 1]) + good[middle + 1 :], b""):
        file.write_bytes(bad)
        sandglass("run", case, "--checkpoint", file, code=2, message=f"{file}: is damaged")
        assert file.read_bytes() == bad


@pytest.mark.skipif(not os.path.exists("/proc/self/status"), reason="needs Linux's /proc")
def test_an_interrupted_run_resumes(block):
    """Ctrl-C writes a checkpoint at the next check, regardless of the interval."""
    block.write_text(dynamic(BLOCK, duration=40.0, frames=9))
    folder = block.parent
    assert sandglass("run", block, "-o", folder / "whole.h5").returncode == 0
    file = folder / "run.checkpoint"
    call = ("run", block, "-o", folder / "a.h5", "--checkpoint", file)
    code, errors = interrupted(*call)
    assert code == 3 and "interrupted" in errors
    outcome = sandglass(*call, code=0)
    assert f"resumed from {file}" in outcome.stdout
    assert (folder / "a.h5").read_bytes() == (folder / "whole.h5").read_bytes()
    assert not file.exists()


def test_a_full_disk_costs_a_warning_and_no_run(block):
    """Without space for a checkpoint the run continues, since it does not need one."""
    block.write_text(dynamic(BLOCK.replace(SMALL, "[8, 8, 16]"), duration=0.1, frames=9))
    file = block.parent / "run.checkpoint"

    def no_room():
        resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))

    call = ["run", block, "--checkpoint", file, "--checkpoint-every", "0"]
    outcome = sandglass(*call, preexec_fn=no_room, code=0)
    assert f"warning: checkpoint not written, the run continues: {file}: " in outcome.stderr
    assert "File too large" in outcome.stderr
    assert [entry.name for entry in block.parent.iterdir()] == ["block.toml"]
