"""CalculiX and Sandglass on the same mesh, in turn, on one thread each: seconds and errors.

Usage: /usr/bin/python3 bench/peers.py [CASE] [--json FILE] [--markdown FILE]
Needs CalculiX (ci/setup bench) and the solver's binary: build/release/sandglass, or the one given
by SANDGLASS_BINARY.
Exit codes: 0 done, 2 bad usage or input, 3 a computation failed (the others are still shown).
"""

import argparse
import os
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import time_to_rest  # first: reference/ may do without UFL afterwards

import calculix
import peer_runs
from common.accuracy import relative_errors
from common.command import exit_code, whole_number
from common.errors import ComputationError, InputError
from common.files import require_writable, write_json, write_whole
from rest_records import table

ELEMENTS = ("C3D8", "C3D8R", "C3D8I")
METHODS = ("tl-perturbation", "tl-four-point", "tl-mean-dilatation", "tl-full")
AT_REST = (*METHODS, "tl-energy-sampling")
IN_MOTION = (*METHODS, "ul-perturbation")
# The golden element's explicit twin, the reference for motions.
TWIN = "tl-mean-dilatation"
NEWTON, RELAXATION, EXPLICIT = "Newton", "relaxation", "central differences"

NOTES_AT_REST = """
The same answer by different methods: CalculiX uses *STATIC, NLGEOM, Newton's method with a direct
solver, Sandglass uses dynamic relaxation, both until their residuals are below 1e-8. Seconds and
errors of any two rows are comparable, times per step are not: a step of CalculiX is an increment of
several iterations, one of Sandglass an evaluation of the forces.
seconds: wall time of the whole process. CPU: its processor time. max to golden, to truth: largest
error at any node over the largest imposed displacement, by `sandglass score`; to twin: for a case
without a golden, to tl-mean-dilatation.
"""
NOTES_IN_MOTION = """
The same motion by the same method: central differences with lumped masses and the same step,
{step:.3g} s, or a shorter one if CalculiX considers that unstable; {share:.3g} of the case's
displacements, imposed in {steps} steps. The comparable figure is the time per element and step: the
additional processor time of a longer run over its additional steps, so start-up does not count.
There is no golden for a motion. to {twin}: largest difference from its final displacement over the
imposed one. nearest: the method of Sandglass with the most similar motion; C3D8 and tl-full are the
same element and must agree. A motion that is far from all others is not sound.
"""


def percent(fraction):
    """A fraction as text."""
    return f"{100 * fraction:.3g} %"


def spread(seconds):
    """Median and range of a list of seconds, as text."""
    return f"{statistics.median(seconds):.3g} ({min(seconds):.3g} to {max(seconds):.3g})"


SHARED = (
    ("program", "program", str),
    ("element", "element", str),
    ("solve", "solve", str),
    ("seconds (range)", "seconds_of_runs", spread),
    ("CPU, s (range)", "processor_seconds_of_runs", spread),
    ("steps", "steps", str),
)
COLUMNS_AT_REST = (
    *SHARED,
    ("iterations", "iterations", str),
    ("ms a step", "seconds_per_step", lambda seconds: f"{1e3 * seconds:.3g}"),
    ("max to golden", "golden", percent),
    ("max to truth", "truth", percent),
    ("max to twin", "twin", percent),
    ("failed", "failure", str),
)
COLUMNS_IN_MOTION = (
    *SHARED,
    ("us a step", "seconds_per_step", lambda seconds: f"{1e6 * seconds:.3g}"),
    ("ns per element and step (range)", "ns_of_rounds", spread),
    (f"to {TWIN}", "to_twin", percent),
    ("nearest", "nearest", lambda found: f"{found['method']}, {percent(found['difference'])}"),
    ("failed", "failure", str),
)


