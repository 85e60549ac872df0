"""Full disks and unwritable places: reason, exit code, and no incomplete file.

A place that cannot be written is wrong input (2); a disk that fills during a run ends the
computation (3). Existing files stay as they were.
"""

import os
import resource
import shutil
import subprocess

import pytest
from command_line import BINARY, BLOCK, dynamic, sandglass, write_golden

FULL = ("File too large", "No space left on device", "Disk quota exceeded")


def limited(size):
    """For `preexec_fn`: limits the size of files, as on a disk with this much space."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def listing(folder):
    """All files below a folder with their contents."""
    files = [file for file in folder.rglob("*") if file.is_file()]
    return {str(file.relative_to(folder)): file.read_bytes() for file in files}


# Arguments of each command before the file that it writes; the file's name.
WRITERS = {
    "run": (["run", "block.toml", "-o"], "out.h5"),
    "mesh": (["mesh", "block.toml", "-o"], "out.h5"),
    "verify-json": (["verify", "block.toml", "--json"], "out.json"),
    "verify-results": (["verify", "block.toml", "--results"], "results"),
    "flops": (["flops", "--json"], "out.json"),
    "bench": (["bench", "--elements", "16", "--json"], "out.json"),
}


@pytest.fixture
def case(block):
    write_golden(block)
    for left in ("for-golden.h5", "for-golden.xdmf"):
        (block.parent / left).unlink()
    return block


# JSON files are tested for writability once, not after every computation.
@pytest.mark.parametrize(
    "writer, size",
    [
        ("run", 0),
        ("run", 4000),
        ("mesh", 0),
        ("mesh", 4000),
        ("verify-results", 4000),
        ("flops", 0),
    ],
)
def test_full_disk(case, writer, size):
    arguments, name = WRITERS[writer]
    folder = case.parent
    if writer != "verify-results":
        for ending in (".h5", ".xdmf", ".json"):
            (folder / "out").with_suffix(ending).write_bytes(b"good")
    before = listing(folder)
    outcome = sandglass(*arguments, name, cwd=folder, preexec_fn=limited(size), code=3)
    error = [line for line in outcome.stderr.splitlines() if line.startswith("error: ")]
    assert len(error) == 1 and f"{name.split('.')[0]}" in error[0]
    assert any(text in error[0] for text in FULL)
    assert listing(folder) == before


def test_a_disk_that_fills_while_the_guide_is_written(case):
    """There is space for the result but not for the XDMF file: afterwards both or neither exist."""
    folder = case.parent
    before = listing(folder)
    small = ["run", case, "-o", folder / "out.h5"]
    assert sandglass(*small).returncode == 0
    sizes = [(folder / name).stat().st_size for name in ("out.h5", "out.xdmf")]
    for name in ("out.h5", "out.xdmf"):
        (folder / name).unlink()
    sandglass(*small, preexec_fn=limited(max(sizes) - 1), code=3)
    assert listing(folder) == before


@pytest.mark.parametrize("writer", WRITERS)
@pytest.mark.parametrize("place", ["a-file/out.h5", "/proc/out.h5", "/dev/null", "a-folder"])
def test_places_that_cannot_be_written(case, writer, place):
    arguments, _ = WRITERS[writer]
    folder = case.parent
    (folder / "a-file").write_text("")
    (folder / "a-folder").mkdir()
    if (writer, place) == ("verify-results", "a-folder"):
        return  # it requires a folder
    before = listing(folder)
    sandglass(*arguments, place, cwd=folder, code=2, message=f"{place}")
    assert listing(folder) == before
    assert os.path.exists("/dev/null") and not os.path.isfile("/dev/null")


@pytest.mark.parametrize("command", [["cases"], ["methods"], ["run", "--describe"], ["flops"]])
def test_standard_output_that_takes_nothing(command):
    with open("/dev/full", "w") as full:
        outcome = subprocess.run(
            [BINARY, *command], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60
        )
    assert outcome.returncode == 3
    assert outcome.stderr.startswith("error: ")


def mounted(folder, options):
    """Whether a file system in memory could be mounted, which needs root."""
    command = ["mount", "-t", "tmpfs", "-o", options, "sandglass-test", str(folder)]
    return shutil.which("mount") and subprocess.run(command, capture_output=True).returncode == 0


@pytest.fixture
def small_disk(tmp_path):
    folder = tmp_path / "disk"
    folder.mkdir()
    if not mounted(folder, "size=32k"):
        pytest.skip("cannot mount here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_disk_that_is_really_full(small_disk, case):
    """The same with a file system instead of a limit: another reason, at another time."""
    case.write_text(case.read_text().replace("[2, 2, 4]", "[12, 12, 24]"))
    (small_disk / "out.json").write_text("good")
    for arguments in (["run", case, "-o"], ["mesh", case, "-o"]):
        outcome = sandglass(*arguments, small_disk / "out.h5", code=3)
        assert f"error: {small_disk}/out." in outcome.stderr
        assert "No space left on device" in outcome.stderr
        assert listing(small_disk) == {"out.json": b"good"}


def test_a_disk_without_room_for_a_checkpoint(small_disk, case):
    """The run does not need a checkpoint: it warns and continues; its result is elsewhere."""
    case.write_text(dynamic(BLOCK.replace("[2, 2, 4]", "[8, 8, 16]"), duration=0.05))
    options = ["--checkpoint", small_disk / "c", "--checkpoint-every", "0"]
    result = case.parent / "out.h5"
    outcome = sandglass("run", case, *options, "-o", result, code=0)
    assert "warning: checkpoint not written, the run continues: " in outcome.stderr
    assert "No space left on device" in outcome.stderr
    assert result.exists() and not listing(small_disk)
