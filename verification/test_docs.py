"""READMEs are true: their steps are followed literally in a copy, and all that they name exists.

A law, a control and a number type are compiled alone, into the tests that need no kernels: half a
minute each. `ci/docs` follows all steps and builds the whole solver.
"""

import difflib
import os
import re
import shutil
import subprocess

import pytest
from command_line import BINARY, PATIENCE, ROOT
from follow import changed, commands, follow, section

FOLDERS = ["bench", "cases", "reference", "solver", "verification"]
THEORY = ["solver/element/README.md", "solver/material/README.md", "solver/solve/README.md"]


def followed(document, heading, tree, *folders):
    """Follows the steps of a section in a copy of some folders; returns its commands and files."""
    results = shutil.ignore_patterns("__pycache__", "*.h5", "build")
    for folder in folders:
        shutil.copytree(ROOT / folder, tree / folder, ignore=results)
    text = section((ROOT / document).read_text(), heading)
    return commands(text), follow(text, tree)


def only_last(file, name):
    """Reduces a list of types to its last entry, the one that was added."""
    text = file.read_text()
    found = re.search(rf"using {name} =\s+TypeList<[^;]*?(\w+)>;", text)
    file.write_text(text.replace(found[0], f"using {name} = TypeList<{found[1]}>;"))
    return found[1]


def build(command, tree, environment):
    done = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def run_test(tree, name, tests):
    """Compiles a test of the copy and runs it with a filter; returns how many tests passed."""
    environment = os.environ | {"CCACHE_BASEDIR": str(tree), "CCACHE_NOHASHDIR": "1"}
    launcher = ["ccache"] if shutil.which("ccache") else []
    flags = "-std=c++20 -O0 -fno-math-errno -Isolver -Iverification -isystem /usr/include/eigen3"
    sources = [f"verification/{name}.cpp", "verification/support/eigenvalues.cpp"]
    objects = [source.replace("/", "-") + ".o" for source in sources]
    for source, object in zip(sources, objects):
        build([*launcher, "c++", *flags.split(), "-c", source, "-o", object], tree, environment)
    build(["c++", *objects, "-lgtest_main", "-lgtest", "-lfmt", "-o", name], tree, environment)
    done = subprocess.run(
        [tree / name, f"--gtest_filter={tests}"],
        capture_output=True,
        text=True,
        timeout=300 * PATIENCE,
    )
    assert done.returncode == 0, done.stdout
    return int(re.search(r"PASSED\s+\] (\d+) test", done.stdout)[1])


def sandglass(tree, command):
    assert command.startswith("build/release/sandglass ")
    return subprocess.run(
        [BINARY, *command.split()[1:]],
        cwd=tree,
        env={name: value for name, value in os.environ.items() if name != "SANDGLASS_CASES"},
        capture_output=True,
        text=True,
        timeout=120 * PATIENCE,
    )


def test_a_new_case(tmp_path):
    shown, (file,) = followed("cases/README.md", "A new case", tmp_path, "cases")
    assert [command.split()[1] for command in shown] == ["run", "verify"]
    for command in shown:
        done = sandglass(tmp_path, command)
        assert done.returncode == 0, done.stdout + done.stderr
    case = tmp_path / file
    case.write_text(changed(case.read_text(), "-value = -0.0179269019\n+value = -0.0179269\n"))
    assert sandglass(tmp_path, shown[1]).returncode == 0
    case.write_text(changed(case.read_text(), "-value = -0.0179269\n+value = -0.0180\n"))
    assert sandglass(tmp_path, shown[1]).returncode == 1


def test_a_new_law(tmp_path):
    shown, touched = followed(
        "solver/material/README.md", "A new law", tmp_path, "solver", "verification", "reference"
    )
    assert [file.split("/")[-1] for file in touched] == ["demiray.hpp", "laws.hpp", "laws.py"]
    assert shown == ["ci/build release law_test && build/release/verification/law_test"]
    assert only_last(tmp_path / "solver/material/laws.hpp", "ElasticLaws") == "Demiray"
    assert run_test(tmp_path, "law_test", "LawTest/demiray.*") >= 14
    script = "import laws; print(sorted(laws.parameters('viscoelastic-demiray')))"
    done = subprocess.run(
        ["/usr/bin/python3", "-c", script],
        cwd=tmp_path / "reference",
        capture_output=True,
        text=True,
    )
    assert "'b', 'bulk_modulus', 'relaxation_1'" in done.stdout, done.stderr


def test_a_new_hourglass_control(tmp_path):
    shown, touched = followed(
        "solver/element/README.md", "A new hourglass control", tmp_path, "solver", "verification"
    )
    assert [file.split("/")[-1] for file in touched] == [
        "hourglass_mean_sampling.hpp",
        "tl_mean_sampling.hpp",
        "methods.hpp",
    ]
    assert shown == [
        "ci/build release formulation_test && build/release/verification/formulation_test"
    ]
    assert only_last(tmp_path / "solver/element/methods.hpp", "Methods") == "TlMeanSampling"
    only_last(tmp_path / "solver/material/laws.hpp", "ElasticLaws")
    assert run_test(tmp_path, "formulation_test", "*tl_mean_sampling*") >= 7


def test_a_new_number_type(tmp_path):
    shown, touched = followed(
        "solver/math/README.md", "A new number type", tmp_path, "solver", "verification"
    )
    assert [file.split("/")[-1] for file in touched] == ["rounded.hpp", "number_types.hpp"]
    assert shown == [
        "ci/build release vocabulary_test && build/release/verification/vocabulary_test"
    ]
    assert only_last(tmp_path / "verification/support/number_types.hpp", "NumberTypes") == "Rounded"
    assert run_test(tmp_path, "vocabulary_test", "*") >= 4