class Row:
    """A program with an element, and its timed runs.

    runs: name -> function that returns a Run; timed in this order in every round.
    """

    def __init__(self, program, element, solve, runs):
        self.program, self.element, self.solve, self.runs = program, element, solve, runs
        self.clocked = {name: [] for name in runs}
        self.failure = None

    def round(self):
        """Time every run once more; a row that failed is skipped."""
        if self.failure:
            return
        print(f"{self.program} {self.element}, {self.solve}", file=sys.stderr, flush=True)
        try:
            for name, run in self.runs.items():
                self.clocked[name].append(run())
        except ComputationError as error:
            self.failure = str(error)

    def record(self, **more):
        """The row as a dict of plain figures; None for unknown ones."""
        record = {key: None for _, key, _ in (*COLUMNS_AT_REST, *COLUMNS_IN_MOTION)}
        record |= {"program": self.program, "element": self.element, "solve": self.solve}
        record |= dict.fromkeys(("seconds", "processor_seconds", "ns_per_element_step"))
        record["failure"] = self.failure
        if not self.failure:
            answers = self.clocked["answer"]
            record["seconds_of_runs"] = [run.seconds for run in answers]
            record["seconds"] = statistics.median(record["seconds_of_runs"])
            record["processor_seconds_of_runs"] = [run.processor_seconds for run in answers]
            record["processor_seconds"] = statistics.median(record["processor_seconds_of_runs"])
            record["steps"] = answers[0].steps
            record["iterations"] = answers[0].iterations or None
            record["seconds_per_step"] = record["processor_seconds"] / answers[0].steps
            record |= more
        return record

    def per_step(self):
        """Processor seconds per step in each round: the longer run minus the shorter one."""
        return [
            (long.processor_seconds - short.processor_seconds) / (long.steps - short.steps)
            for short, long in zip(self.clocked["answer"], self.clocked["longer"], strict=True)
        ]


def rows_at_rest(bench, options):
    """The rows of the case's answer at rest."""
    rows = []
    for element in options.elements:
        run = peer_runs.calculix_at_rest(bench, element)
        rows.append(Row("CalculiX", element, NEWTON, {"answer": run}))
    for method in options.methods or AT_REST:
        run = peer_runs.sandglass_at_rest(bench, method)
        rows.append(Row("Sandglass", method, RELAXATION, {"answer": run}))
    return rows


def rows_in_motion(motion, options):
    """The rows for the same displacements imposed with inertia."""
    rows = []
    makers = {
        "CalculiX": (peer_runs.calculix_in_motion, options.elements),
        "Sandglass": (peer_runs.sandglass_in_motion, motion_methods(options)),
    }
    for program, (make, names) in makers.items():
        for name in names:
            longer = make(motion, name, motion.longer(program))
            runs = {"answer": make(motion, name), "longer": longer}
            rows.append(Row(program, name, EXPLICIT, runs))
    return rows


def motion_methods(options):
    """The methods of Sandglass to compare in motion; they always include the twin."""
    return list(dict.fromkeys([*(options.methods or IN_MOTION), TWIN]))


def records_at_rest(bench, rows):
    """The rows with their errors. Raises InputError."""
    return [
        row.record() if row.failure else row.record(**bench.score(row.clocked["answer"][0].answer))
        for row in rows
    ]


def records_in_motion(bench, motion, rows):
    """The rows with their differences from each other."""
    own = {
        row.element: row.clocked["answer"][0].answer
        for row in rows
        if row.program == "Sandglass" and not row.failure
    }
    records = []
    for row in rows:
        more = {}
        if not row.failure:
            moved, scale = row.clocked["answer"][0].answer, motion.largest_imposed()
            far = {name: float(relative_errors(moved, u, scale)[0]) for name, u in own.items()}
            others = {name: error for name, error in far.items() if name != row.element}
            if others:
                method = min(others, key=others.get)
                more["nearest"] = {"method": method, "difference": others[method]}
            more["to_twin"] = far.get(TWIN)
            more["seconds_per_step"] = statistics.median(row.per_step())
            more["ns_of_rounds"] = [1e9 * s / len(bench.mesh.cells) for s in row.per_step()]
            more["ns_per_element_step"] = statistics.median(more["ns_of_rounds"])
        records.append(row.record(**more))
    return records


