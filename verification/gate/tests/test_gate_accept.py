"""ci/gate --accept: what the baseline keeps, why, and how it is written."""

import json

import pytest
from gate import baseline as baselines
from gate.compare import FLOOR, RELATIVE
from gate_documents import ORIGIN, verdict
from gate_regressions import add_a_multiplication, change_error, lose_a_figure

from common.errors import InputError


def test_accepting_writes_down_why_and_what(accepted):
    change_error(accepted)
    lose_a_figure(accepted)
    accepted.verdicts["records"].append(verdict("twist"))
    accepted.verdicts["published"] = []
    text = accepted.accept("  coarser on purpose ")
    assert "accuracy: 1 new, 1 changed, 1 gone" in text
    first, second = accepted.baseline()["history"]
    assert first["reason"] == "a test"
    assert second["reason"] == "coarser on purpose" and second["revision"] == ORIGIN["revision"]
    assert second["changed"] == {"accuracy": "1 new, 1 changed, 1 gone"}
    assert second["date"][:2] == "20" and second["machine"] == "Abacus 3; GNU 12.2.0; Release"
    assert accepted.call()[0] == 0


def test_accepting_one_source_leaves_the_others(accepted):
    before = accepted.baseline()
    change_error(accepted)
    add_a_multiplication(accepted)
    accepted.accept(sources=["operations"])
    after = accepted.baseline()
    differing = [new["area"] for old, new in zip(before["records"], after["records"]) if old != new]
    assert differing == ["operations"] and before["machines"] == after["machines"]


def test_errors_cannot_creep(accepted):
    """Each step is within the margin; accepting keeps the first figure all the same."""
    margin = RELATIVE * 0.01 + FLOOR["double"]
    figures = accepted.verdicts["records"][0]["golden"]
    before = accepted.baseline()["records"]
    figures["max_relative_error"] = 0.01 + 0.7 * margin
    accepted.accept()
    assert accepted.baseline()["records"] == before
    figures["max_relative_error"] = 0.01 + 1.4 * margin
    assert accepted.call()[0] == 1


def test_accepting_on_another_machine_adds_it(accepted):
    for document in accepted.bench:
        document["processor"] = "Abacus 4"
    accepted.accept()
    names = ["Abacus 3; GNU 12.2.0; Release", "Abacus 4; GNU 12.2.0; Release"]
    assert list(accepted.baseline()["machines"]) == names
    assert accepted.call()[0] == 0


def test_baseline_has_a_record_a_line_and_is_read_back(accepted):
    file = accepted.path / "baseline.json"
    text = file.read_text()
    records = [line for line in text.splitlines() if line.strip().startswith('{"area"')]
    document = json.loads(text)
    listed = document["records"] + [r for of in document["machines"].values() for r in of]
    assert [json.loads(line.strip().rstrip(",")) for line in records] == listed
    assert baselines.text_of(baselines.read(file)) == text
    names = [(record["area"], record["name"]) for record in document["records"]]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("reason", [[], ["--reason", "  "]], ids=["none", "blank"])
def test_accepting_needs_a_reason(folder, reason):
    code, text = folder.call("--accept", *reason)
    assert code == 2 and "--reason TEXT is required" in text
    assert not (folder.path / "baseline.json").exists()


def test_accepting_needs_enough_processes(folder):
    folder.bench = folder.bench[:2]
    code, text = folder.call("--accept", "--reason", "a test")
    assert code == 2 and "too few processes" in text
    assert not (folder.path / "baseline.json").exists()


def test_a_baseline_appears_whole_or_not_at_all(accepted, monkeypatch):
    file = accepted.path / "baseline.json"
    before = file.read_text()

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", refuse)
    with pytest.raises(InputError, match="baseline.json: cannot be written: No space left"):
        baselines.write(file, baselines.Baseline())
    assert file.read_text() == before