def test_a_new_exact_solution(tmp_path):
    """Compiled and run by ci/docs: it needs every kernel."""
    shown, touched = followed(
        "verification/README.md", "A new exact solution", tmp_path, "verification"
    )
    assert touched == ["verification/support/exact_fields.hpp"]
    assert shown == [
        "ci/build release manufactured_test && "
        "build/release/verification/manufactured_test --gtest_filter='*torsion*'"
    ]
    field = only_last(tmp_path / touched[0], "ExactFields")
    assert field == "TorsionField" and f"struct {field} " in (tmp_path / touched[0]).read_text()


WAYS = {
    "case": ("cases/README.md", "A new case"),
    "material law": ("solver/material/README.md", "A new law"),
    "hourglass control": ("solver/element/README.md", "A new hourglass control"),
    "number type": ("solver/math/README.md", "A new number type"),
    "exact solution": ("verification/README.md", "A new exact solution"),
    "benchmark": ("bench/README.md", "A new benchmark"),
}


def test_what_a_new_thing_costs_is_what_contributing_says(tmp_path):
    """Its row has, after promise and file of the steps: new files; files changed, lines added."""
    text = (ROOT / "CONTRIBUTING.md").read_text()
    rows = re.findall(r"^\| ([^|]+) \| [^|]+ \| `([^`]+)` \| (\d) \| (\d), (\d+) \|$", text, re.M)
    assert [row[0] for row in rows] == list(WAYS)
    for name, document, *said in rows:
        assert document == WAYS[name][0]
        _, touched = followed(*WAYS[name], tmp_path / name, *FOLDERS)
        changed_files = [file for file in touched if (ROOT / file).exists()]
        added = 0
        for file in changed_files:
            old, new = ((tree / file).read_text() for tree in (ROOT, tmp_path / name))
            lines = difflib.unified_diff(old.splitlines(), new.splitlines(), n=0)
            added += sum(line.startswith("+") and not line.startswith("+++") for line in lines)
        measured = [len(touched) - len(changed_files), len(changed_files), added]
        assert measured == [int(number) for number in said], name


def test_a_step_that_does_not_fit_is_an_error(tmp_path):
    (tmp_path / "there").write_text("a\nb\n")
    with pytest.raises(ValueError, match="not once"):
        follow("1. Change, in `there`:\n\n```diff\n-c\n+d\n```\n", tmp_path)
    with pytest.raises(ValueError, match="there already"):
        follow("New file `there`:\n\n```toml\n```\n", tmp_path)
    with pytest.raises(ValueError, match="no heading"):
        section("## A\n", "B")
    follow("1. Change, in `there`:\n\n```diff\n a\n-b\n+c\n```\n", tmp_path)
    assert (tmp_path / "there").read_text() == "a\nc\n"


@pytest.mark.parametrize("document", THEORY + sorted({document for document, _ in WAYS.values()}))
def test_files_and_functions_that_a_readme_names_are_there(document):
    """Names in tables stand in the file of their row, or in one of the README's folder."""
    folder = (ROOT / document).parent
    text = (ROOT / document).read_text()
    named = set(re.findall(r"`((?:\.\./)?[\w/]+\.(?:hpp|cpp|md|py|toml))`", text))
    for name in named - set(re.findall(r"New file\s+`([^`]+)`", text)):
        places = [folder / name, ROOT / name, ROOT / "solver" / name, ROOT / "verification" / name]
        assert any(place.exists() for place in places), name
    code = "".join(file.read_text() for file in sorted((ROOT / "solver").rglob("*.[ch]pp")))
    for row in re.findall(r"^\|.*\| ([^|]*) \|$", text, re.MULTILINE):
        for name in re.findall(r"`(\w+(?:::\w+)*)`", row):
            assert re.search(rf"\b{name.split('::')[-1]}\b[^;]*[({{]", code), name


def test_citation_and_licence_are_those_of_the_project():
    citation = (ROOT / "CITATION.cff").read_text()
    version = re.search(r"^version: (.*)$", citation, re.MULTILINE)[1]
    licence = re.search(r"^license: (.*)$", citation, re.MULTILINE)[1]
    assert f"project(sandglass VERSION {version} " in (ROOT / "CMakeLists.txt").read_text()
    assert (ROOT / "LICENSE").read_text().startswith(licence.replace("-", " ", 1).split("-")[0])
    assert f"Licence: {licence}" in (ROOT / "README.md").read_text()


def test_every_test_is_in_the_table_of_the_suite():
    folder = ROOT / "verification"
    text = (folder / "README.md").read_text()
    tests = [*folder.glob("*_test.cpp"), *folder.glob("test_*.py")]
    assert [test.name for test in tests if f"`{test.name}`" not in text] == []


def test_operations_of_the_control_are_those_that_are_counted():
    text = (ROOT / "solver/element/README.md").read_text()
    ours, papers = re.search(r"takes (\d+) operations in place of the paper's (\d+)", text).groups()
    counted = subprocess.run([BINARY, "flops"], capture_output=True, text=True).stdout
    for form, total in (("kernel", ours), ("paper", papers)):
        assert re.search(rf"^tl-perturbation +{form} +hourglass .* {total} *$", counted, re.M), form


def test_every_equation_of_the_paper_is_in_the_theory():
    text = "".join((ROOT / document).read_text() for document in THEORY)
    rows = "".join(re.findall(r"^\| (\(.*?)[a-z]", text, re.MULTILINE))
    assert [int(number) for number in re.findall(r"\((\d+)\)", rows)] == list(range(1, 16))
