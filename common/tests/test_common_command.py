"""Exit codes and messages of command lines."""

import pytest

from common.command import command_line, exit_code, option, whole_number, writable
from common.errors import ComputationError, InputError


@pytest.mark.parametrize("returned, code", [(None, 0), (0, 0), (1, 1), (3, 3)])
def test_work_that_is_done_has_its_own_code(returned, code, capsys):
    assert exit_code(lambda *_: returned, "an option") == code
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("kind, code", [(InputError, 2), (ComputationError, 3)])
def test_errors_are_one_line_and_a_code(kind, code, capsys):
    def fail(name):
        raise kind(f"{name}: is wrong")

    assert exit_code(fail, "x.json") == code
    assert capsys.readouterr() == ("", "error: x.json: is wrong\n")


def test_mistakes_of_the_program_itself_are_not_hidden():
    with pytest.raises(ZeroDivisionError):
        exit_code(lambda: 1 / 0)


TEXT = """Does something.

Exit codes: 0 done, 2 wrong.
"""


@pytest.mark.parametrize(
    "words, told",
    [
        (["--count", "0"], "argument --count: 0: must be 1 or more; --help lists"),
        (["--output", "none/x.h5"], "none/x.h5: cannot be written: the folder"),
        (["--cuont", "1"], "unrecognized arguments: --cuont 1"),
    ],
)
def test_wrong_use_of_a_script_is_refused_before_its_work(words, told, capsys):
    options = (option("--count", type=whole_number(1)), option("--output", type=writable))
    main = command_line(lambda options: options.count, TEXT, *options)
    assert main(["--count", "3"]) == 3
    assert main(words) == 2
    assert told in capsys.readouterr().err


def test_help_shows_what_a_script_does_and_its_exit_codes(capsys):
    with pytest.raises(SystemExit):
        command_line(None, TEXT)(["--help"])
    text = capsys.readouterr().out
    assert "Does something." in text and "Exit codes: 0 done, 2 wrong." in text
