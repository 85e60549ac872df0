"""Exit codes and messages of command lines."""

import argparse

import pytest

from common.command import exit_code, whole_number
from common.errors import ComputationError, InputError, suggestion


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


def test_whole_numbers():
    assert whole_number(1)("1") == 1
    with pytest.raises(argparse.ArgumentTypeError, match="0: must be 1 or more"):
        whole_number(1)("0")
    with pytest.raises(ValueError):
        whole_number(1)("1.5")


def test_unknown_names_are_answered_with_the_nearest_and_all():
    known = ["golden", "truth"]
    assert suggestion("gulden", known) == "did you mean 'golden'? known: golden, truth"
    assert suggestion("x", known) == "known: golden, truth"
