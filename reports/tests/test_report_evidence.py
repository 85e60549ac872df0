"""Claims and mutants: their association, rejected files; the tree's own claims are valid."""

import json

import pytest

from common.errors import InputError
from common.program import ROOT
from sandglass_report.evidence import read_evidence
from sandglass_report.verdicts import read_verdicts
from sandglass_report.page import ANCHORS

TABLE = """# Mutants

Made by `verification/mutants/run.py` on a day, revision r: 2 killed, 1 not run, 1 survived.

| mutant | mistake | verdict | by | s | revision |
|---|---|---|---|---|---|
| 001-a | A sign. | killed | Some/SuiteTest/0.does_it | 1 | r |
| 002-b | A half. | not run | - | - | - |
| 003-c | A root. | killed | reports/tests/test_x.py::test_y | 2 | r |
| 004-d | A year. | survived | - | 425 | r |
"""

CLAIM = """
[[claim]]
says = "It works."
oracle = "arithmetic"
tests = ["verification/some_test.cpp"]
figure = "chart"
limits = ["column tl-perturbation auto max_relative_error"]
"""


@pytest.fixture
def tree(data):
    """The data set with a test, claims and mutants; a function that reads them."""
    (data.folder / "verification").mkdir()
    test = "TYPED_TEST_SUITE(Other, X);\nTEST_P(SuiteTest, does_it) {\n"
    (data.folder / "verification/some_test.cpp").write_text(test)
    data.write_claims = lambda text: (data.folder / "claims.toml").write_text(text)
    data.write_mutants = lambda text: (data.folder / "RESULTS.md").write_text(text)
    data.write_claims(CLAIM)
    data.write_mutants(TABLE)
    limits = read_verdicts(data.folder / "verdicts.json").limits
    files = data.folder / "claims.toml", data.folder / "RESULTS.md"
    data.read = lambda: read_evidence(*files, data.folder, limits)
    return data


def test_a_claim_has_its_limit_and_the_mistakes_its_tests_detected(tree):
    (claim,) = tree.read().claims
    assert claim.noticed == 1
    assert claim.limits[0].found == 0.002


def test_mutants_are_counted_and_belong_to_the_file_of_the_test(tree):
    evidence = tree.read()
    assert [evidence.count(v) for v in ("killed", "survived", "not run")] == [2, 1, 1]
    assert [m.file for m in evidence.mutants] == [
        "verification/some_test.cpp",
        "",
        "reports/tests/test_x.py",
        "",
    ]
    assert evidence.made.startswith("Made by")


def test_undetected_mutants_come_first(tree):
    verdicts = [m.verdict for m in tree.read().worst_first()]
    assert verdicts == ["survived", "not run", "killed", "killed"]


def test_both_files_may_be_absent(tree):
    (tree.folder / "claims.toml").unlink()
    (tree.folder / "RESULTS.md").unlink()
    evidence = tree.read()
    assert (evidence.claims, evidence.mutants) == ((), ())


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("some_test.cpp", "other_test.cpp", "test verification/other_test.cpp does not exist"),
        ("tl-perturbation auto", "tl-perturbation best", "no limit"),
        ('oracle = "arithmetic"', "", "oracle"),
        ("[[claim]]", "[[claim", "claims.toml"),
    ],
)
def test_claims_without_evidence_are_refused(tree, old, new, words):
    tree.write_claims(CLAIM.replace(old, new))
    with pytest.raises(InputError, match=words):
        tree.read()


def test_a_claim_about_a_case_that_was_not_run_shows_no_figure(tree):
    tree.write_claims(CLAIM.replace("column", "elsewhere"))
    assert tree.read().claims[0].limits == (None,)


def test_a_table_of_another_shape_is_refused(tree):
    tree.write_mutants(TABLE.replace("| s |", "|"))
    with pytest.raises(InputError, match="verification/mutants/run.py"):
        tree.read()


def test_tests_limits_and_sections_of_this_trees_claims_exist():
    """Limits are those that the case files expect."""
    import tomllib

    from sandglass_report.verdicts import Limit

    nothing = dict.fromkeys(("below", "above", "found", "at_kappa"))
    limits = []
    for path in (ROOT / "cases").glob("*.toml"):
        tables = tomllib.loads(path.read_text())
        name = tables["case"]["name"]
        expected = {name: tables.get("expect", [])}
        for variant in (v for family in tables.get("variants", {}).values() for v in family):
            expected[f"{name}-{variant['name']}"] = variant.get("expect", [])
        for case, e in ((case, e) for case, entries in expected.items() for e in entries):
            names = case, e["method"], e.get("kappa", "auto"), e["reference"]
            limits.append(Limit(*names, e["figure"], holds=True, reason="", **nothing))
    files = ROOT / "verification/claims.toml", ROOT / "verification/mutants/RESULTS.md"
    evidence = read_evidence(*files, ROOT, limits)
    assert len(evidence.claims) > 10
    assert {claim.figure for claim in evidence.claims} <= {"", *ANCHORS}
    assert all(limit is not None for claim in evidence.claims for limit in claim.limits)
    killed = [m for m in evidence.mutants if m.verdict == "killed"]
    assert killed and all((ROOT / m.file).is_file() for m in killed), json.dumps(
        [m.by for m in killed if not m.file]
    )
