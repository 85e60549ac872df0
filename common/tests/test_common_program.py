"""Finding the solver, and the errors of a program that fails."""

import sys

import pytest

from common.errors import ComputationError, InputError
from common.program import ROOT, binary, output_of


def test_the_solver_is_the_one_of_this_tree_unless_specified(monkeypatch, tmp_path):
    monkeypatch.setenv("SANDGLASS_BINARY", sys.executable)
    assert binary().is_absolute() and binary().samefile(sys.executable)
    monkeypatch.setenv("SANDGLASS_BINARY", str(tmp_path))
    with pytest.raises(InputError, match="no program there; .*SANDGLASS_BINARY"):
        binary()
    monkeypatch.delenv("SANDGLASS_BINARY")
    built = ROOT / "build/release/sandglass"
    if built.exists():
        assert binary() == built.resolve()
    else:
        with pytest.raises(InputError, match=f"{built}: no program there"):
            binary()


def python(text, **options):
    return output_of(sys.executable, "-c", text, **options)


def test_words_may_be_paths_and_numbers(tmp_path):
    code = "import sys; print(sys.argv[1:])"
    assert output_of(sys.executable, "-c", code, 3, tmp_path) == f"['3', '{tmp_path}']\n"


@pytest.mark.parametrize("code, kind", [(1, ComputationError), (2, InputError)])
def test_exit_codes_are_kinds_of_errors(code, kind):
    text = f"import sys; print('first\\nerror: last', file=sys.stderr); sys.exit({code})"
    with pytest.raises(kind, match=rf"` ended with {code}: last$"):
        python(text)
    assert python(text, allowed=(0, code)) == ""


def test_a_program_that_says_nothing_or_is_not_there(tmp_path):
    with pytest.raises(ComputationError, match="ended with 3: it gave no reason"):
        python("import sys; sys.exit(3)")
    with pytest.raises(InputError, match="none: cannot be run: No such file"):
        output_of(tmp_path / "none")
