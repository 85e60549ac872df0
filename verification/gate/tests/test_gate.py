"""The gate: every rule at, below and above its limit, regressions, acceptance, wrong input."""

import copy
import json

import pytest
from gate import __main__ as command
from gate import baseline as baselines
from gate.figures import FLOOR, RELATIVE, judge_error

ORIGIN = {"revision": "0123456789ab", "processor": "Abacus 3"}
ORIGIN |= {"compiler": "GNU 12.2.0", "build_flags": "Release"}
MACHINE = "Abacus 3; GNU 12.2.0; Release"
COLUMN = "column, tl-full, double"


def verdict(case="column", **changed):
    """A record of `sandglass verify`."""
    figures = {"max_relative_error": 0.01, "profile_relative_error": None}
    figures["rms_relative_error"] = 2e-3
    record = {"case": case, "method": "tl-full", "kappa": None, "kappa_is_auto": False}
    record |= {"precision": "double", "status": "ok", "golden": figures, "truth": None}
    return copy.deepcopy(record | changed)


class Folder:
    """Files for the gate and a baseline."""

    def __init__(self, path, capsys):
        self.path, self.capsys = path, capsys
        tip = {"set": "tip", "component": "z", "ratio": 0.98}
        values = [tip, tip | {"component": "x", "ratio": None}]
        self.verdicts = ORIGIN | {"records": [verdict()]}
        self.verdicts["published"] = [verdict("cook-2", golden=None, values=values)]
        counts = {"add": 250, "mul": 179, "div": 0, "special": 1, "total": 430, "bytes": 264}
        names = {"method": "tl-none", "law": "neo-hookean", "form": "kernel", "part": "element"}
        self.flops = {"records": [names | counts]}

    def call(self, *more):
        """(exit code, printed text)."""
        words = ["--baseline", str(self.path / "baseline.json"), "-o", str(self.path)]
        for option in ("verdicts", "flops"):
            file = self.path / f"{option}.json"
            if not isinstance(getattr(self, option), str):
                file.write_text(json.dumps(getattr(self, option)))
            else:
                file.write_text(getattr(self, option))
            words += [f"--{option}", str(file)]
        code = command.main([*more, *words])
        printed = self.capsys.readouterr()
        return code, printed.out + printed.err

    def accept(self, *areas):
        code, text = self.call(*areas, "--accept", "--reason", " a test ")
        assert code == 0, text
        return text

    @property
    def golden(self):
        """The errors of the first record."""
        return self.verdicts["records"][0]["golden"]

    @property
    def baseline(self):
        return json.loads((self.path / "baseline.json").read_text())


@pytest.fixture
def folder(tmp_path, capsys):
    """Files equal to the baseline."""
    made = Folder(tmp_path, capsys)
    made.accept()
    return made


def test_what_was_accepted_passes(folder):
    code, text = folder.call()
    # Status and two errors, status and tip, five counts.
    assert (code, text) == (0, "gate: passed: 10 figures, 0 regressions\n")
    assert (folder.path / "gate.txt").read_text() == text


def set_figure(figure, value):
    """A change of the golden's errors."""
    return lambda folder: folder.golden.update({figure: value})


def set_tip(ratio):
    """A change of a published value."""
    return lambda folder: folder.verdicts["published"][0]["values"][0].update(ratio=ratio)


def be_a_force(folder):
    """A published value of obstacles, which only the limits of its case judge."""
    folder.verdicts["published"][0]["values"][0]["of"] = "force"


def count(**counts):
    """A change of operations."""
    return lambda folder: folder.flops["records"][0].update(counts)


def fail(folder):
    """A run that finds no equilibrium; the point where it stopped does not matter."""
    folder.verdicts["records"][0]["status"] = "failed: not at rest"
    folder.golden["max_relative_error"] = 0.5


def lose_a_case(folder):
    folder.verdicts["records"][0]["case"] = "pillar"


