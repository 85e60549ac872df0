"""Other programs and Sandglass on the same mesh, in turn, on one thread each: seconds and errors.

Usage: /usr/bin/python3 bench/peers.py [CASE] --program NAME[:BUILD]=PATH... [--json FILE]
`ci/peers` calls it. Needs the programs (bench/README.md names their versions) and the solver's
binary: build/release/sandglass, or the one given by SANDGLASS_BINARY.
Exit codes: 0 done, 2 bad usage or input, 3 a computation failed (the others are still shown).
"""

import os
import re
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [str(TREE), str(TREE / "reference")]

import measuring  # first: reference/ may then do without UFL

import peer_runs
from common.accuracy import relative_errors
from common.command import command_line, option, whole_number
from common.errors import ComputationError, InputError, suggestion
from common.files import write_json
from peer_report import MEAN_DILATATION, MOTION_COLUMNS, STATIC_COLUMNS, report
from rest_search import RestSearch
from rivals import PROGRAMS

METHODS = ("tl-perturbation", "tl-four-point", "tl-mean-dilatation", "tl-full")
STATIC_METHODS = (*METHODS, "tl-energy-sampling")
MOTION_METHODS = (*METHODS, "ul-perturbation")
# Methods that are also computed in single precision, like programs that use it.
IN_FLOAT = ("tl-perturbation", "tl-mean-dilatation")
NEWTON, RELAXATION, EXPLICIT = "Newton", "search for rest", "central differences"
DAMPED = "damped motion"
# The unit of cost of each way: explicit steps, load steps of Newton's method, evaluations.
COUNTED = {NEWTON: "load_steps", RELAXATION: "evaluations", EXPLICIT: "steps", DAMPED: "steps"}


class Row:
    """A program with an element, and its timed runs.

    runs: name -> function that returns a Run; timed in this order in every round. more: figures of
    the record that are known before.
    """

    def __init__(self, program, element, solve, runs, **more):
        self.program, self.element, self.solve, self.runs = program, element, solve, runs
        self.clocked = {name: [] for name in runs}
        self.more, self.failure = more, None

    @property
    def sound(self):
        """Whether it has an answer."""
        return self.failure is None

    def answer_name(self):
        """A name for a copy of the answer."""
        words = [self.program, self.more["build"], self.element, self.more["precision"]]
        name = "-".join(word.lower().replace(" ", "-") for word in words if word)
        answer = self.clocked["answer"][0].answer
        return name + (answer.suffix or answer.name[-4:])  # an animation file has no extension

    def round(self):
        """Times every run once more; skips a failed row."""
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
        record = {key: None for _, key, _ in (*STATIC_COLUMNS, *MOTION_COLUMNS)}
        record |= {"program": self.program, "element": self.element, "solve": self.solve}
        known = ("seconds", "processor_seconds", "ns_per_element_step")
        record |= dict.fromkeys(known) | self.more
        record["failure"] = self.failure
        if not self.failure:
            answers = self.clocked["answer"]
            record["seconds_of_runs"] = [run.seconds for run in answers]
            record["seconds"] = statistics.median(record["seconds_of_runs"])
            record["processor_seconds_of_runs"] = [run.processor_seconds for run in answers]
            record["processor_seconds"] = statistics.median(record["processor_seconds_of_runs"])
            record[COUNTED[self.solve]] = answers[0].steps
            if "duration" in self.more:  # the program may have taken shorter steps than requested
                record["time_step"] = self.more["duration"] / answers[0].steps
            record["iterations"] = answers[0].iterations or None
            if COUNTED[self.solve] == "steps":
                record["seconds_per_step"] = record["processor_seconds"] / answers[0].steps
            record |= more
        return record

    def per_step(self):
        """Processor seconds per step in each round: the longer run minus the shorter one."""
        return [
            (long.processor_seconds - short.processor_seconds) / (long.steps - short.steps)
            for short, long in zip(self.clocked["answer"], self.clocked["longer"], strict=True)
        ]


def static_rows(bench, programs, options):
    """A static row for each program, element and method."""
    rows, found = [], {}
    for program, element in elements_of(bench, programs, options):
        more = {"precision": program.precision, "build": program.build}
        if program.explicit:
            rows.append(damped_row(bench, program, element, found, more))
        else:
            runs = {"answer": peer_runs.run_of(bench, program, element, bench.path)}
            rows.append(Row(program.name, str(element), NEWTON, runs, **more))
    for method in options.methods or STATIC_METHODS:
        step = step_of(bench, method) if "motion" in options.solves else None
        for precision in precisions_of(method):
            own = (bench, method, precision, bench.path, peer_runs.EVALUATIONS)
            runs = {"answer": peer_runs.own_run(*own)}
            more = {"precision": precision, "build": "", "time_step": step}
            rows.append(Row("Sandglass", method, RELAXATION, runs, **more))
    return rows


