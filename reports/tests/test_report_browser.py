"""The page in a headless Chromium: it draws, its controls work, it requests nothing."""

import json
import re
import time

import pytest
from browser import CHROMIUM, PATIENCE, Browser
from synthetic import DataSet

from sandglass_report.quantities import COSTS, QUANTITIES

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
POINTS = "JSON.parse(document.querySelector('#chart-data').textContent).points"
DRAWN = "document.querySelector('#chart').dataset.drawn"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page of the data set with candidates of `choose` and a truth."""
    data = DataSet(tmp_path_factory.mktemp("browser"))
    rows = [data.row("tl-perturbation", 2e-6, 0.004, precision="float")]
    rows += [data.row("tl-perturbation", 1e-6, 0.03, mesh="elements = [1]", elements=1)]
    rows += [data.row("tl-perturbation", 4e-6, 0.002)]
    data.write("curves/a.json", data.choices(rows))
    for record in data.records[1:3]:
        record["truth"] = record["golden"] | {"max_relative_error": 0.08}
    data.write_reference("truth", data.answer * [1.0, 1.0, 1.1])
    data.write_verdicts()
    data.make()
    return data.page


@pytest.fixture(scope="module")
def browser(page):
    """A browser that shows the page after drawing."""
    with Browser() as found:
        found.open(page)
        found.until(DRAWN)
        yield found


def choose(browser, name, value):
    """Sets a control of the chart as a user does, and waits for the drawing."""
    browser.run(
        f"""(async () => {{
          const chart = document.querySelector("#chart");
          const control = chart.querySelector("[name={name}]");
          const was = {str(isinstance(value, bool)).lower()} ? "checked" : "value";
          control[was] = {str(value).lower() if isinstance(value, bool) else repr(value)};
          control.dispatchEvent(new Event("input", {{ bubbles: true }}));
          await new Promise((done) => setTimeout(done, 300));
        }})()"""
    )


def marks(browser):
    """(x, y) of the coloured and of the grey marks, as drawn."""
    return browser.run(
        """(() => {
          const traces = document.querySelector("#chart .plot").data;
          const shown = traces.filter((trace) => trace.mode === "markers").reverse();
          return shown.map((trace) => trace.x.map((x, i) => [x, trace.y[i]]));
        })()"""
    )


def test_everything_is_drawn_without_messages_on_the_console(browser):
    assert browser.run(DRAWN) == "column|golden|max|simulated|all|all"
    assert browser.run("document.querySelectorAll('#chart .scatterlayer .point').length") == 4
    assert browser.run("document.querySelector('#viewer').dataset.drawn") == "column"
    assert browser.run("document.querySelector('details.static').open") is False
    assert browser.complaints == []


def test_the_page_requests_nothing(browser):
    assert [url for url in browser.requests if not url.startswith(("file:", "data:"))] == []
    assert len([url for url in browser.requests if url.startswith("file:")]) == 1


def test_the_limits_grey_out_what_breaks_them(browser):
    sound, grey = marks(browser)
    assert sorted(y for _, y in sound) == [0.002, 0.004]
    assert sorted(y for _, y in grey) == [0.03, 0.2]
    choose(browser, "tolerance", -2.6)  # 0.25 %
    assert [y for _, y in marks(browser)[0]] == [0.002]
    assert "tl-perturbation, double" in browser.run("document.querySelector('.answer').textContent")
    choose(browser, "tolerance", -1)
    assert "mesh of 1 elements" in browser.run("document.querySelector('.answer').textContent")
    choose(browser, "tolerance", -2)


def test_the_budget_counts_too(browser):
    choose(browser, "cost", "step")
    budget = "document.querySelector('[name=budget]')"
    browser.run(f"{budget}.value = Math.log10(1.7e-6)")
    choose(browser, "own", True)
    assert [y for _, y in marks(browser)[0]] == [0.002]
    choose(browser, "own", False)
    choose(browser, "cost", "simulated")


@pytest.mark.parametrize(
    ("name", "value", "back", "errors"),
    [
        ("own", True, False, [0.002, 0.004, 0.2]),
        ("double", True, False, [0.002, 0.03, 0.2]),
        ("curves", True, False, [0.002, 0.004, 0.004, 0.03, 0.2]),
        ("reference", "truth", "golden", [0.08]),
        ("figure", "profile", "max", [0.002, 0.2]),
        ("cost", "equilibrium", "simulated", [0.002, 0.2]),
    ],
)
def test_switches_choose_what_is_shown(browser, name, value, back, errors):
    choose(browser, name, value)
    shown = sorted(y for trace in marks(browser) for _, y in trace)
    choose(browser, name, back)
    assert shown == errors


def test_a_method_can_be_hidden_and_shown(browser):
    click = "document.querySelector('[data-method=tl-none]').click()"
    browser.run(click)
    assert sorted(y for trace in marks(browser) for _, y in trace) == [0.002, 0.004, 0.03]
    browser.run(click)
    assert sum(len(trace) for trace in marks(browser)) == 4


def test_a_dragged_line_moves_its_slider(browser):
    plot, moved = "document.querySelector('#chart .plot')", "{'shapes[0].y0': 0.1}"
    browser.run(f"Plotly.relayout({plot}, {moved}).then(() => 1)")
    slider = float(browser.run("document.querySelector('[name=tolerance]').value"))
    assert slider == pytest.approx(-1.0, abs=0.011)  # half a step of the slider
    choose(browser, "tolerance", -2)


def point_at(browser, error):
    """Moves the mouse to the mark with an error, of the error axis; returns label and details."""
    browser.run("document.querySelector('#chart .plot').scrollIntoView({block: 'center'})")
    label = "document.querySelector('#chart .hoverlayer').textContent"
    end = time.monotonic() + PATIENCE
    while not browser.run(label):  # the page may still move under the mouse
        assert time.monotonic() < end
        x, y = browser.run(
            f"""(() => {{
              const plot = document.querySelector("#chart .plot");
              const own = plot.data.filter((t) => t.mode === "markers");
              const trace = own.find((t) => t.y.includes({error}));
              const i = trace.y.indexOf({error}), box = plot.getBoundingClientRect();
              const [h, v] = [plot._fullLayout.xaxis, plot._fullLayout.yaxis];
              return [box.x + h._offset + h.c2p(trace.x[i]), box.y + v._offset + v.c2p(trace.y[i])];
            }})()"""
        )
        for place in (x - 5, x + 1):
            browser._call("Input.dispatchMouseEvent", type="mouseMoved", x=place, y=y)
            browser.run("new Promise((done) => setTimeout(done, 100))")
    return browser.run(label), browser.run("document.querySelector('#chart .details').innerText")


def test_all_details_of_a_mark_appear_beside_the_chart(browser):
    choose(browser, "own", True)
    choose(browser, "double", True)
    label, text = point_at(browser, 0.002)
    for words in ("tl-perturbation", "column", "κ 0.0065 (auto)", "double", "12 elements"):
        assert words in text
    for words in ("max 0.2\u00a0%", "max 8\u00a0%", "per step 1.44 µs", "to equilibrium 500 ms"):
        assert words in text
    for words in (
        "120 ns per element and step, checks 40 ns",
        "mean step 80 µs",
        "100 evaluations",
        "finding",
    ):
        assert words in text
    assert label == "tl-perturbation"  # more would cover other marks
    choose(browser, "own", False)
    choose(browser, "double", False)


def test_an_axis_and_its_definition_are_those_of_the_cost(browser):
    axis = "document.querySelector('#chart .plot').layout.xaxis.title.text"
    for cost in COSTS:
        choose(browser, "cost", cost)
        assert browser.run(axis) == QUANTITIES[cost].name
        meaning = browser.run("document.querySelector('#chart .meaning').textContent")
        assert meaning == QUANTITIES[cost].definition
        costs = {x for trace in marks(browser) for x, _ in trace}
        known = browser.run(POINTS)
        assert costs <= {point[cost] for point in known if cost in point}
    choose(browser, "cost", "simulated")


def test_the_front_is_the_one_that_python_found(browser):
    line = browser.run(
        "(() => { const t = document.querySelector('#chart .plot').data[0]; return [t.x, t.y] })()"
    )
    assert line == [[0.001, 0.002, 0.024], [0.03, 0.004, 0.002]]


def test_the_viewer_turns_with_the_keys_and_changes_colours(browser):
    picture = "document.querySelector('#viewer canvas').toDataURL()"

    def after(action):
        browser.run(f"(async () => {{ {action}; await new Promise((d) => setTimeout(d, 200)) }})()")
        return browser.run(picture)

    key = "document.querySelector('#viewer canvas')"
    key += ".dispatchEvent(new KeyboardEvent('keydown', {key: '%s'}))"
    first = browser.run(picture)
    turned = after(key % "ArrowLeft")
    assert turned != first
    assert after(key % "ArrowRight") == first
    volume = "const s = document.querySelector('#viewer [name=colour]'); s.value = 'volume'; "
    assert after(volume + "s.dispatchEvent(new Event('change', {bubbles: true}))") != first
    assert "volume" in browser.run("document.querySelector('#viewer .words').textContent")


def test_the_ends_of_a_narrow_scale_of_volumes_are_not_1(tmp_path):
    data = DataSet(tmp_path)
    data.records[0] = data.run("tl-none", 1e-3)
    data.write_verdicts()
    data.make()
    found = json.loads(data.page.read_text().partition('id="viewer-data">')[2].partition("</s")[0])
    low, high = found["cases"]["column"]["limits"]["volume"]
    found["cases"]["column"]["limits"]["volume"] = [0.9951, 1.0049]
    text = data.page.read_text().replace(f'"volume":[{low},{high}]', '"volume":[0.9951,1.0049]')
    data.page.write_text(text)
    with Browser() as other:
        other.open(data.page)
        other.until("document.querySelector('#viewer').dataset.drawn")
        choose_colour = "const s = document.querySelector('#viewer [name=colour]'); s.value = "
        choose_colour += "'volume'; s.dispatchEvent(new Event('change', {bubbles: true}))"
        other.run(f"(() => {{ {choose_colour} }})()")
        other.until("document.querySelector('#viewer .high').textContent === '≥ 1.0049'")
        assert other.run("document.querySelector('#viewer .low').textContent") == "≤ 0.9951"


def test_on_a_phone_nothing_is_wider_than_the_screen_and_dark_is_dark(page):
    with Browser(width=390, height=844, phone=True, dark=True) as phone:
        phone.open(page)
        phone.until(DRAWN)
        assert phone.run("document.documentElement.scrollWidth") == 390
        assert phone.run("getComputedStyle(document.body).backgroundColor") == "rgb(18, 22, 27)"
        assert phone.run("document.querySelector('#chart .plot').clientWidth") < 390
        assert phone.complaints == []


def test_without_scripts_the_static_pictures_show(page):
    with Browser(script=False) as plain:
        plain.open(page)
        plain._call("DOM.enable")
        root = plain._call("DOM.getDocument", depth=0)["root"]["nodeId"]

        def height(selector):
            node = plain._call("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
            try:
                return plain._call("DOM.getBoxModel", nodeId=node)["model"]["height"]
            except AssertionError:  # hidden elements have no box
                return 0

        assert height("details.static svg") > 100
        assert height("#chart") == 0 and height(".no-script") > 0


def test_a_method_that_stands_for_the_golden_is_named(tmp_path, browser):
    data = DataSet(tmp_path)
    (tmp_path / "reference" / "golden" / "column.h5").unlink()
    for record in data.records:
        record |= {"golden": None, "finding": None}
    data.write_verdicts()
    rows = [data.row("tl-perturbation", 2e-6, 0.004), data.row("t4", 1e-6, 0.03)]
    data.write("curves/a.json", data.choices(rows, "tl-mean-dilatation"))
    data.make()
    with Browser() as other:
        other.open(data.page)
        other.until(DRAWN)
        text = "document.querySelector('#chart [name=reference]').options[0].textContent"
        assert other.run(text) == "tl-mean-dilatation (no golden)"
        axis = "document.querySelector('#chart .plot').layout.yaxis.title.text"
        assert other.run(axis) == "largest error over all nodes, to tl-mean-dilatation"
        assert browser.run(axis).endswith(", to the golden")


def test_a_link_opens_what_is_folded_below_its_heading(page):
    limits = "document.querySelector('#limits ~ details.fold')"
    with Browser() as fresh:
        fresh.open(page)
        fresh.until(DRAWN)
        assert fresh.run(f"{limits}.open") is False
        fresh.run("document.querySelector('.verdict a').click()")
        fresh.until(f"{limits}.open")


def test_the_chart_begins_on_the_first_screen(page):
    """The question stands above it; the rest of the menu is folded, also after a click."""
    with Browser(width=1280, height=800) as screen:
        screen.open(page)
        screen.until(DRAWN)
        top = "document.querySelector('#chart .plot').getBoundingClientRect().top"
        assert 0 < screen.run(top) < 760
        more = "document.querySelector('nav .more')"
        assert screen.run(f"{more}.open") is False
        screen.run(f"{more}.querySelector('summary').click()")
        assert screen.run(f"{more}.open") is True
        links = f"[...{more}.querySelectorAll('a')].map((a) => a.getBoundingClientRect().right)"
        assert 0 < min(screen.run(links)) and max(screen.run(links)) <= 1280
        screen.run(f"{more}.querySelector('a').click()")
        screen.until(f"!{more}.open")


def test_texts_that_scripts_make_keep_numbers_and_percent_signs_together(browser):
    choose(browser, "tolerance", -2)
    texts = browser.run("document.querySelector('#chart').textContent")
    assert "within 1\u00a0%" in texts and not re.search(r"\d %", texts)


def test_on_paper_there_is_no_menu_and_nothing_is_cut(page):
    """A4 within its margins is 703 px wide; parts that printing opens are closed afterwards."""
    with Browser(width=703) as paper:
        paper.open(page)
        paper.until(DRAWN)
        paper.run("document.querySelector('#runs ~ details.fold').open = true")
        paper._call("Emulation.setEmulatedMedia", media="print")
        paper.run("dispatchEvent(new Event('beforeprint'))")
        opened = "[...document.querySelectorAll('details[open]')].map((d) => d.className)"
        assert sorted(paper.run(opened)) == ["fold", "print", "static print"]
        for selector in ("nav.sections", "#chart", "#viewer", "#shapes"):
            shown = f"getComputedStyle(document.querySelector('{selector}')).display"
            assert paper.run(shown) == "none", selector
        wide = "[...document.querySelectorAll('table, figure, p')].filter((e) => e.offsetParent &&"
        wide += " e.getBoundingClientRect().right > 704).map((e) => e.outerHTML.slice(0, 90))"
        assert paper.run(wide) == []
        colours = "getComputedStyle(document.querySelector('table')).printColorAdjust"
        assert paper.run(colours) == "exact"
        paper.run("dispatchEvent(new Event('afterprint'))")
        assert paper.run(opened) == ["fold"]
