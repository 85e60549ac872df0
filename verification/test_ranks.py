"""Tests of runs that processes share through MPI: `mpirun -n 2 sandglass run CASE`.

They need the program built with MPI (ci/setup mpi; ci/build mpi) and are skipped without it;
ranks_test.cpp has the same bits tested for every method with threads as ranks.
"""

import os
import pathlib
import shutil
import signal
import subprocess
import time

import h5py
import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BINARY = ROOT / "build/mpi/sandglass"
WITHOUT_MPI = ROOT / "build/release/sandglass"
pytestmark = pytest.mark.skipif(
    not BINARY.exists() or not shutil.which("mpirun"), reason="the program is not built with MPI"
)

BLOCK = """
[case]
name = "block"
requirement = "A block of two materials is pulled, and swings."
answer = "dynamic"

[dynamics]
duration = {duration}
ramp_time = 0.02
frames = 4

[mesh]
generator = "box"
size = [0.02, 0.02, 0.1]
elements = [8, 8, 40]

[material]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = 0.49
density = 1000.0

[sets]
foot = {{ z = [0.0, 0.0] }}
head = {{ z = [0.1, 0.1] }}
side = {{ x = [0.0, 0.0] }}

[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]

[[displacement]]
set = "head"
value = [0.01, 0.0, 0.02]

[[pressure]]
set = "side"
value = 20.0
"""


def start(ranks, *arguments, program=BINARY, **options):
    """mpirun, also as the superuser and with more threads than processors."""
    environment = os.environ | {
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMP_WAIT_POLICY": "passive",
    }
    command = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), program]
    return subprocess.Popen(
        [str(word) for word in (*command, *arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        **options,
    )


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
    file.write_text(BLOCK.format(duration=0.05))
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


def test_an_error_of_all_ranks_is_told_once():
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
def test_what_ranks_cannot_share_is_refused(arguments, message):
    code, out, err = outcome_of(2, *arguments)
    assert code == 2
    assert err.count("error: ") == 1 and message in err


def test_a_program_without_mpi_refuses_to_be_started_twice():
    code, out, err = outcome_of(2, "run", "column", program=WITHOUT_MPI)
    assert code == 2
    assert "built without MPI" in err


def processes_below(pid):
    """The numbers of the children of a process."""
    children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(child) for child in children]


def test_a_killed_rank_ends_the_run_and_the_checkpoint_goes_on(tmp_path):
    """On as many ranks as before or others, with the bits of a run that nobody killed."""
    case = tmp_path / "block.toml"
    case.write_text(BLOCK.format(duration=1.0))
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
        assert "goes on from" in out
        assert not checkpoint.exists()
        assert content(result) == content(whole)