def step_of(bench, method):
    """The mean step of a method of Sandglass in a damped motion; None if the motion fails."""
    try:
        return bench.mean_step(method)
    except ComputationError:
        return None


def damped_row(bench, program, element, found, more):
    """The row of a program that finds static answers by a damped motion.

    found: (deck, element) -> Way or ComputationError, shared by all builds of a program; filled.
    more: figures of the record.
    """
    search, key = RestSearch(bench, program, element), (program.deck, element)
    if key not in found:
        print(f"{program} {element}, quickest way to equilibrium", file=sys.stderr, flush=True)
        try:
            found[key] = search.quickest()
        except ComputationError as error:
            found[key] = error
    way = found[key]
    if isinstance(way, ComputationError):
        row = Row(program.name, str(element), DAMPED, {}, **more)
        row.failure = str(way)
        return row
    more |= {"duration": way.duration, "damping": way.damping}
    return Row(program.name, str(element), DAMPED, {"answer": lambda: search.run(way)}, **more)


def rows_in_motion(motion, programs, options):
    """A row for each program, element and method, in motion."""
    rows = []
    for program, element in elements_of(motion.bench, programs, options):
        if not program.moves:
            continue
        runs = {
            name: peer_runs.run_of(
                motion.bench, program, element, motion.write_case(longer), motion.of(longer)
            )
            for name, longer in (("answer", 1), ("longer", motion.longer(program.explicit)))
        }
        more = {"precision": program.precision, "build": program.build}
        rows.append(Row(program.name, str(element), EXPLICIT, runs, **more))
    for method in motion_methods(options):
        for precision in precisions_of(method):
            runs = {
                name: peer_runs.own_run(
                    motion.bench, method, precision, motion.write_case(longer), peer_runs.STEPS
                )
                for name, longer in (("answer", 1), ("longer", motion.longer(True)))
            }
            rows.append(Row("Sandglass", method, EXPLICIT, runs, precision=precision, build=""))
    return rows


def precisions_of(method):
    """The precisions in which a method of Sandglass is timed."""
    return ("double", "float") if method in IN_FLOAT else ("double",)


def elements_of(bench, programs, options):
    """(program, Element) of all requested ones."""
    pairs = [(p, e) for p in programs for e in p.elements(bench)]
    if not options.elements:
        return pairs
    names = list(dict.fromkeys(str(element) for _, element in pairs))
    for name in options.elements:
        if name not in names:
            raise InputError(f"--elements {name}: {suggestion(name, names)}")
    return [pair for pair in pairs if str(pair[1]) in options.elements]


def motion_methods(options):
    """The methods of Sandglass to compare in motion; always includes the golden's."""
    return list(dict.fromkeys([*(options.methods or MOTION_METHODS), MEAN_DILATATION]))


def static_records(bench, rows):
    """The rows with their errors. Raises InputError."""
    return [
        (
            row.record(answer=row.answer_name(), **bench.score(row.clocked["answer"][0].answer))
            if row.sound
            else row.record()
        )
        for row in rows
    ]


def records_in_motion(bench, motion, rows):
    """The rows with their differences from each other."""
    moved = {row: bench.displacement(row.clocked["answer"][0].answer) for row in rows if row.sound}
    own = {
        row.element: u
        for row, u in moved.items()
        if row.program == "Sandglass" and row.more["precision"] == "double"
    }
    records = []
    for row in rows:
        more = {}
        if row.sound:
            scale = motion.largest_imposed()
            far = {name: float(relative_errors(moved[row], u, scale)[0]) for name, u in own.items()}
            others = {name: error for name, error in far.items() if name != row.element}
            if others:
                method = min(others, key=others.get)
                more["nearest"] = {"method": method, "difference": others[method]}
            more["to_mean_dilatation"] = far.get(MEAN_DILATATION)
            duration = motion.time_step * motion.steps
            more["time_step"] = duration / row.clocked["answer"][0].steps
            more["seconds_per_step"] = statistics.median(row.per_step())
            more["ns_of_rounds"] = [1e9 * s / len(bench.mesh.cells) for s in row.per_step()]
            more["ns_per_element_step"] = statistics.median(more["ns_of_rounds"])
        records.append(row.record(**more))
    return records


