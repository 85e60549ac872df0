"""The program about itself and about slips: help, manual page, completion, closest names."""

import re
import resource
import shutil

import pytest
from command_line import BLOCK, ROOT, methods, ran, sandglass

COMMANDS = re.findall(r"^  (\w+)  ", sandglass("--help").stdout, re.MULTILINE)
HELP = {name: sandglass(name, "--help").stdout for name in COMMANDS}
# Command -> its long options.
OPTIONS = {
    name: re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.MULTILINE) for name, text in HELP.items()
}
CASES = sorted(file.stem for file in (ROOT / "cases").glob("*.toml"))


def misspelt(names):
    """Each name with a misspelling one edit away: a letter is added, left out, wrong or swapped.

    The edit is in the middle, since many names have the same beginning.
    """
    kinds = [
        lambda name, k: name[:k] + "x" + name[k:],
        lambda name, k: name[:k] + name[k + 1 :],
        lambda name, k: name[:k] + "x" + name[k + 1 :],
        lambda name, k: name[: k - 1] + name[k] + name[k - 1] + name[k + 1 :],
    ]
    for number, name in enumerate(names):
        # Half of a name of two letters is no longer a slip: only a letter more is.
        kind = 0 if len(name.strip("-")) < 3 else number % len(kinds)
        wrong = kinds[kind](name, (len(name) + 1) // 2)
        if wrong in names:
            wrong = kinds[0](name, (len(name) + 1) // 2)
        yield name, wrong


def refused(*arguments, **options):
    """The message about wrong use."""
    outcome = sandglass(*arguments, **options, code=2)
    assert outcome.stderr.startswith("error: ")
    return outcome.stderr


# Slips.


def test_lists_of_names_are_not_empty():
    assert {"run", "choose", "score", "completion", "manual"} <= set(COMMANDS)
    assert sum(map(len, OPTIONS.values())) > 50 and len(methods()) > 15 and len(CASES) > 20


@pytest.mark.parametrize("name, wrong", misspelt(COMMANDS))
def test_a_misspelt_command_is_answered_with_the_nearest(name, wrong):
    message = refused(wrong, "column", "--all")
    assert f"'{wrong}' is not a command; did you mean '{name}'?" in message


@pytest.mark.parametrize("command", COMMANDS)
def test_a_misspelt_option_is_answered_with_the_nearest(command):
    for name, wrong in misspelt(OPTIONS[command]):
        message = refused(command, f"{wrong}=1")
        expected = f"error: {command}: '{wrong}' is not an option; did you mean '{name}'?"
        assert expected in message and f"sandglass {command} --help" in message


def test_a_misspelt_method_is_answered_with_the_nearest(block):
    for name, wrong in misspelt(methods()):
        message = refused("run", block, "--method", wrong)
        assert f"'{wrong}' is not known; did you mean '{name}'?" in message


def test_a_misspelt_case_is_answered_with_the_nearest(tmp_path):
    for name, wrong in misspelt(CASES):
        message = refused("mesh", wrong, "-o", tmp_path / "mesh.h5")
        assert f"did you mean '{name}'?" in message and len(message.splitlines()) == 1


def test_a_misspelt_file_is_answered_with_the_nearest_beside_it(tmp_path):
    (tmp_path / "my-beam.toml").write_text(BLOCK)
    for given, meant in [
        ("my-baem.toml", "my-beam.toml"),
        (tmp_path / "my-baem.toml", tmp_path / "my-beam.toml"),
    ]:
        message = refused("run", given, cwd=tmp_path)
        assert f"did you mean '{meant}'? `sandglass cases` lists the known ones\n" in message
        assert "ellipsoid-touch" not in message


@pytest.mark.parametrize(
    "old, new, line, words",
    [
        ('name = "block"', 'name = "block', 3, "is not TOML: a quote is open"),
        ('name = "block"', 'name = """block', 3, "is not TOML: a quote is open"),
        ("= 0.49", "= 0.5", 15, "material.poisson_ratio = 0.5 must be in (-1, 0.5)"),
        ("= 0.49", "= 0,49", 15, "did you mean 0.49, with a decimal point?"),
        ("= 0.49", '= "0,49"', 15, "= '0,49' must be a number; did you mean 0.49, with"),
        ("[0.02, 0.0, 0.01]", "[0,02, 0,0, 0,01]", 28, "did you mean 0.02, with a decimal point?"),
        ("[0.02, 0.0, 0.01]", "[0,2, 0,0, 0,1]", 28, "a list of 3, each a number; decimals have a"),
        ("= 0.49", "= 0.49 m", 15, "expected a comment or whitespace, saw 'm'\n"),
    ],
)
def test_slips_in_a_case_file_are_reported_with_their_line(block, old, new, line, words):
    assert old in BLOCK
    block.write_text(BLOCK.replace(old, new))
    message = refused("run", block)
    assert message.startswith(f"error: {block}:{line}: ") and words in message


def test_memory_that_does_not_suffice_is_reported_in_gigabytes(block, tmp_path):
    block.write_text(BLOCK.replace("[2, 2, 4]", "[3000, 3000, 3000]"))
    limit = (4 << 30, 4 << 30)
    outcome = sandglass(
        "mesh",
        block,
        "-o",
        tmp_path / "mesh.h5",
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit),
        code=3,
    )
    # 27e9 elements of 350 bytes each
    assert re.match(
        r"error: not enough memory: 2\.7e\+10 elements need about 9450\.0 GB, and [1-4]\.\d GB "
        r"are free on this machine or allowed by the shell; remedy: at most about [\d.]+e\+0[67] "
        r"elements\n",
        outcome.stderr,
    )
    assert not (tmp_path / "mesh.h5").exists()


# Help, manual page, completion: everything that the parser has.


@pytest.mark.parametrize("command", COMMANDS)
def test_help_fits_a_terminal(command):
    assert [line for line in HELP[command].splitlines() if len(line) > 100] == []
    summary = HELP[command].splitlines()[0].rstrip(".")
    assert summary in " ".join(sandglass("--help").stdout.split())


def test_manual_has_all_commands_and_options_and_no_fault_in_its_markup():
    page = sandglass("manual", code=0)
    for command in COMMANDS:
        section = page.stdout.split(f".SS sandglass {command} ")[1].split(".SS ")[0]
        tagged = re.findall(r"\\fB((?:\\-){2}.*?)\\fR", section)
        options = [name for name in OPTIONS[command] if name != "--help"]
        assert [tag.replace("\\", "") for tag in tagged] == options
    assert "\\fB\\-\\-describe\\fR\n" in page.stdout  # a flag has no value
    assert "\\fB\\-\\-method\\fR \\fIMETHOD\\fR\n" in page.stdout
    assert "3 the computation failed" in page.stdout.split(".SH EXIT STATUS")[1]
    if shutil.which("groff") is None:
        pytest.skip("needs groff")
    made = ran("groff", "-man", "-ww", "-Tutf8", input=page.stdout)
    assert made.returncode == 0 and not made.stderr
    assert "`sandglass methods`" in made.stdout  # quotes are unchanged


@pytest.fixture(scope="module")
def script():
    outcome = sandglass("completion", "bash", code=0)
    assert not outcome.stderr
    return outcome.stdout


def completed(script, *words):
    """Bash's suggestions for the last of these words."""
    lines = [
        script,
        f"COMP_WORDS=({' '.join(repr(word) for word in words)})",
        f"COMP_CWORD={len(words) - 1}",
        '_sandglass; printf "%s\\n" "${COMPREPLY[@]}"',
    ]
    done = ran("bash", input="\n".join(lines))
    assert done.returncode == 0 and not done.stderr, done.stderr
    return [line for line in done.stdout.splitlines() if line]


def test_completion_has_all_commands_options_methods_and_cases(script):
    offered = completed(script, "sandglass", "")
    assert [word for word in offered if word[0] != "-"] == COMMANDS
    for command in COMMANDS:
        assert set(OPTIONS[command]) == set(completed(script, "sandglass", command, "--"))
    for words in [
        ("run", "-m", ""),
        ("run", "column", "--method", "=", ""),
        ("choose", "column", "--methods", ""),
    ]:
        assert completed(script, "sandglass", *words) == methods()
    assert sorted(completed(script, "sandglass", "score", "--case", "")) == CASES
    assert set(CASES) <= set(completed(script, "sandglass", "verify", "column", ""))


def test_completion_knows_what_a_value_may_be(script):
    assert completed(script, "sandglass", "ru") == ["run"]
    assert completed(script, "sandglass", "run", "ellipsoid-t") == ["ellipsoid-touch"]
    assert completed(script, "sandglass", "run", "column", "--estimate", "t") == ["truth"]
    assert completed(script, "sandglass", "run", "column", "--method", "=") == methods()
    several = completed(script, "sandglass", "bench", "-m", "tl-full", "tl-mean")
    assert several == ["tl-mean-dilatation"]
    assert "column" in completed(script, "sandglass", "run", "--describe", "")  # after a flag
    assert completed(script, "sandglass", "run", "column", "-o", "") == []  # bash offers files
