"""The distance between goldens and truths, and the goldens of motion: the tables in README.md.

Usage: /usr/bin/python3 reference/compare.py [--update]
Exit codes: 0 done, 2 damaged or contradictory files.
"""

import math
import sys
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.accuracy import relative_errors
from common.command import command_line, option
from common.errors import InputError
from common.files import write_whole
from reference_file import FOLDER, MOTION, path_of, read_reference, stored, write_reference


# The largest share of a golden's distance from a truth that the truth's own error should have.
LARGEST_SHARE = 0.2


def golden_error(golden_path, truth_path):
    """Distance of a golden from the truth of the same case and mesh: (max, rms), fractions.

    Raises InputError if the two do not belong together.
    """
    points, displacement, golden = read_reference(golden_path)
    truth_points, truth_displacement, truth = read_reference(truth_path)
    for name in ("case", "case_hash", "mesh_hash"):
        if golden[name] != truth[name]:
            raise InputError(
                f"{truth_path}: attribute {name} = {truth[name]!r}, but {golden[name]!r} in "
                f"{golden_path}: both must come from the same case and mesh; run "
                f"reference/regenerate {golden['case']}"
            )
    # Both contain the coordinates of the mesh file; 1e-12 of the size covers other rounding.
    if points.shape != truth_points.shape or not np.allclose(
        points, truth_points, rtol=0, atol=1e-12 * np.ptp(points)
    ):
        raise InputError(f"{truth_path}: its nodes differ from those of {golden_path}")
    return relative_errors(displacement, truth_displacement, golden["largest_imposed"])


def fill_golden_error(golden_path, truth_path):
    """Store the distance from the truth in the golden's attributes. Raises InputError."""
    errors = golden_error(golden_path, truth_path)
    points, displacement, attributes = read_reference(golden_path)
    attributes["discretisation_error_max"], attributes["discretisation_error_rms"] = errors
    attributes["discretisation_error_note"] = "distance from the truth of the same case"
    write_reference(golden_path, points, displacement, attributes)


def table():
    """The Markdown table that compares all stored goldens with their truths, as a string."""
    lines = [
        "| case | golden to truth, max | rms | golden's own error, max | rms | order "
        "| truth's edges split | truth's own error, max | rms | order | golden, s | truth, s |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name in stored("golden"):
        golden_path, truth_path = path_of("golden", name), path_of("truth", name)
        _, _, golden = read_reference(golden_path)
        seconds = f"{golden['wall_seconds']:.0f}"
        if truth_path.exists():
            _, _, truth = read_reference(truth_path)
            errors = golden_error(golden_path, truth_path)
            cells = [_percent(error) for error in errors] + _own_error(golden)
            cells.append(f"{truth['refinements']}x")
            cells += _own_error(truth, errors) + [seconds, f"{truth['wall_seconds']:.0f}"]
        else:
            cells = ["-", "-"] + _own_error(golden) + ["-"] * 4 + [seconds, "-"]
        cells.insert(0, golden["case"])
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def motion_table():
    """The Markdown table of all stored goldens of motion, as a string."""
    lines = [
        "| case | nodes | simulated, s | steps | changed by halving, max | rms | computed in, s |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in stored(MOTION):
        points, _, golden = read_reference(path_of(MOTION, name))
        halving = [f"{golden[key]:.1e}" for key in ("halving_max", "halving_rms")]
        cells = [name, len(points), f"{golden['times'][-1]:g}", golden["load_steps"], *halving]
        lines.append("| " + " | ".join(map(str, cells)) + f" | {golden['wall_seconds']:.0f} |")
    return "\n".join(lines)


def update_readme():
    """Write the current tables between their marks in README.md. Raises InputError."""
    readme = FOLDER / "README.md"
    text = readme.read_text(encoding="utf-8")
    for mark, made in (("table", table()), ("motion", motion_table())):
        marks = f"<!-- {mark}: begin -->", f"<!-- {mark}: end -->"
        before, begin, rest = text.partition(marks[0])
        _, end, after = rest.partition(marks[1])
        if not end:
            raise InputError(f"{readme}: the marks {' and '.join(marks)} are missing")
        text = f"{before}{begin}\n{made}\n{end}{after}"
    write_whole(readme, text)


def _own_error(attributes, judged=(math.inf, math.inf)):
    """Table cells of a result's distance from the limit of refinement: max, rms, order.

    judged: max and rms of the distances that a truth judges; more than a share of them is marked,
    and so are bars without a part for the inside.
    """
    order = attributes["own_error_order"]
    if math.isnan(order):
        return [_percent(math.nan)] * 2 + ["-"]
    note = attributes["own_error_note"]
    mark = "" if note.endswith(": measured") else " (*)"
    alone = " (e)" if note.startswith("edges alone") else ""
    cells = [
        _percent(attributes[f"own_error_{which}"])
        + alone
        + (" (!)" if attributes[f"own_error_{which}"] > LARGEST_SHARE * distance else "")
        for which, distance in zip(("max", "rms"), judged)
    ]
    return cells + [f"{order:.2f}{mark}"]


def _percent(fraction):
    """A fraction as a percentage with three digits."""
    return "not estimated" if math.isnan(fraction) else f"{100 * fraction:.3g} %"


def run(options):
    """Prints the tables and, with --update, writes them into README.md. Raises InputError."""
    print(table(), motion_table(), sep="\n\n")
    if options.update:
        update_readme()


main = command_line(
    run,
    __doc__,
    option("--update", action="store_true", help="write the tables into README.md"),
)


if __name__ == "__main__":
    sys.exit(main())