def measure(options):
    """Measure, print, store. Returns the exit code. Raises InputError."""
    for path in filter(None, (options.json, options.markdown)):
        require_writable(path)
    if shutil.which(calculix.PROGRAM) is None:
        raise InputError(
            f"{calculix.PROGRAM} is not installed; this comparison needs package "
            f"{calculix.PACKAGE}: bash ci/setup bench"
        )
    path = time_to_rest.case_path(options.case)
    time_to_rest.require_quasi_static(path)
    place = time_to_rest.machine(1)
    with tempfile.TemporaryDirectory() as folder:
        bench = peer_runs.Bench(path, folder)
        calculix.material_of(bench.case)
        at_rest, in_motion, motion = [], [], None
        if "rest" in options.solves:
            at_rest = rows_at_rest(bench, options)
        if "motion" in options.solves:
            motion = peer_runs.Motion(bench, options.steps, motion_methods(options))
            in_motion = rows_in_motion(motion, options)
        for _ in range(options.repetitions):
            for row in (*at_rest, *in_motion):
                row.round()
        place["load_average_after"] = os.getloadavg()[0]
        document = {
            **place,
            "processor_of_all_runs": bench.processor,
            "versions": bench.versions,
            "case": bench.case.name,
            "elements": len(bench.mesh.cells),
            "nodes": len(bench.mesh.points),
            "mesh_hash": bench.mesh_file.mesh_hash,
            "repetitions": options.repetitions,
            "at_rest": records_at_rest(bench, at_rest),
            "in_motion": records_in_motion(bench, motion, in_motion),
        }
        if motion:
            document |= {"time_step": motion.time_step, "share_of_displacements": motion.share}
    text = report(document, options)
    print(text)
    if options.json:
        write_json(options.json, document)
    if options.markdown:
        write_whole(options.markdown, text + "\n")
    failed = [row for row in (*at_rest, *in_motion) if row.failure]
    for row in failed:
        print(f"error: {row.program} {row.element}, {row.solve}: {row.failure}", file=sys.stderr)
    return 3 if failed else 0


def shown(records, columns):
    """A Markdown table of the non-empty columns."""
    known = [
        column for column in columns if any(record[column[1]] is not None for record in records)
    ]
    return table(records, known)


def report(document, options):
    """The report in Markdown: measurements, machine and notes."""
    loads = "{load_average_before:.2f} to {load_average_after:.2f}".format(**document)
    versions = ", ".join(f"{name} {version}" for name, version in document["versions"].items())
    lines = [
        "{case}: {nodes} nodes, {elements} elements".format(**document),
        f"on {document['processor']}, {document['cores']} cores, load {loads}; every run on one "
        f"thread of processor {document['processor_of_all_runs']}, in turn, "
        f"medians of {document['repetitions']}",
        versions,
    ]
    if document["at_rest"]:
        lines += ["", "## At rest", "", shown(document["at_rest"], COLUMNS_AT_REST), NOTES_AT_REST]
    if document["in_motion"]:
        share, step = document["share_of_displacements"], document["time_step"]
        notes = NOTES_IN_MOTION.format(steps=options.steps, step=step, share=share, twin=TWIN)
        lines += ["", "## In motion", "", shown(document["in_motion"], COLUMNS_IN_MOTION), notes]
    return "\n".join(lines).strip()


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="peers.py",
        description="CalculiX and Sandglass on the same mesh, in turn, on one thread each.",
        epilog="exit codes: 0 done, 2 bad usage or input, 3 a computation failed",
    )
    add = parser.add_argument
    add("case", nargs="?", metavar="CASE", default="column", help="name or file; default: column")
    add("--json", metavar="FILE", help="write the records and where they come from to this file")
    add("--markdown", metavar="FILE", help="write what is printed to this file")
    add("--repetitions", type=whole_number(1), default=5, metavar="N", help="default: 5")
    add("--elements", nargs="+", choices=ELEMENTS, default=ELEMENTS, help="of CalculiX; all")
    add("--methods", nargs="+", metavar="METHOD", help="of Sandglass; default: five of each kind")
    add("--solves", nargs="+", choices=("rest", "motion"), default=("rest", "motion"), help="both")
    add("--steps", type=whole_number(2), default=200, metavar="N", help="of the motion; 200")
    return exit_code(measure, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