@pytest.mark.parametrize(
    "change, line",
    [
        (set_figure("max_relative_error", 0.0101), f"WORSE accuracy {COLUMN} golden max"),
        (set_figure("rms_relative_error", None), f"VANISHED accuracy {COLUMN} golden rms"),
        (set_tip(0.9798), "WORSE accuracy cook-2, tl-full, double published tip z"),
        (set_tip(1.0202), "WORSE accuracy cook-2, tl-full, double published tip z"),
        (be_a_force, "VANISHED accuracy cook-2, tl-full, double published tip z"),
        (fail, f"WORSE accuracy {COLUMN} status ok failed no longer comes to rest"),
        (lose_a_case, f"VANISHED accuracy {COLUMN} golden max"),
        (count(mul=180), "WORSE operations tl-none, neo-hookean, kernel, element mul 179 180 +1;"),
        (count(mul=180, add=249), "WORSE operations tl-none, neo-hookean, kernel, element mul"),
    ],
)
def test_regressions_fail(folder, change, line):
    change(folder)
    code, text = folder.call()
    assert code == 1 and "gate: FAILED" in text
    assert line in " ".join(text.split())


def test_improvements_and_what_is_new_pass(folder):
    folder.golden["max_relative_error"] = 0.009
    folder.flops["records"][0]["add"] -= 1
    folder.verdicts["records"].append(verdict("twist"))
    code, text = folder.call()
    assert code == 0 and text.endswith("0 regressions, 3 new, 2 better\n")


def test_a_run_that_converges_again_is_better(folder):
    fail(folder)
    folder.accept()
    folder.golden["max_relative_error"] = 0.7
    assert folder.call()[0] == 0
    folder.verdicts["records"][0] = verdict()
    code, text = folder.call()
    assert code == 0 and "comes to rest" in text


def test_only_the_areas_asked_for_are_compared(folder):
    folder.golden["max_relative_error"] = 0.02
    assert folder.call("operations")[0] == 0
    assert folder.call("accuracy")[0] == 1


@pytest.mark.parametrize("precision", ["double", "float"])
@pytest.mark.parametrize("error", [0.0, 1e-6, 0.01, 1.0])
def test_errors_may_move_by_share_and_floor(error, precision):
    margin = RELATIVE * error + FLOOR[precision]
    for sign, verdict_beyond in ((1, "WORSE"), (-1, "better")):
        assert judge_error(error, error + sign * 0.99 * margin, precision)[0] == "same"
        assert judge_error(error, error + sign * 1.01 * margin, precision)[0] == verdict_beyond


def test_accepting_writes_down_why_and_what(folder):
    folder.golden.update(max_relative_error=0.0101, rms_relative_error=None)
    folder.verdicts["records"].append(verdict("twist"))
    folder.verdicts["published"] = []
    assert "accuracy: 1 new, 1 changed, 1 gone" in folder.accept()
    entry = folder.baseline["history"][1]
    assert entry["date"][:2] == "20" and entry["changed"] == {
        "accuracy": "1 new, 1 changed, 1 gone"
    }
    assert (entry["reason"], entry["revision"], entry["machine"]) == (
        "a test",
        ORIGIN["revision"],
        MACHINE,
    )
    assert folder.call()[0] == 0


def test_accepting_one_area_leaves_the_other(folder):
    before = folder.baseline["records"]
    folder.golden["max_relative_error"] = 0.02
    folder.flops["records"][0]["mul"] += 1
    folder.accept("operations")
    pairs = zip(before, folder.baseline["records"], strict=True)
    assert [old["area"] for old, new in pairs if old != new] == ["operations"]


def test_errors_cannot_creep(folder):
    """Each step is within the margin; accepting it still keeps the first figure."""
    margin = RELATIVE * 0.01 + FLOOR["double"]
    before = folder.baseline["records"]
    folder.golden["max_relative_error"] = 0.01 + 0.7 * margin
    folder.accept()
    assert folder.baseline["records"] == before
    folder.golden["max_relative_error"] = 0.01 + 1.4 * margin
    assert folder.call()[0] == 1


