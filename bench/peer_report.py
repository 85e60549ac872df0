"""The report of bench/peers.py in Markdown: measurements, machine and notes."""

import statistics

from measuring import table
from rest_search import WITHIN

# The explicit method of the golden's element, the reference for motions.
MEAN_DILATATION = "tl-mean-dilatation"
NOTES_AT_REST = """
The same answer by different methods. CalculiX, FEBio and FEniCSx use Newton's method with a direct
solver, Sandglass its search for rest, all until their residuals are below 1e-8. Programs that only
integrate in time find it by a damped motion. Its step, duration and damping were searched for
beforehand: it is the quickest whose end differs by less than {within:g} of the imposed displacement
from that of a long one. The search is not part of the seconds. Seconds and errors of any two rows
are comparable, times per step are not.
seconds: wall time of the whole process; of OpenRadioss, of its engine; of FEniCSx, of the solution
without set-up and compilation. CPU: processor time. max to
golden, to truth: largest error at any node over the largest imposed displacement, by `sandglass
score`, or, without a golden, tl-mean-dilatation.
"""
NOTES_IN_MOTION = """
The same motion by the same method: central differences with lumped masses and the same step,
{step:.3g} s, or a shorter one if the program considers that unstable; {share:.3g} of the case's
displacements, imposed in {steps} steps. The comparable figure is the time per element and step: the
additional processor time of a longer run over its additional steps, so start-up does not count.
There is no golden for a motion. to {element}: largest difference from its final displacement over
the imposed one. nearest: the method of Sandglass with the most similar motion; C3D8 and tl-full are
the same element and must agree. A motion that is far from all others is not sound.
"""


def percent(fraction):
    """A fraction as text."""
    return f"{100 * fraction:.3g} %"


def spread(seconds):
    """Median and range of a list of seconds as text."""
    return f"{statistics.median(seconds):.3g} ({min(seconds):.3g} to {max(seconds):.3g})"


SHARED = (
    ("program", "program", str),
    ("build", "build", str),
    ("element", "element", str),
    ("numbers", "precision", str),
    ("solve", "solve", str),
    ("seconds (range)", "seconds_of_runs", spread),
    ("CPU, s (range)", "processor_seconds_of_runs", spread),
    ("steps", "steps", str),
)
STATIC_COLUMNS = (
    *SHARED,
    ("load steps", "load_steps", str),
    ("evaluations", "evaluations", str),
    ("iterations", "iterations", str),
    ("step, ms", "time_step", lambda seconds: f"{1e3 * seconds:.3g}"),
    ("ms a step", "seconds_per_step", lambda seconds: f"{1e3 * seconds:.3g}"),
    ("max to golden", "golden", percent),
    ("max to truth", "truth", percent),
    (f"max to {MEAN_DILATATION}", "twin", percent),
    ("failed", "failure", str),
)
MOTION_COLUMNS = (
    *SHARED,
    ("step, ms", "time_step", lambda seconds: f"{1e3 * seconds:.3g}"),
    ("us a step", "seconds_per_step", lambda seconds: f"{1e6 * seconds:.3g}"),
    ("ns per element and step (range)", "ns_of_rounds", spread),
    (f"to {MEAN_DILATATION}", "to_mean_dilatation", percent),
    ("nearest", "nearest", lambda found: f"{found['method']}, {percent(found['difference'])}"),
    ("failed", "failure", str),
)


def shown(records, columns):
    """A Markdown table of the non-empty columns."""
    known = [
        column for column in columns if any(record[column[1]] is not None for record in records)
    ]
    return table(records, known)


def report(document, steps):
    """The text. document: from `ci/peers --json`. steps: of the motion."""
    loads = "{load_average_before:.2f} to {load_average_after:.2f}".format(**document)
    programs = [f"sandglass {document['sandglass']}"]
    programs += ["{name} {build} {version} {about}".format(**p) for p in document["programs"]]
    lines = [
        "{case}: {nodes} nodes, {elements} elements".format(**document),
        f"on {document['processor']}, {document['cores']} cores, load {loads}; every run on one "
        f"thread of processor {document['processor_of_all_runs']}, in turn, "
        f"medians of {document['repetitions']}",
        *(" ".join(text.split()) for text in programs),
    ]
    if document["static"]:
        lines += ["", "## Static equilibrium", "", shown(document["static"], STATIC_COLUMNS)]
        lines.append(NOTES_AT_REST.format(within=WITHIN))
    if document["in_motion"]:
        share, step = document["share_of_displacements"], document["time_step"]
        notes = NOTES_IN_MOTION.format(steps=steps, step=step, share=share, element=MEAN_DILATATION)
        lines += ["", "## In motion", "", shown(document["in_motion"], MOTION_COLUMNS), notes]
    return "\n".join(lines).strip()
