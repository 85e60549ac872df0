"""ci/gate --accept: the contents of the baseline, the reasons, and the file."""

import json

import pytest
from gate import baseline as baselines
from gate.compare import FLOOR, RELATIVE, UNGATED
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
    """Each step is within the margin; accepting nevertheless keeps the first figure."""
    margin = RELATIVE * 0.01 + FLOOR["double"]
    figures = accepted.verdicts["records"][0]["golden"]
    before = accepted.baseline()["records"]
    figures["max_relative_error"] = 0.01 + 0.7 * margin
    accepted.accept()
    assert accepted.baseline()["records"] == before
    figures["max_relative_error"] = 0.01 + 1.4 * margin
    assert accepted.call()[0] == 1


def test_accepting_on_another_machine_adds_it(accepted):
    accepted.move_to("Abacus 4")
    accepted.accept()
    names = ["Abacus 3; GNU 12.2.0; Release", "Abacus 4; GNU 12.2.0; Release"]
    assert list(accepted.baseline()["machines"]) == names
    assert accepted.call()[0] == 0


def accuracy(records):
    """Names of the records of accuracy and their largest errors against the golden."""
    return {r["name"]: r.get("golden max") for r in records if r["area"] == "accuracy"}


def test_errors_that_another_machine_finds_are_its_own(accepted):
    """Back on the first machine, the figures accepted there still apply."""
    change_error(accepted)  # column, tl-full
    accepted.move_to("Abacus 4")
    code, text = accepted.call()
    assert code == 1 and "; accepted on another machine" in text
    before = accepted.baseline()
    accepted.accept()
    after = accepted.baseline()
    assert after["records"] == before["records"]
    assert after["machine"] == "Abacus 3; GNU 12.2.0; Release"
    changed = accepted.verdicts["records"][0]["golden"]["max_relative_error"]
    own = after["machines"]["Abacus 4; GNU 12.2.0; Release"]
    assert accuracy(own) == {"column, tl-full, double": changed}
    assert accepted.call()[0] == 0
    accepted.move_to("Abacus 3")
    code, text = accepted.call()
    assert code == 1 and "accepted on another machine" not in text


def test_what_comes_and_goes_on_another_machine_does_so_on_all(accepted):
    accepted.verdicts["records"] = [verdict("twist")]
    accepted.move_to("Abacus 4")
    accepted.accept()
    assert list(accuracy(accepted.baseline()["records"])) == [
        "cook-2, tl-full, double",
        "twist, tl-full, double",
    ]
    accepted.move_to("Abacus 3")
    assert accepted.call()[0] == 0


def test_errors_of_a_machine_do_not_make_its_times_known(accepted):
    change_error(accepted)
    accepted.move_to("Abacus 4")
    accepted.accept(sources=["accuracy"])
    code, text = accepted.call()
    assert code == 0 and UNGATED in text.strip().splitlines()[-1]


def test_operations_are_those_of_all_machines(accepted):
    """Counts do not depend on the machine, so those of another machine replace the first's."""
    add_a_multiplication(accepted)
    accepted.move_to("Abacus 4")
    accepted.accept()
    accepted.move_to("Abacus 3")
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
