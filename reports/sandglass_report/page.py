"""The page: collects the data of the templates, and writes the page and its figures."""

import base64
import functools
import re
from dataclasses import dataclass, field
from pathlib import Path

import jinja2
import markupsafe

from common.files import write_json, write_whole, writing
from sandglass_report import bending, bodies, contact, experiment, findings, headline, identified
from sandglass_report import interactive, kappa, lines, maps
from sandglass_report import measured, paper, plates, provenance, published, replication, speed
from sandglass_report import style, tips, viewer
from sandglass_report.plausible import require_plausible
from sandglass_report.points import make_points
from sandglass_report.quantities import COSTS, FIGURES, QUANTITIES, RUN_NUMBERS

TEMPLATES = Path(__file__).parent / "templates"

# A claim's name for a section -> the id of the section's heading.
OWN_NAMES = (
    "paper shapes bending experiment published programs refinement contact growth maps kappa "
    "golden limits runs"
)
ANCHORS = {"chart": "chart-head"} | {name: name for name in OWN_NAMES.split()}


@dataclass(frozen=True)
class Inputs:
    """All data of the page."""

    verdicts: object  # Verdicts
    verdicts_path: Path
    subjects: tuple
    measured: object  # Measured
    evidence: object  # Evidence
    pictures: tuple = ()  # paths of failure maps as PNG, for maps that were not recomputed
    growth: plates.Plate | None = None
    refinement: plates.Plate | None = None
    identified: tuple = ()  # records of identified stiffnesses
    contact: tuple = ()  # records of the cost of contact
    second: dict = field(default_factory=dict)  # kind -> SecondProgram
    submissions: tuple = ()

    @property
    def elements(self):
        """Case -> number of elements of its mesh, None without one."""
        return {s.name: None if s.cells is None else len(s.cells) for s in self.subjects}

    @functools.cached_property
    def _checked(self):
        own = self.verdicts.provenance
        points = make_points(self.verdicts.runs, self.elements, self.measured, own)
        loaded = frozenset(run.case for run in self.verdicts.runs if run.load_in_steps)
        return tuple(points), require_plausible(points, self.measured, own, loaded)

    @property
    def points(self):
        """The points of the main chart. Raises InputError if one cannot be true."""
        return self._checked[0]

    @property
    def disturbed(self):
        """The points that were measured while the machine was busy."""
        return self._checked[1]


@dataclass(frozen=True)
class PaperSection:
    """One experiment of the paper: our plates and figures, to compare with its figures."""

    experiment: paper.Experiment
    subject: object  # Subject, or None when the case was not run
    shapes: plates.Plate | None
    line: plates.Plate | None
    auto: object  # Run at kappa auto, or None
    best: object  # Run of the kappa curve with the smallest error on the line, or None


def with_hard_spaces(html):
    """HTML in whose text no line ends between a number and its %. Scripts and tags stay."""
    parts = re.split(r"(<(script|style)\b.*?</\2>|<[^>]*>)", html, flags=re.DOTALL)
    # Groups of three: text, markup between texts, the name of a script or style.
    parts[::3] = [re.sub(r"(?<=\d) %", "\u00a0%", text) for text in parts[::3]]
    del parts[2::3]
    return "".join(parts)


def write_report(inputs, page):
    """Writes the page, and the README's figure to the folder figures/ next to it.

    page: path of the HTML file, which is written completely or not at all. Returns its size in
    bytes. Raises InputError if a file cannot be written.
    """
    palette = style.Palette(inputs.verdicts.methods)
    sections = tuple(_paper_section(e, inputs.subjects, palette) for e in paper.EXPERIMENTS)
    bent = bending.bending_plates(inputs.verdicts.tips, palette)
    others = published.benchmarks(inputs.verdicts.tips, palette)
    html = with_hard_spaces(
        _environment()
        .get_template("page.html.j2")
        .render(
            **_of_verdicts(inputs, palette),
            **_of_measured(inputs, palette),
            sections=sections,
            bending=bent,
            published=others,
            growth=inputs.growth,
            refinement=inputs.refinement,
            experiment=experiment.experiment_plate(inputs.verdicts.tips, palette),
            identified=inputs.identified
            and identified.identified_plate(inputs.identified, palette),
            contact=inputs.contact and contact.contact_plate(inputs.contact, palette),
            second=inputs.second,
            submissions=inputs.submissions,
            evidence=inputs.evidence,
            anchors=ANCHORS,
        )
    )
    folder = page.parent / "figures"
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        shown = headline.headline(inputs.points, inputs.verdicts.provenance)
        if shown is not None:
            write_json(folder / f"{headline.NAME}.json", shown)
            write_whole(folder / f"{headline.NAME}.svg", headline.figure(shown))
    write_whole(page, html)
    return len(html.encode())


