"""Bad usage and input: exit code 2, one line that names file or key, value and rule."""

import pytest
from gate import __main__ as command


def wrong_option(folder):
    return ["--most", "1"], "--most = 1 must be 12 or more"


def lonely_reason(folder):
    return ["--reason", "x"], "--reason: goes with --accept"


def no_verdicts(folder):
    return ["--verdicts", str(folder.path / "none.json")], "none.json: cannot be read: No such file"


def broken_json(folder):
    (folder.path / "x.json").write_text("{")
    return ["--flops", str(folder.path / "x.json")], "x.json: not a JSON file"


def a_list(folder):
    return ["--flops", folder.write("x.json", [])], "x.json: must be an object, not list"


def no_records(folder):
    return ["--flops", folder.write("x.json", {})], "x.json: records is missing; it must be a list"


def missing_key(folder):
    del folder.flops["records"][0]["mul"]
    return [], "f.json: records[0].mul is missing; it must be a whole number"


def wrong_kind(folder):
    folder.verdicts["records"][0]["case"] = 3
    return [], "v.json: records[0].case = 3 must be a text"


def twice(folder):
    folder.verdicts["records"] *= 2
    return [], "'column, tl-full, double' is there twice"


def no_time(folder):
    folder.bench[1]["records"][2]["ns_best"] = None
    return [], "b1.json: records[2].ns_best = None must be a number"


def two_machines(folder):
    folder.bench[1]["processor"] = "Abacus 4"
    return [], "must be of one machine and one revision"


def errors_of_another_machine(folder):
    folder.verdicts["processor"] = "Abacus 4"
    return [], "machine = 'Abacus 3; GNU 12.2.0; Release' must be 'Abacus 4; GNU"


def two_revisions(folder):
    folder.verdicts["revision"] = "ba9876543210"
    return [], "revision = '0123456789ab' must be 'ba9876543210', as of the others"


def unknown_baseline(folder):
    folder.write("baseline.json", {"format": 7})
    return [], "baseline.json: format = 7 must be 1"


def unknown_area(folder):
    document = folder.baseline()
    document["records"][0]["area"] = "taste"
    folder.write("baseline.json", document)
    return [], "records[0].area = 'taste' is not known; known: accuracy, operations"


def half_an_interval(folder):
    document = folder.baseline()
    (records,) = document["machines"].values()
    records[-1]["over pace"] = [1.0, 2.0]
    folder.write("baseline.json", document)
    return [], "over pace = [1.0, 2.0] must be low, median and high"


WRONG = (wrong_option, lonely_reason, no_verdicts, broken_json, a_list, no_records, missing_key)
WRONG += (wrong_kind, twice, no_time, two_machines, errors_of_another_machine, two_revisions)
WRONG += (unknown_baseline, unknown_area)
WRONG += (half_an_interval,)


@pytest.mark.parametrize("mistake", WRONG, ids=lambda mistake: mistake.__name__)
def test_wrong_input_is_refused(accepted, mistake):
    options, told = mistake(accepted)
    code, text = accepted.call(*options)
    assert code == 2
    assert text.startswith("error: ") and told in text and len(text.splitlines()) == 1


def test_unknown_source_is_refused(folder):
    code, text = folder.call(sources=["taste"])
    assert code == 2 and "known: accuracy, operations, bits, speed" in text


def test_no_baseline_is_refused_unless_accepted(folder):
    code, text = folder.call()
    assert code == 2 and "baseline.json: cannot be read" in text


def test_no_program_is_told(folder, monkeypatch):
    monkeypatch.setenv("SANDGLASS_BINARY", str(folder.path / "none"))
    folder.accept()
    code = command.main(
        [
            "operations",
            "--baseline",
            str(folder.path / "baseline.json"),
            "-o",
            str(folder.path / "out"),
        ]
    )
    assert code == 2 and "no program there" in folder.capsys.readouterr().err
