"""The README's figure: one case, five methods, their error to truth and golden, and their cost.

A small document holds its records. Figure and caption are made from it alone, so that a test can
make them again and compare the document with what the program computes now.
"""

import re
import textwrap

from common.errors import InputError
from common.records import NUMBER, entries, entry
from sandglass_report.headline_svg import drawing, shown
from sandglass_report.measured import OWN_MESH
from sandglass_report.points import may_lead
from sandglass_report.style import plain

CASE = "ellipsoid-indentation"
NAME = "speed-accuracy"
COMMAND = "/usr/bin/python3 reports/make_headline.py"
# Method -> its description in the figure: one of each kind that a reader may know.
METHODS = {
    "linear": "one point, small strains",
    "tl-perturbation": "one point, hourglass control",
    "ul-perturbation": "the same, rebuilt in each step",
    "tl-full": "eight points",
    "tl-mean-dilatation": "eight points, the golden’s own",
}
GOLDENS_OWN = "tl-mean-dilatation"
PAPERS = "tl-perturbation"
# The text between these lines of a Markdown file is the figure with its caption.
START, END = "<!-- figure: reports/make_headline.py -->", "<!-- end of the figure -->"
LINE = 138  # letters of a line of the caption
FACTS = ("version", "revision", "processor", "compiler", "build_flags")
# Key of a record -> the corresponding field of a Point of the main chart.
NUMBERS = {
    "golden": lambda point: point.error("golden", "max"),
    "truth": lambda point: point.error("truth", "max"),
    "operations": lambda point: point.operations,
    "ns_per_element_step": lambda point: point.ns,
    "check_ns_per_element_step": lambda p: p.checks and 1e9 * p.checks / p.elements,
    "mean_step_seconds": lambda point: point.mean_step,
    "seconds_per_simulated_second": lambda point: point.simulated,
}


def headline(points, own):
    """The document of the figure; None if a method lacks errors or costs.

    points: of the main chart. own: provenance of the verdicts.
    """
    found = {
        p.method: p
        for p in points
        if p.case == CASE and p.mesh == OWN_MESH and p.precision == "double" and may_lead(p)
    }
    records = [
        {"method": method} | {name: number(found[method]) for name, number in NUMBERS.items()}
        for method in METHODS
        if method in found
    ]
    if len(records) < len(METHODS) or None in (r[name] for r in records for name in NUMBERS):
        return None
    return {
        "case": CASE,
        "elements": found[PAPERS].elements,
        **{name: own[name] for name in FACTS if name in own},
        "methods": records,
    }


def require_valid(path, document):
    """Raises InputError if a document lacks something that the figure needs. path: for messages."""
    for key, kind in (("case", str), ("elements", int)):
        entry(path, document, key, kind)
    for where, record in entries(path, document, "methods"):
        entry(where, record, "method", str)
        for key in NUMBERS:
            entry(where, record, key, NUMBER)


def figure(document):
    """The figure as the text of an SVG file."""
    rows = [(METHODS[record["method"]], record) for record in document["methods"]]
    return drawing(document, rows)


def caption(document, drawn, glossary):
    """The figure with its caption, in Markdown. drawn, glossary: paths from the text's folder."""
    at = {record["method"]: record for record in document["methods"]}
    ours, golden = at[PAPERS], at[GOLDENS_OWN]
    seconds = "seconds_per_simulated_second"
    words = (
        f"One core, {document.get('processor', 'unknown processor')}, version "
        f"{document.get('version', 'unknown')}. Errors are the largest of all nodes, in % of the "
        "imposed displacement. The *truth* is an answer on much finer meshes; the *golden* is the "
        "answer of the simplest element that does not lock, on the same mesh. "
        "`tl-mean-dilatation` is this element, so its 0 % proves nothing: its error to the truth "
        f"is {shown(golden['truth'])}. `tl-perturbation` is {shown(ours['truth'])} from the truth, "
        f"and takes {plain(ours[seconds], 2)} s per simulated second instead of "
        f"{plain(golden[seconds], 2)} s: one core moves about "
        f"{in_real_time(document['elements'], ours[seconds])} elements of this size in real "
        f"time. `tl-full` locks ({shown(at['tl-full']['truth'])}), and "
        f"small strains do not suffice here ({shown(at['linear']['truth'])}). `bash ci/verify` "
        f"makes the figure in `build/report/figures/`, `{COMMAND}` makes this text; the "
        f"[glossary]({glossary}) explains its words."
    )
    whole = re.sub(
        "`[^`]+`", lambda code: code[0].replace(" ", "\0"), words
    )  # commands do not break
    wrapped = textwrap.fill(whole, LINE, break_on_hyphens=False, break_long_words=False)
    wrapped = wrapped.replace("\0", " ")
    return f"![{in_words(document)}]({drawn})\n\n{wrapped}\n"


def in_real_time(elements, seconds):
    """The number of elements that run in real time, as text with two digits.

    elements: a number whose simulated second takes `seconds` of wall time. Steps depend on the size
    of elements, not on their number, so the time is proportional to the number.
    """
    return f"{float(f'{elements / seconds:.2g}'):,.0f}"


def in_words(document):
    """The figure as one sentence, for readers who cannot see it."""
    parts = (
        f"{r['method']} {shown(r['truth'])}, {shown(r['golden'])}, "
        f"{plain(r['seconds_per_simulated_second'], 2)} s"
        for r in document["methods"]
    )
    return (
        "Error to the truth, error to the golden and wall time per simulated second: "
        + "; ".join(parts)
    )


def replaced(text, block):
    """A Markdown text with a new figure between its two marks. Raises InputError without them."""
    before, start, rest = text.partition(START)
    _, end, after = rest.partition(END)
    if not start or not end:
        raise InputError(f"the text has no lines {START!r} and {END!r} for the figure")
    return f"{before}{START}\n{block}{END}{after}"