def programs_of(options):
    """The programs requested by --program and --about."""
    about = {}
    for text in options.about or ():
        key, separator, words = text.partition("=")
        if not separator:
            raise InputError(f"--about {text}: must be NAME[:BUILD]=TEXT")
        about[key] = words
    programs = []
    for text in options.program:
        found = re.fullmatch(r"(\w+)(?::([^=]+))?=(.+)", text)
        if not found:
            raise InputError(f"--program {text}: must be NAME[:BUILD]=PATH")
        name, build, paths = found[1], found[2] or "", found[3].split(",")
        if name not in PROGRAMS:
            raise InputError(f"--program {name}: {suggestion(name, sorted(PROGRAMS))}")
        paths = [shutil.which(path) or path for path in paths]
        key = text.partition("=")[0]
        programs.append(PROGRAMS[name](paths, build=build, about=about.pop(key, "")))
    for key in about:
        raise InputError(f"--about {key}: there is no --program {key}")
    return programs


def measure(options):
    """Measures, prints, stores. Returns the exit code. Raises InputError."""
    programs = programs_of(options)
    path = measuring.case_path(options.case)
    place = measuring.machine()
    with tempfile.TemporaryDirectory() as folder:
        bench = peer_runs.Bench(path, folder)
        for program in programs:
            program.environment, program.processor = bench.environment, bench.processor
        static, in_motion, motion = [], [], None
        if "rest" in options.solves:
            static = static_rows(bench, programs, options)
        if "motion" in options.solves:
            motion = peer_runs.Motion(bench, options.steps, motion_methods(options))
            in_motion = rows_in_motion(motion, programs, options)
        for _ in range(options.repetitions):
            for row in (*static, *in_motion):
                row.round()
        place["load_average_after"] = os.getloadavg()[0]
        version = place.pop("versions")["sandglass"]
        document = {
            **place,
            "processor_of_all_runs": bench.processor,
            "sandglass": version,
            "build": bench.build(),
            "programs": [program.provenance() for program in programs],
            "case": bench.case.name,
            "elements": len(bench.mesh.cells),
            "nodes": len(bench.mesh.points),
            "mesh_hash": bench.mesh_file.mesh_hash,
            "repetitions": options.repetitions,
            "static": static_records(bench, static),
            "in_motion": records_in_motion(bench, motion, in_motion),
        }
        if motion:
            document |= {"time_step": motion.time_step, "share_of_displacements": motion.share}
        if options.answers:
            keep_answers(static, options.answers)
    print(report(document, options.steps))
    if options.json:
        write_json(options.json, document)
    failed = [row for row in (*static, *in_motion) if row.failure]
    for row in failed:
        print(f"error: {row.program} {row.element}, {row.solve}: {row.failure}", file=sys.stderr)
    return 3 if failed else 0


def keep_answers(rows, folder):
    """Copies static answers to a folder, under the names in their records."""
    folder.mkdir(parents=True, exist_ok=True)
    for row in filter(lambda row: row.sound, rows):
        shutil.copy(row.clocked["answer"][0].answer, folder / row.answer_name())


main = command_line(
    measure,
    __doc__,
    option("case", nargs="?", metavar="CASE", default="column", help="name or file; column"),
    option(
        "--program",
        action="append",
        default=[],
        metavar="NAME[:BUILD]=PATH",
        help=f"of {', '.join(sorted(PROGRAMS))}; several are possible. OpenRadioss: STARTER,ENGINE",
    ),
    option("--about", action="append", metavar="NAME[:BUILD]=TEXT", help="its revision and flags"),
    measuring.JSON,
    option("--answers", type=Path, metavar="FOLDER", help="keep the static displacements"),
    option("--repetitions", type=whole_number(1), default=5, metavar="N", help="default: 5"),
    option("--elements", nargs="+", metavar="ELEMENT", help="of the programs; default: all"),
    option("--methods", nargs="+", metavar="METHOD", help="of Sandglass; default: five of each"),
    option("--solves", nargs="+", choices=("rest", "motion"), default=("rest", "motion")),
    option("--steps", type=whole_number(2), default=200, metavar="N", help="of the motion; 200"),
    prog="peers.py",
)

if __name__ == "__main__":
    sys.exit(main())
