"""The case and the commands that the README shows are run as they stand there."""

import os
import pathlib
import re
import subprocess

import h5py
from command_line import BINARY, ROOT, sandglass

README = (ROOT / "README.md").read_text()


def test_first_own_case_runs_as_written(tmp_path):
    case = re.search(r"```toml\n(.*?)```", README, re.DOTALL)[1]
    (tmp_path / "my-beam.toml").write_text(case)
    commands = re.findall(r"^    build/release/sandglass (run my-beam.*)$", README, re.MULTILINE)
    assert len(commands) == 2
    for command in commands:
        done = sandglass(*command.split(), cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert "at rest" in done.stdout
        output = pathlib.Path(tmp_path / command.split()[-1])
        with h5py.File(output) as result:
            assert result.attrs["status"] == "complete"
        assert output.with_suffix(".xdmf").exists()


def test_the_choice_runs_as_written(tmp_path):
    """Both commands do what they say, and what is written names its method."""
    case = re.search(r"```toml\n(.*?)```", README, re.DOTALL)[1]
    (tmp_path / "my-beam.toml").write_text(case)
    commands = re.findall(r"^    build/release/sandglass (.*chosen\.toml)$", README, re.MULTILINE)
    assert [command.split()[0] for command in commands] == ["choose", "run"]
    for command in commands:
        done = sandglass(*command.split(), cwd=tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
    assert "[method]" in (tmp_path / "chosen.toml").read_text()


def test_own_program_runs_as_written(tmp_path):
    """In a folder that looks like the clone, with a home of its own."""
    (tmp_path / "build").mkdir()
    (tmp_path / "build" / "release").symlink_to(pathlib.Path(BINARY).resolve().parent)
    for folder in ("examples", "python"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    case = re.search(r"```toml\n(.*?)```", README, re.DOTALL)[1]
    (tmp_path / "my-beam.toml").write_text(case)
    section = README.partition("## Your own program")[2].partition("\n## ")[0]
    commands = re.findall(r"^    (\S.*)$", section, re.MULTILINE)
    assert len(commands) == 5
    for command in commands:
        done = subprocess.run(
            command,
            shell=True,
            cwd=tmp_path,
            env=os.environ | {"HOME": str(tmp_path)},
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, command + done.stdout + done.stderr
    assert "1.00 s: largest displacement" in done.stdout


def test_files_and_folders_that_the_readme_names_are_there():
    named = re.findall(
        r"`((?:solver|cases|verification|reference|examples)/[\w./-]*|\w+\.(?:md|cff))`", README
    )
    assert len(named) >= 6
    for name in named:
        assert (ROOT / name).exists(), name
