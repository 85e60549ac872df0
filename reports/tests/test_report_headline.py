"""The README's figure is made from stored records, which match the current program."""

import copy
import dataclasses
import json
from xml.etree import ElementTree

import pytest
from test_report_plausible import STEP, point, timed

import make_headline
from common.errors import InputError
from common.program import ROOT, binary, output_of
from sandglass_report import headline
from sandglass_report.headline import CASE, METHODS, NAME, caption, figure
from sandglass_report.style import FLOOR

# Residuals are below 1e-8 of the forces on any machine; a tenth of the last digit shown.
ERRORS_AGREE = 5e-3
# On all machines so far the time of a method over that of tl-perturbation was within 1.4 times the
# ratio of their operations.
COSTS_AGREE = 1.5
ROUNDED = 0.01  # rounding of the printed times
OWN = {"processor": "CPU", "version": "1", "revision": "abc", "compiler": "none"}
FACTS = {  # golden, truth, ns and operations, about as measured
    "linear": (0.317, 0.259, 20.0, 487),
    "tl-perturbation": (0.066, 0.135, 23.0, 598),
    "ul-perturbation": (0.056, 0.146, 62.0, 1241),
    "tl-full": (0.242, 0.303, 73.0, 2186),
    "tl-mean-dilatation": (1e-8, 0.143, 77.0, 2202),
}


def of_mesh(ns):
    """The costs that follow from a time per element and step on the case's mesh."""
    costs = {name: 2.2 * value for name, value in timed(ns, STEP).items()}
    return costs | {"ns": ns, "mean_step": STEP, "case": CASE, "elements": 2200}


def points():
    """Points of the case as the main chart has them."""
    return [
        point(
            method=method,
            operations=work,
            golden={"max": golden},
            truth={"max": truth},
            **of_mesh(ns),
        )
        for method, (golden, truth, ns, work) in FACTS.items()
    ]


@pytest.fixture(name="document")
def document_of_points():
    """The document of these points, through JSON."""
    return json.loads(json.dumps(headline.headline(points(), OWN)))


def test_the_stored_figure_is_made_from_its_records():
    folder = ROOT / make_headline.FOLDER
    document = json.loads((folder / f"{NAME}.json").read_text(encoding="utf-8"))
    assert (folder / f"{NAME}.svg").read_text(encoding="utf-8") == figure(document)


def test_the_text_around_the_figure_has_its_numbers():
    document = json.loads((ROOT / make_headline.FOLDER / f"{NAME}.json").read_text())
    text = (ROOT / make_headline.README).read_text(encoding="utf-8")
    words = caption(document, make_headline.FIGURE, make_headline.GLOSSARY)
    assert headline.replaced(text, words) == text


def test_the_stored_records_are_those_of_the_program(tmp_path):
    """Each method is run and scored again; its cost is checked by its operations."""
    document = json.loads((ROOT / make_headline.FOLDER / f"{NAME}.json").read_text())
    program, errors = binary(), {}
    for method in METHODS:
        answer, scores = tmp_path / f"{method}.h5", tmp_path / "scores.json"
        output_of(program, "run", CASE, "--method", method, "-o", answer, cwd=ROOT)
        output_of(program, "score", answer, "--case", CASE, "--json", scores, cwd=ROOT)
        (record,) = json.loads(scores.read_text())["records"]
        errors[method] = [record[name]["max_relative_error"] for name in ("golden", "truth")]
    output_of(program, "flops", "--json", tmp_path / "flops.json")
    operations = {
        record["method"]: record["total"]
        for record in json.loads((tmp_path / "flops.json").read_text())["records"]
        if (record["form"], record["part"]) == ("kernel", "element")
    }
    times = {record["method"]: record["ns_per_element_step"] for record in document["methods"]}
    for record in document["methods"]:
        method, ns = record["method"], record["ns_per_element_step"]
        stored = [record["golden"], record["truth"]]
        assert stored == pytest.approx(errors[method], rel=ERRORS_AGREE, abs=FLOOR), method
        assert record["operations"] == operations[method], method
        work = operations[method] / operations["tl-perturbation"]
        assert 1 / COSTS_AGREE < ns / work / times["tl-perturbation"] < COSTS_AGREE, method
        step = 1e-9 * (ns + record["check_ns_per_element_step"]) * document["elements"]
        second = pytest.approx(step / record["mean_step_seconds"], rel=ROUNDED)
        assert record["seconds_per_simulated_second"] == second, method


