"""Runs shared by processes through MPI: `mpirun -n 2 sandglass run CASE`.

They need the program built with MPI (ci/setup mpi; ci/build mpi) and are skipped without it;
ranks_test.cpp tests the same bits for every method with threads as ranks.
"""

import os
import pathlib
import shutil
import signal
import subprocess
import time

import h5py
import pytest

from command_line import BARE, BINARY, dynamic
from common.program import ROOT

PROGRAM = ROOT / "build/mpi/sandglass"
pytestmark = pytest.mark.skipif(
    not PROGRAM.exists() or not shutil.which("mpirun"), reason="the program is not built with MPI"
)

PRESSURE = """
[[pressure]]
set = "side"
value = 20.0
"""


def block_in_motion(duration):
    """A block that is pulled and sheared, under a pressure from one side."""
    text = BARE.replace("[2, 2, 4]", "[8, 8, 40]")
    text = text.replace("[sets]", "[sets]\nside = { x = [0.0, 0.0] }")
    return dynamic(text + PRESSURE, duration=duration, ramp_time=0.02, frames=4)


def under_mpirun(ranks, *command):
    """(words, environment) that start a command on `ranks` ranks.

    Also as root, with more ranks and threads than processors, bound to none of them. Python may be
    within MPI itself, as started by dolfinx, but mpirun refuses to run within MPI.
    """
    words = ("mpirun", "--oversubscribe", "--bind-to", "none", "-n", ranks, *command)
    permission = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    within = ("OMPI_", "ORTE_", "PMIX_") if "PMIX_RANK" in os.environ else ()
    outside = {name: text for name, text in os.environ.items() if not name.startswith(within)}
    return [str(word) for word in words], outside | permission


def start(ranks, *arguments, program=PROGRAM, bound=False):
    """Starts a run on `ranks` ranks, each bound to one processor or to none."""
    words, environment = under_mpirun(ranks, program, *arguments)
    if bound:
        words[words.index("none")] = "core"
    environment["OMP_WAIT_POLICY"] = "passive"
    pipe = subprocess.PIPE
    return subprocess.Popen(words, stdout=pipe, stderr=pipe, text=True, env=environment)


def outcome_of(ranks, *arguments, **options):
    """Exit code, standard output and errors of a run."""
    process = start(ranks, *arguments, **options)
    out, err = process.communicate(timeout=250)
    return process.returncode, out, err


def content(file):
    """The bytes of all datasets of an HDF5 file."""
    datasets = {}

    def take(name, item):
        if isinstance(item, h5py.Dataset):
            datasets[name] = (item.shape, item[()].tobytes())

    with h5py.File(file) as opened:
        opened.visititems(take)
    return datasets


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    file = tmp_path_factory.mktemp("ranks") / "block.toml"
    file.write_text(block_in_motion(0.05))
    return file


@pytest.mark.parametrize(
    "case", ["column", "cylinder-compression", "stiff-core", "pushed-ellipsoid", "block"]
)
def test_same_bits_for_ranks_and_threads(case, block, tmp_path):
    name = block if case == "block" else case
    for ranks, threads in ((1, 1), (1, 2), (2, 1), (2, 2)):
        file = tmp_path / f"{ranks}-{threads}.h5"
        code, out, err = outcome_of(ranks, "run", name, "-t", threads, "-o", file)
        assert code == 0, err
        assert out.count("wrote") == 1
        assert content(file) == content(tmp_path / "1-1.h5"), (ranks, threads)
        xdmf = file.with_suffix(".xdmf").read_text()
        frames = [name for name in content(file) if name.endswith("/displacement")]
        assert xdmf.count("<Time") == len(frames) > 1


def test_an_error_of_all_ranks_is_reported_once():
    code, out, err = outcome_of(2, "run", "colum")
    assert code == 2
    assert err.count("error: case: 'colum' is neither a file nor a known case") == 1


def test_an_error_of_one_rank_ends_all(tmp_path):
    code, out, err = outcome_of(2, "run", "column", "-o", tmp_path / "missing" / "result.h5")
    assert code == 2
    assert "error: rank 0:" in err and "its folder must exist and be writable" in err


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["verify", "column"], "only `sandglass run CASE`"),
        (["run", "twist"], "are too many for a mesh of 192 elements"),
        (["run", "refined-indentation"], "hanging nodes are not divided among ranks"),
        (["run", "column", "--sleep", "1%"], "not divided among ranks"),
    ],
)
def test_features_without_ranks_are_refused(arguments, message):
    code, out, err = outcome_of(2, *arguments)
    assert code == 2
    assert err.count("error: ") == 1 and message in err


def test_threads_that_mpirun_binds_to_one_processor_are_reported():
    arguments = ("run", "column", "--threads", 2)
    message = "warning: the 2 threads of a rank share 1 processor; give mpirun --bind-to none"
    code, out, err = outcome_of(1, *arguments, bound=True)
    assert code == 0 and err.count(message) == 1
    code, out, err = outcome_of(1, *arguments)
    assert code == 0 and "warning" not in err


def test_help_is_printed_once_and_is_no_error():
    code, out, err = outcome_of(2, "run", "--help")
    assert code == 0, err
    assert out.count("compute a case with a method") == 1


def test_a_program_without_mpi_refuses_to_be_started_twice():
    code, out, err = outcome_of(2, "run", "column", program=BINARY)
    assert code == 2
    assert "built without MPI" in err


def processes_below(pid):
    """The process ids of the children of a process."""
    children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(child) for child in children]


def test_a_killed_rank_ends_the_run_and_the_checkpoint_resumes_it(tmp_path):
    """On the same number of ranks or another, with the bits of an uninterrupted run."""
    case = tmp_path / "block.toml"
    case.write_text(block_in_motion(1.0))
    whole, result, kept = (tmp_path / name for name in ("whole.h5", "result.h5", "kept.h5"))
    code, out, err = outcome_of(2, "run", case, "-o", whole)
    assert code == 0, err

    options = ("run", case, "-o", result, "--checkpoint", kept)
    process = start(2, *options, "--checkpoint-every", 0)
    while not kept.exists():
        assert process.poll() is None, "ended before it was killed"
        time.sleep(0.01)
    os.kill(processes_below(process.pid)[-1], signal.SIGKILL)
    out, err = process.communicate(timeout=60)
    assert process.returncode not in (0, 1, 2)
    assert "killed" in err.lower()
    assert not result.exists() and not result.with_suffix(".xdmf").exists()

    shutil.copy(kept, tmp_path / "again.h5")
    for ranks, checkpoint in ((2, kept), (1, tmp_path / "again.h5")):
        code, out, err = outcome_of(
            ranks, "run", case, "-o", result, "--checkpoint", checkpoint, "-t", 3 - ranks
        )
        assert code == 0, err
        assert "resumed from" in out
        assert not checkpoint.exists()
        assert content(result) == content(whole)
