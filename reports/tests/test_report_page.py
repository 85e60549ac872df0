"""The whole report from a tiny data set: contents of the page."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest
from synthetic import DataSet

VOID = {"meta", "link", "br", "hr", "img", "input"}


class Balance(HTMLParser):
    """Checks that every element is closed, and collects ids and targets."""

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.targets = [], [], []

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open.append(tag)
        attributes = dict(attrs)
        self.ids += [attributes["id"]] if "id" in attributes else []
        target = attributes.get("href") or attributes.get("xlink:href") or attributes.get("src")
        self.targets += [target] if target else []

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """The data set as it is, with its page made."""
    data = DataSet(tmp_path_factory.mktemp("plain"))
    data.make()
    return data


@pytest.fixture
def page(plain):
    """The page of the data set as it is, as text."""
    return plain.page.read_text(encoding="utf-8")


def test_the_page_is_written_as_a_whole(plain, page):
    assert "All 1 limits hold" in page
    assert [path.name for path in plain.page.parent.iterdir() if path.name.startswith(".")] == []


def test_page_is_well_formed(page):
    parser = Balance()
    parser.feed(page)
    assert parser.open == []
    assert len(parser.ids) == len(set(parser.ids))
    assert all(target[1:] in parser.ids for target in parser.targets)


def test_page_loads_nothing(plain, page):
    assert re.search(r"""(src|href|url)\s*[=(]\s*["']?(https?:|//|file:)""", page) is None
    assert "@import" not in page and "<link" not in page
    assert str(plain.folder) not in page


def test_page_is_the_same_when_made_again(plain, page):
    assert plain.make() == page


def test_a_failed_run_is_shown_with_its_reason(page):
    assert "failed: &lt;inverted&gt;" in page
    assert "runs with default settings on 1 case, 1 fails" in page


def test_a_missing_truth_is_reported(page):
    assert "no truth is stored" in page


def test_a_truth_gives_the_goldens_own_error(data):
    data.write_reference("truth", data.answer * [1.0, 1.0, 1.1], element="P2-P1", refinements=1)
    assert "no run has a figure against the truth" in data.make()
    for record in data.records[1:3]:
        record["truth"] = record["golden"] | {"max_relative_error": 0.08}
    data.write_verdicts()
    page = data.make()
    assert "no truth is stored" not in page
    assert "golden to truth, max" in page
    assert "8.00 %" in page  # 0.1 * 0.4 m over 0.5 m
    assert "edges split 1×" in page


def test_a_broken_limit_comes_first(data):
    broken = data.limits[0] | {"below": 0.001, "holds": False, "reason": "a reason of its own"}
    data.limits.append(broken)
    data.write_verdicts()
    page = data.make()
    assert "1 of 2 limits is BROKEN" in page
    assert page.index("a reason of its own") < page.index("it is the paper&#39;s")


def test_a_case_whose_runs_all_failed_makes_a_page(data):
    data.records = [data.records[-1]]
    data.limits = []
    data.write_verdicts()
    for path in (data.folder / "results").iterdir():
        path.unlink()
    page = data.make()
    assert "No limits were checked" in page
    assert "No mesh: no run has a result file" in page


def test_an_exploded_run_makes_a_page(data):
    error = 1e9
    data.records[0] = data.run("tl-none", error) | {"status": "failed: not at rest"}
    data.write_verdicts()
    page = data.make()
    assert "failed: not at rest" in page


def test_an_exact_method_is_named_below_the_scale(data):
    data.records.append(data.run("tl-mean-dilatation", 3e-8))
    data.write_verdicts()
    assert "tl-mean-dilatation 3·10⁻⁶ %" in data.make()


def test_a_ninth_and_further_method_gets_a_pair_of_its_own():
    from sandglass_report.style import Palette

    palette = Palette([f"m{i}" for i in range(20)])
    pairs = {(palette.colour(m), palette.mark(m)) for m in palette.methods}
    assert len(pairs) == 20


def test_labels_do_not_overlap():
    from sandglass_report.axes import spread

    moved = spread([5.0, 5.0, 5.5, 40.0], gap=10.0, low=0.0, high=100.0)
    assert np.diff(np.sort(moved)).min() >= 10.0 - 1e-5
    assert moved.min() >= -1e-5


def test_published_values_stand_in_tables(data):
    data.published = [
        data.tip("tl-none", 12000.0),
        data.tip("tl-none", 0.5, "long", status="failed: inverted"),
        data.tip("tl-full", 0.7654),
        data.tip("tl-full", 0.9876, "long", to_truth=0.9321),
    ]
    data.write_verdicts()
    page = data.make()
    assert "over a book" in page and "over the truth" in page
    for cell in (">1.2·10⁴<", ">0.765<", ">0.988<", ">0.932<"):
        assert cell in page
    assert ">0.500<" not in page.partition('id="runs"')[0]  # a failed run has no ratio


def test_without_published_values_there_is_no_section(page):
    assert 'id="beams"' not in page


def test_a_number_keeps_its_percent_sign_on_its_line(page):
    from sandglass_report.page import with_hard_spaces

    html = '<p title="3 %">10 % of <b>5</b> % <script>a = 7 % b;</script>2 %</p>'
    hard = html.replace("10 %", "10\u00a0%").replace("2 %", "2\u00a0%")
    assert with_hard_spaces(html) == hard
    text = re.sub(r"<(script|style)\b.*?</\1>|<[^>]*>", "", page, flags=re.DOTALL)
    assert re.search(r"\d\u00a0%", text) and not re.search(r"\d %", text)
    assert "without the checks of a run" in page
