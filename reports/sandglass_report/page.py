"""The page: what the template needs, and how it and the figures are written."""

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

import jinja2
import markupsafe

from sandglass_report import bodies, kappa, lines, paper, plates, speed, style, tips
from sandglass_report.errors import ReportError

TEMPLATES = Path(__file__).parent / "templates"
PROVENANCE_NAMES = {
    "processor": "Processor",
    "compiler": "Compiler",
    "build_flags": "Build",
    "version": "Version",
    "revision": "Revision",
}


@dataclass(frozen=True)
class PaperSection:
    """One experiment of the paper: our plates and our figures beside its figure."""

    experiment: paper.Experiment
    subject: object  # Subject, or None when the case was not run
    shapes: plates.Plate | None
    line: plates.Plate | None
    auto: object  # Run at kappa auto, or None
    best: object  # Run of the kappa curve with the smallest error on the line, or None


def write_report(verdicts, subjects, page):
    """Writes the page, and its static figures to the folder figures/ beside it.

    page: path of the HTML file. The page is written whole or not at all. Returns its size in bytes.
    Raises ReportError when a file cannot be written.
    """
    palette = style.Palette(verdicts.methods)
    sections = tuple(_paper_section(e, subjects, palette) for e in paper.EXPERIMENTS)
    html = render(verdicts, subjects, palette, sections)
    try:
        folder = page.parent / "figures"
        folder.mkdir(parents=True, exist_ok=True)
        for plate in _static_plates(verdicts, subjects, palette, sections):
            plates.save_plate(plate, folder)
        _write_whole(page, html)
    except OSError as error:
        raise ReportError(
            f"{error.filename or page}: cannot write the report: {error.strerror}"
        ) from error
    return len(html.encode())


def render(verdicts, subjects, palette, sections):
    """The page as one string of HTML that loads nothing."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "percent": style.percent,
        "exact_percent": style.exact_percent,
        "svg": lambda panel: markupsafe.Markup(plates.inline_svg(panel)),
        "figure_name": lambda name: style.FIGURE_NAMES.get(name, name),
        "scientific": _scientific,
        "significant": style.plain,
    }
    costs = speed.cost_limits(verdicts.runs)
    return environment.get_template("page.html.j2").render(
        provenance=[
            (PROVENANCE_NAMES.get(name, name), value) for name, value in verdicts.provenance.items()
        ],
        limits=sorted(verdicts.limits, key=lambda limit: limit.holds),
        runs=verdicts.runs,
        failed=[run for run in verdicts.runs if not run.ok],
        broken=[limit for limit in verdicts.limits if not limit.holds],
        subjects=subjects,
        by_name={subject.name: subject for subject in subjects},
        palette=palette,
        colours=style.THEMED,
        gallery={subject.name: bodies.gallery_panel(subject) for subject in subjects},
        speed={s.name: speed.speed_panels(s, palette, costs) for s in subjects},
        kappa={s.name: kappa.kappa_panels(s, palette) for s in subjects},
        sections=sections,
        tip_tables=tips.tip_tables(verdicts.tips),
        paper_method=paper.METHOD,
        line_methods=paper.LINE_METHODS,
    )


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


def _static_plates(verdicts, subjects, palette, sections):
    """All figures that are also saved as files."""
    costs = speed.cost_limits(verdicts.runs)
    found = [speed.speed_plate(subjects, palette, costs)]
    found += kappa.kappa_plates(subjects, palette)
    for section in sections:
        found += [plate for plate in (section.shapes, section.line) if plate is not None]
    gallery = tuple(p for p in (bodies.gallery_panel(s) for s in subjects) if p is not None)
    if gallery:
        found.append(
            plates.Plate("cases", "The cases, at rest and deformed", gallery, len(gallery))
        )
    return found


def _write_whole(path, text):
    """Writes to a temporary file beside the path and renames it."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with open(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def _scientific(value):
    """A number like 1.2·10⁻⁸."""
    if not value:
        return "0"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}·10{style.superscript(int(exponent))}"
