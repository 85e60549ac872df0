"""Reports of a comparison: a table, a JUnit file, a Markdown file, and the trend of times."""

import csv
import io
import xml.etree.ElementTree as ElementTree
from collections import Counter
from itertools import groupby
from pathlib import Path

from common.files import write_whole

from .compare import BETTER, BROKEN, FAILING, NEW, NOISY, SAME, UNGATED, VANISHED, WORSE

VERDICTS = (WORSE, BROKEN, VANISHED, NOISY, NEW, UNGATED, BETTER, SAME)
HEADINGS = ("verdict", "area", "what", "figure", "baseline", "found", "")
SILENT = (SAME, UNGATED)  # counted, not listed


def _shown(value):
    """A figure as text."""
    if value is None:
        return "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _cells(outcome):
    """A row of the table."""
    o = outcome
    return (o.verdict, o.area, o.name, o.figure, _shown(o.baseline), _shown(o.found), o.reason)


def _listed(outcomes, most):
    """The rows to list, worst first, with a maximum per verdict; and the number left out."""
    rows, left_out = [], Counter()
    for verdict in VERDICTS:
        of_verdict = [o for o in outcomes if o.verdict == verdict and verdict not in SILENT]
        shown = most if verdict in FAILING else most // 4
        rows += [_cells(outcome) for outcome in of_verdict[:shown]]
        left_out[verdict] = max(0, len(of_verdict) - shown)
    return rows, [f"{count} more: {verdict}" for verdict, count in left_out.items() if count]


def _counts(outcomes):
    """The number of figures per area and verdict: a heading and rows."""
    counts = Counter((outcome.area, outcome.verdict) for outcome in outcomes)
    areas = list(dict.fromkeys(outcome.area for outcome in outcomes))
    there = [verdict for verdict in VERDICTS if any(counts[area, verdict] for area in areas)]
    rows = [(area, *(str(counts[area, verdict]) for verdict in there)) for area in areas]
    return ("area", *there), sorted(rows)


def _aligned(rows):
    """Rows of text in columns."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows
    )


def verdict_line(outcomes):
    """The last line: the overall outcome."""
    failing = sum(outcome.fails for outcome in outcomes)
    counts = Counter(outcome.verdict for outcome in outcomes)
    parts = [f"{len(outcomes)} figures", f"{failing} regressions"]
    parts += [
        f"{counts[verdict]} {verdict}"
        for verdict in (NOISY, NEW, UNGATED, BETTER)
        if counts[verdict]
    ]
    return f"gate: {'FAILED' if failing else 'passed'}: {', '.join(parts)}"


def table(outcomes):
    """The table for a terminal: every figure that is not the same, then counts by area."""
    rows, left_out = _listed(outcomes, most=40)
    parts = [_aligned([HEADINGS, *rows])] if rows else []
    parts += left_out
    heading, counts = _counts(outcomes)
    return "\n".join([*parts, "", _aligned([heading, *counts]), verdict_line(outcomes)]).strip("\n")


def _markdown_table(rows):
    """A Markdown table; bars in cells are escaped."""
    rows = [[cell.replace("|", "\\|") for cell in row] for row in rows]
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    return "\n".join(lines)


def _times(run):
    """Names of the timed variants, and their best ns per element and step."""
    timed = [record for record in run.records if "trend ns" in record.figures]
    return {record.name: record.figures["trend ns"] for record in timed}


def _trend(baseline, run):
    """Rows of times, which are not compared: variant, ns of the baseline, ns found."""
    before = baseline.of("speed", run.machine)
    return [
        (name, f"{before[name]['trend ns']:.2f}" if name in before else "-", f"{ns:.2f}")
        for name, ns in _times(run).items()
    ]


def markdown(outcomes, baseline, run):
    """The Markdown text: the table, counts, and times as a trend."""
    rows, left_out = _listed(outcomes, most=200)
    heading, counts = _counts(outcomes)
    parts = [
        f"# {verdict_line(outcomes)}",
        f"Revision {run.revision or '-'}; machine: {run.machine or '-'}.",
    ]
    parts += [_markdown_table([heading, *counts])]
    parts += [_markdown_table([HEADINGS, *rows])] if rows else []
    parts += left_out
    trend = _trend(baseline, run)
    if trend:
        parts += [
            "## Times\n\nBest ns per element and step: a trend, not judged.",
            _markdown_table([("variant", "baseline", "found"), *trend]),
        ]
    return "\n\n".join(parts) + "\n"


def junit(outcomes, run):
    """The JUnit text: a suite for each area, a case for each record."""
    root = ElementTree.Element("testsuites", name="gate")
    for area, of_area in groupby(
        sorted(outcomes, key=lambda o: (o.area, o.name)), key=lambda o: o.area
    ):
        suite = ElementTree.SubElement(root, "testsuite", name=area)
        tally = Counter()
        for name, of_record in groupby(of_area, key=lambda o: o.name):
            tally[_junit_case(suite, area, name, list(of_record))] += 1
        suite.set("tests", str(tally.total()))
        suite.set("errors", "0")
        for key in ("failures", "skipped"):
            suite.set(key, str(tally[key]))
        properties = ElementTree.Element("properties")
        for key, value in (("revision", run.revision or "-"), ("machine", run.machine or "-")):
            ElementTree.SubElement(properties, "property", name=key, value=value)
        suite.insert(0, properties)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _junit_case(suite, area, name, outcomes):
    """Adds a case; returns what it counts as."""
    case = ElementTree.SubElement(suite, "testcase", classname=f"gate.{area}", name=name)

    def told(verdicts):
        chosen = [o for o in outcomes if o.verdict in verdicts]
        return "\n".join(
            f"{o.figure}: {o.verdict}: {_shown(o.baseline)} -> {_shown(o.found)}: {o.reason}"
            for o in chosen
        )

    for tag, counted, verdicts in (
        ("failure", "failures", FAILING),
        ("skipped", "skipped", (NOISY, NEW, UNGATED)),
        ("system-out", "passed", (BETTER,)),
    ):
        text = told(verdicts)
        if text:
            element = ElementTree.SubElement(case, tag)
            if tag != "system-out":
                element.set("message", text.splitlines()[0])
            element.text = text
            return counted
    return "passed"


def append_trend(path, run, date):
    """Adds the times of a run to a CSV file."""
    rows = [
        (date, run.revision, run.machine, name, f"{ns:.4g}") for name, ns in _times(run).items()
    ]
    if not rows:
        return
    path = Path(path)
    text = io.StringIO()
    if not path.exists():
        csv.writer(text, lineterminator="\n").writerow(
            ("date", "revision", "machine", "variant", "ns")
        )
    csv.writer(text, lineterminator="\n").writerows(rows)
    write_whole(path, (path.read_text(encoding="utf-8") if path.exists() else "") + text.getvalue())


def write_all(folder, outcomes, baseline, run, date):
    """Writes gate.md, gate.xml and trend.csv into a folder."""
    write_whole(folder / "gate.md", markdown(outcomes, baseline, run))
    write_whole(folder / "gate.xml", junit(outcomes, run))
    append_trend(folder / "trend.csv", run, date)