def test_the_captions_claims_about_methods_are_true():
    document = json.loads((ROOT / make_headline.FOLDER / f"{NAME}.json").read_text())
    at = {record["method"]: record for record in document["methods"]}
    sound = at["tl-mean-dilatation"]["truth"]
    assert at["tl-mean-dilatation"]["golden"] < FLOOR
    assert at["tl-perturbation"]["truth"] < 1.1 * sound
    assert min(at["tl-full"]["truth"], at["linear"]["truth"]) > 1.5 * sound


def test_a_figure_has_every_method_and_both_colourings(document):
    text = figure(document)
    ElementTree.fromstring(text)
    assert text == figure(copy.deepcopy(document))
    assert "prefers-color-scheme: dark" in text
    for method, words in METHODS.items():
        assert f">{method}<" in text and f">{words}<" in text
    for shown in (">14 %<", ">6.6 %<", ">0 %<", ">real time, 1 s<"):
        assert shown in text


def test_a_bar_is_as_long_as_its_time_and_a_mark_stands_at_its_error(document):
    tree = ElementTree.fromstring(figure(document))
    bars = [float(r.get("width")) for r in tree.iter("{http://www.w3.org/2000/svg}rect")][1:]
    seconds = [r["seconds_per_simulated_second"] for r in document["methods"]]
    assert [w / bars[0] for w in bars] == pytest.approx([s / seconds[0] for s in seconds], 0.01)
    circles = list(tree.iter("{http://www.w3.org/2000/svg}circle"))
    filled = [float(c.get("cx")) for c in circles if c.get("fill") != "var(--panel)"]
    truths = [r["truth"] for r in document["methods"]]
    by_error = sorted(range(len(truths)), key=truths.__getitem__)
    assert by_error == sorted(range(len(filled)), key=filled.__getitem__)


@pytest.mark.parametrize(
    "changed",
    [{"simulated": None}, {"truth": {}}, {"elsewhere": "another"}, {"precision": "float"}],
)
def test_without_a_number_there_is_no_figure(changed):
    found = [dataclasses.replace(p, **(changed if p.method == "tl-full" else {})) for p in points()]
    assert headline.headline(found, OWN) is None


def test_one_command_makes_figure_records_and_texts(tmp_path, document, capsys):
    tree, records = tmp_path / "tree", tmp_path / "records.json"
    (tree / make_headline.FOLDER).mkdir(parents=True)
    readme = tree / make_headline.README
    readme.write_text(f"before\n{headline.START}\nold\n{headline.END}\nafter\n")
    records.write_text(json.dumps(document))
    make_headline.make(records, tree)
    assert capsys.readouterr().out.count("\n") == 2
    text = readme.read_text()
    assert text.startswith("before\n") and text.endswith("after\n") and "\nold\n" not in text
    assert "(reports/figures/speed-accuracy.svg)" in text and "tl-full 30 %, 24 %" in text
    words = " ".join(text.split())  # of lines that break anywhere
    assert (
        "its error to the truth is 14 %" in words
        and "0.16 s per simulated second instead of 0.46 s" in words
    )
    assert (tree / make_headline.FIGURE).read_text() == figure(document)
    assert json.loads((tree / make_headline.FOLDER / f"{NAME}.json").read_text()) == document


def test_broken_records_are_refused(tmp_path, document):
    del document["methods"][0]["truth"]
    (tmp_path / "a.json").write_text(json.dumps(document))
    with pytest.raises(InputError, match=r"methods\[0\].truth is missing"):
        make_headline.make(tmp_path / "a.json", tmp_path)
    with pytest.raises(InputError, match="has no lines"):
        headline.replaced("a text without a figure", "figure")