def test_errors_of_another_machine_are_its_own(folder):
    """Figures that differ; new and missing ones, and operations, concern all machines."""
    before = folder.baseline["records"]
    folder.golden["max_relative_error"] = 0.02
    folder.verdicts["processor"] = "Abacus 4"
    assert folder.call()[0] == 1
    folder.accept()
    after = folder.baseline
    assert after["records"] == before and after["machine"] == MACHINE
    own = after["machines"][MACHINE.replace("3", "4", 1)]
    assert [(record["name"], record["golden max"]) for record in own] == [(COLUMN, 0.02)]
    assert folder.call()[0] == 0
    folder.verdicts["processor"] = "Abacus 3"
    assert folder.call()[0] == 1
    folder.verdicts |= {"processor": "Abacus 4", "records": [verdict("twist")]}
    folder.flops["records"][0]["mul"] += 1
    folder.accept()
    folder.verdicts["processor"] = "Abacus 3"
    assert folder.call() == (0, "gate: passed: 10 figures, 0 regressions\n")
    assert folder.baseline["machines"] == {}


def test_the_baseline_has_a_record_a_line_and_is_read_back(folder):
    file = folder.path / "baseline.json"
    lines = [line.strip(" ,") for line in file.read_text().splitlines()]
    records = [json.loads(line) for line in lines if line.startswith('{"area"')]
    assert records == folder.baseline["records"] and len(records) == 3
    assert baselines.text_of(baselines.read(file)) == file.read_text()


def test_the_projects_baseline_is_read_and_written_alike():
    file = command.Path(command.__file__).with_name("baseline.json")
    assert baselines.text_of(baselines.read(file)) == file.read_text()


def repeat(folder):
    folder.verdicts["records"] *= 2


def spoil_format(folder):
    (folder.path / "baseline.json").write_text('{"format": 7}')


def spoil_area(folder):
    text = (folder.path / "baseline.json").read_text()
    (folder.path / "baseline.json").write_text(
        text.replace('"accuracy", "name"', '"taste", "name"')
    )


@pytest.mark.parametrize(
    "spoil, words, said",
    [
        (repeat, [], f"'{COLUMN}' is there twice"),
        (spoil_format, [], "baseline.json: format = 7 must be 1"),
        (spoil_area, [], "records[0].area = 'taste' is not known; known: accuracy, operations"),
        (None, ["taste"], "'taste' is not known; known: accuracy, operations"),
        (None, ["--reason", "x"], "--reason: goes with --accept"),
        (None, ["--accept", "--reason", "  "], "--reason TEXT is required"),
    ],
)
def test_wrong_input_is_refused(folder, spoil, words, said):
    if spoil:
        spoil(folder)
    before = (folder.path / "baseline.json").read_text()
    code, text = folder.call(*words)
    assert code == 2
    assert text.startswith("error: ") and said in text and len(text.splitlines()) == 1
    assert (folder.path / "baseline.json").read_text() == before


def test_no_baseline_is_refused_unless_accepted(folder):
    (folder.path / "baseline.json").unlink()
    code, text = folder.call()
    assert code == 2 and "baseline.json: cannot be read" in text


def test_a_program_that_fails_is_exit_code_3(folder, monkeypatch, capsys):
    script = folder.path / "sandglass"
    script.write_text("#!/bin/sh\necho error: no such thing >&2; exit 3\n")
    script.chmod(0o755)
    monkeypatch.setenv("SANDGLASS_BINARY", str(script))
    words = ["--baseline", str(folder.path / "baseline.json"), "-o", str(folder.path)]
    for area in ("accuracy", "operations"):
        assert command.main([area, *words]) == 3
        assert "ended with 3: no such thing" in capsys.readouterr().err


def test_operations_of_the_program_itself(tmp_path, capsys):
    """The only quick area: once accepted, it passes; with one more operation, it fails."""
    words = ["operations", "--baseline", str(tmp_path / "baseline.json"), "-o", str(tmp_path)]
    assert command.main([*words, "--accept", "--reason", "a test"]) == 0
    assert command.main(words) == 0
    baseline = baselines.read(tmp_path / "baseline.json")
    baseline.figures["operations", "tl-perturbation, neo-hookean, kernel, element"]["mul"] -= 1
    baselines.write(tmp_path / "baseline.json", baseline)
    capsys.readouterr()
    assert command.main(words) == 1
    assert "+1; must be equal" in capsys.readouterr().out