def _environment():
    """The templates' environment with their filters."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.policies["json.dumps_kwargs"] = {"separators": (",", ":"), "sort_keys": False}
    environment.filters |= {
        "percent": style.percent,
        "exact_percent": style.exact_percent,
        "svg": lambda panel: markupsafe.Markup(plates.inline_svg(panel)),
        "figure_name": lambda name: style.FIGURE_NAMES.get(name, name),
        "scientific": style.power,
        "shown": lambda value, name: QUANTITIES[name].shown(value),
        "significant": style.plain,
    }
    return environment


def _of_verdicts(inputs, palette):
    """The templates' data about runs, cases and limits."""
    verdicts, subjects = inputs.verdicts, inputs.subjects
    return {
        "provenance": provenance.program(verdicts),
        "origins": provenance.origins(subjects),
        "limits": sorted(verdicts.limits, key=lambda limit: limit.holds),
        "runs": verdicts.runs,
        "failed": [run for run in verdicts.runs if not run.ok],
        "failures": findings.failures(verdicts),
        "captions": {s.name: findings.caption(s, paper.METHOD, verdicts.limits) for s in subjects},
        "sound": published.SOUND,
        "broken": [limit for limit in verdicts.limits if not limit.holds],
        "subjects": subjects,
        "palette": palette,
        "colours": style.THEMED,
        "gallery": {subject.name: bodies.gallery_panel(subject) for subject in subjects},
        "speed": {s.name: speed.speed_panels(s, palette) for s in subjects},
        "kappa": {s.name: kappa.kappa_panels(s, palette) for s in subjects},
        "kappa_methods": dict.fromkeys(run.method for run in verdicts.runs if not run.is_main),
        "tip_tables": tips.tip_tables(verdicts.tips),
        "force_tables": tips.tip_tables(verdicts.tips, of="force"),
        "viewer": viewer.viewer_data(subjects),
        "paper_method": paper.METHOD,
        "paper_figures": paper.FIGURES,
        "line_methods": paper.LINE_METHODS,
    }


def _of_measured(inputs, palette):
    """The templates' data about the main chart and the files of other commands."""
    found, names = inputs.measured, [subject.name for subject in inputs.subjects]
    elements = inputs.elements
    own, points = inputs.verdicts.provenance, inputs.points
    others = [s for s in inputs.submissions if elements.get(s.entry["case"])]
    programs = dict.fromkeys(s.entry["program"] for s in others)
    curves = [name for name in names if any(c.case == name for c in found.candidates)]
    map_texts = maps.map_texts(sorted(found.maps, key=lambda m: m["case"] != paper.FIRST_CASE))
    pictures = [p for p in inputs.pictures if p.stem not in {m.name for m in map_texts}]
    return {
        "chart": interactive.chart_data(
            [p for p in points if palette.knows(p.method)],
            palette,
            [s.as_point(elements[s.entry["case"]], own) for s in others],
        ),
        "chart_programs": {
            program: "; ".join(
                dict.fromkeys(s.elsewhere(own) for s in others if s.entry["program"] == program)
            )
            for program in programs
        },
        "chart_elsewhere": sorted({s.elsewhere(own) for s in others} - {""}),
        "chart_disturbed": sorted({f"{p.method} ({p.case})" for p in inputs.disturbed}),
        "quantity": QUANTITIES,
        "costs": COSTS,
        "figures": FIGURES,
        "run_numbers": RUN_NUMBERS,
        "chart_cases": names,
        "first_case": paper.FIRST_CASE if paper.FIRST_CASE in names else names[0],
        "curve_cases": curves,
        "missing_curves": [name for name in names if name not in curves],
        "plotly": interactive.packed_plotly(),
        "table_1": replication.table_1(found.counts),
        "table_2": replication.table_2(points),
        "flops_command": measured.FLOPS,
        "maps": map_texts,
        "outcomes": maps.OUTCOMES,
        "maps_command": measured.MAPS,
        "map_pictures": [(p.stem.removeprefix("stability."), _base64(p)) for p in pictures],
        "sources": provenance.sources(inputs.verdicts, inputs.verdicts_path, found),
        "other_revision": lambda s: provenance.of_another_revision(s, inputs.verdicts),
    }


def _base64(path):
    return base64.b64encode(path.read_bytes()).decode("ascii")


def _paper_section(experiment, subjects, palette):
    subject = next((s for s in subjects if s.name == experiment.case), None)
    if subject is None:
        return PaperSection(experiment, None, None, None, None, None)
    curve = [
        run
        for run in subject.runs
        if run.method == paper.METHOD and run.ok and run.golden and run.golden.profile is not None
    ]
    return PaperSection(
        experiment,
        subject,
        bodies.shape_plate(subject, experiment, palette),
        lines.line_plate(subject, experiment, palette),
        auto=next((run for run in curve if run.kappa_is_auto), None),
        best=min(curve, key=lambda run: run.golden.profile, default=None),
    )
