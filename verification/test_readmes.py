"""Every command that a README shows is run: here, by another test, or, where it is long, parsed.

`commands.toml` says which; nothing may be shown that it does not know, nor known that is not shown.
"""

import os
import re
import shutil
import subprocess
import tomllib

import pytest
from command_line import BINARY, PATIENCE, ROOT, sandglass
from readme_commands import commands, inline, not_taken

LISTED = tomllib.loads((ROOT / "verification/commands.toml").read_text())
PROGRAM = ("build/release/sandglass", "sandglass")
TOPS = [top for top in ROOT.iterdir() if top.name not in ("build", ".git")]
PLACES = [place for top in TOPS for place in (top, *top.rglob("*"))]
DOCUMENTS = {
    str(place.relative_to(ROOT)): place.read_text()
    for place in sorted(PLACES)
    if place.suffix == ".md"
}
SHOWN = {name: commands(text) for name, text in DOCUMENTS.items()}


def class_of(command):
    """run, tested or long; None for a command that nobody knows."""
    (*found,) = (name for name, listed in LISTED.items() if command in listed)
    if not found and command.split()[0] in PROGRAM:
        return "run"
    return found[0] if len(found) == 1 else None


@pytest.mark.parametrize("document", [name for name, shown in SHOWN.items() if shown])
def test_every_command_has_a_class(document):
    strangers = [command for command in SHOWN[document] if class_of(command) is None]
    assert not strangers, "run them, or say in commands.toml who does"


def test_what_is_listed_is_shown():
    shown = {command for commands in SHOWN.values() for command in commands}
    listed = [command for commands in LISTED.values() for command in commands]
    assert [command for command in listed if command not in shown] == []


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    """A folder like a clone with its program built, the README's case in it, and a stored truth in
    place of one that takes minutes."""
    tree = tmp_path_factory.mktemp("clone")
    unwanted = shutil.ignore_patterns("__pycache__", ".pytest_cache")
    for folder in ("cases", "reference", "reports", "exchange", "common"):
        shutil.copytree(ROOT / folder, tree / folder, ignore=unwanted)
    (tree / "build/release").mkdir(parents=True)
    (tree / "build/release/sandglass").symlink_to(os.path.abspath(BINARY))
    beam = re.search(r"```toml\n(.*?)```", DOCUMENTS["README.md"], re.DOTALL)[1]
    (tree / "my-beam.toml").write_text(beam)
    shutil.copy(ROOT / "reference/truth/ellipsoid-indentation.h5", tree / "truth-6.h5")
    return tree


def run_here(document):
    return [command for command in SHOWN[document] if class_of(command) == "run"]


@pytest.mark.parametrize("document", [name for name in SHOWN if run_here(name)])
def test_commands_run_in_their_order(document, clone):
    for command in run_here(document):
        if "reference/solve.py" in command:
            pytest.importorskip(
                "dolfinx", reason="FEniCSx is not installed (package python3-dolfinx)"
            )
        if command.startswith("sandglass "):
            command = "build/release/" + command
        done = subprocess.run(
            f"{command} {LISTED['run'].get(command, '')}",
            shell=True,
            cwd=clone,
            env={name: value for name, value in os.environ.items() if name != "SANDGLASS_CASES"},
            capture_output=True,
            text=True,
            timeout=120 * PATIENCE,
        )
        assert done.returncode == 0, command + "\n" + done.stdout + done.stderr


@pytest.mark.parametrize("command", LISTED["tested"])
def test_who_is_said_to_run_a_command_is_there(command):
    """A script has all its words, or the folder of a path, in one line; a test reads a README."""
    file, _, function = LISTED["tested"][command].partition("::")
    text = (ROOT / file).read_text()
    if function:
        assert f"\ndef {function}(" in text and ("README" in text or "document" in text)
        return
    words = [word.partition("/tests")[0] for word in command.split()]
    assert any(set(words) <= set(line.split()) for line in text.splitlines())


@pytest.mark.parametrize("command", LISTED["long"])
def test_long_commands_are_taken(command):
    assert not_taken(command, ROOT, BINARY) == ""


@pytest.mark.parametrize(
    "command, why",
    [
        ("bash ci/setup brench", "does not tell of"),
        ("bash ci/gates", "is not there"),
        ("bash ci/gate --acept", "unrecognized arguments"),
        ("bench/local_touch.py", "cannot be executed"),
        ("/usr/bin/python3 bench/time_to_rest.py --elements C3D8I", "invalid choice"),
        ("reference/regenerate --truth-only", "unrecognized arguments"),
        ("build/release/sandglass bench --resting", "--resting"),
    ],
)
def test_what_a_tool_does_not_know_is_told(command, why):
    assert why in not_taken(command, ROOT, BINARY)


def test_what_counts_as_a_command():
    text = """A step:

    ci/build release \\
      && true          # and a comment

```sh
sandglass cases
```

```toml
    [mesh]
```

`sandglass
run`
"""
    assert commands(text) == ["ci/build release && true", "sandglass cases"]
    assert inline(text) == ["sandglass run"]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_sources_that_running_text_names_are_there(document):
    """Files and folders, as the end of a path in the tree; those that a step makes apart."""
    made = re.findall(r"New file\s+`([^`]+)`", DOCUMENTS[document])
    for name in inline(DOCUMENTS[document]):
        source = re.fullmatch(r"(?:\.\./)*([\w./-]+(?:\.(?:[ch]pp|py|md|cff)|/))", name)
        if source and name not in made and not name.startswith("build/"):
            ending = "/" + source[1].rstrip("/")
            assert any(str(place).endswith(ending) for place in PLACES), name


@pytest.fixture(scope="module")
def help_of():
    """Subcommand -> its help."""
    names = re.findall(r"^  (\w+)  ", sandglass("--help").stdout, re.MULTILINE)
    return {name: sandglass(name, "--help").stdout for name in names}


@pytest.mark.parametrize("document", DOCUMENTS)
def test_what_running_text_names_is_there(document, help_of):
    """Scripts of ci/, and subcommands of the program with their options and canonical cases."""
    cases = {file.stem for file in (ROOT / "cases").glob("*.toml")}
    for code in inline(DOCUMENTS[document]):
        words = code.removeprefix("bash ").removeprefix("build/release/").split()
        if not words:
            continue
        if re.fullmatch(r"ci/[\w-]+", words[0]):
            assert (ROOT / words[0]).stat().st_mode & 0o100, code
        if words[0] != "sandglass" or len(words) == 1:
            continue
        assert words[1] in help_of, code
        for before, word in zip(words[1:], words[2:]):
            if word.startswith("-"):
                assert re.search(rf"(?<![\w-]){word}(?![\w-])", help_of[words[1]]), code
            elif not before.startswith("-") and re.fullmatch(r"[a-z]+(-[a-z]+)*", word):
                assert word in cases, code
