"""The pictures of the code are those of the tree as it is, and loud when they no longer are."""

import shutil
from pathlib import Path

import draw_code
import pytest
from sandglass_report import displacement_picture as way
from sandglass_report.calls import Function, bodies, require_chain
from common.errors import InputError
from sandglass_report.layers_picture import ROOT, include_counts, layers, layers_picture

CHAINS = (*(step.chain for step in way.WAY), *way.BESIDE)
LINKS = sorted({link for chain in CHAINS for link in zip(chain, chain[1:])}, key=str)


@pytest.mark.parametrize("name", draw_code.PICTURES)
def test_committed_pictures_are_those_of_this_tree(name):
    made = draw_code.PICTURES[name]()
    assert (ROOT / "reports/figures" / name).read_text() == made, "run reports/draw_code.py"


@pytest.fixture
def tree(tmp_path):
    """What the way of a displacement is drawn from, in a copy."""
    files = {function.file for chain in CHAINS for function in chain}
    for file in files | {way.CASE, way.GOLDEN, "ci/verify"}:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / file, tmp_path / file)
    way.require_true(tmp_path)
    return tmp_path


def replace(file, old, new):
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


@pytest.mark.parametrize("link", LINKS, ids=lambda link: f"{link[0].name}-{link[1].name}")
def test_a_call_that_is_gone_is_an_error(tree, link):
    caller, called = link
    call = called.as_called or f"{called.name}("
    replace(tree / caller.file, call, "gone(")
    with pytest.raises(InputError, match=f"{caller.name}|{called.name}"):
        way.displacement_picture(tree)


@pytest.mark.parametrize("file", [way.GOLDEN, "solver/io/case_file.cpp"])
def test_a_file_that_is_gone_is_an_error(tree, file):
    (tree / file).unlink()
    with pytest.raises(InputError, match=file):
        way.displacement_picture(tree)


def test_another_place_of_the_verdicts_is_an_error(tree):
    replace(tree / "ci/verify", "build/verdicts.json", "build/judgements.json")
    with pytest.raises(InputError, match="ci/verify: does not name build/verdicts.json"):
        way.displacement_picture(tree)


def test_what_is_a_definition(tmp_path):
    text = """\
int f(int a);
Body::Body(const Mesh& mesh) : f_(f(1)), n_(2) {}
int f(int a) {
  if (f(a)) {
    return g("{}", a);
  }
  return f(2);
}
void h() { f(3); }
"""
    found = bodies(text, "f", False)
    assert len(found) == 1 and found[0].endswith("return f(2);\n}") and 'g("{}"' in found[0]
    assert bodies(text, "g", False) == []
    assert bodies(text, "Body", False) == ["Body::Body(const Mesh& mesh) : f_(f(1)), n_(2) {}"]
    (tmp_path / "a.cpp").write_text(text)
    f, g, h = (Function(name, "a.cpp") for name in "fgh")
    require_chain(tmp_path, (h, f))
    with pytest.raises(InputError, match="h does not call g"):
        require_chain(tmp_path, (h, g))
    with pytest.raises(InputError, match="defines no function g"):
        require_chain(tmp_path, (f, g))


def test_a_python_function_ends_where_the_next_begins(tmp_path):
    (tmp_path / "a.py").write_text("def f(a):\n    x = 1\n\n    return x\n\n\ndef g():\n    f(1)\n")
    f, g = (Function(name, "a.py") for name in "fg")
    require_chain(tmp_path, (g, f))
    with pytest.raises(InputError, match="f does not call g"):
        require_chain(tmp_path, (f, g))


def test_an_include_that_points_right_shows(tmp_path):
    (tmp_path / "math").mkdir()
    (tmp_path / "app").mkdir()
    (tmp_path / "app/a.cpp").write_text('#include "math/b.hpp"\n#include <vector>\n')
    (tmp_path / "math/b.hpp").write_text('#include "app/a.hpp"\n#include "math/c.hpp"\n')
    assert include_counts(tmp_path) == {("app", "math"): 1, ("math", "app"): 1}
    assert "2 includes between 14 layers, pointing right: 1" in layers_picture(tmp_path)
    assert "pointing right: 0" in layers_picture()


def test_the_chain_of_layers_in_words_is_that_of_the_check():
    for document in ("CONTRIBUTING.md", "solver/README.md"):
        assert " <- ".join(layers.LAYERS) in (ROOT / document).read_text(), document


def test_the_command_line_tells_what_is_not_true(tmp_path, monkeypatch, capsys):
    def untrue():
        raise InputError("a.cpp: defines no function f")

    monkeypatch.setitem(draw_code.PICTURES, "displacement.svg", untrue)
    assert draw_code.main(["-o", str(tmp_path / "figures")]) == 2
    assert capsys.readouterr().err == "error: a.cpp: defines no function f\n"
    assert not Path(tmp_path / "figures").exists()
