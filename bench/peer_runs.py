"""The runs timed by bench/peers.py: one program on one case, at rest or in motion.

A run is a function without arguments that returns a Run. Each works in a new folder.
"""

import itertools
import json
import math
import os
import re
from dataclasses import dataclass
from pathlib import Path

import calculix
import clock
from case_file import read_case, read_tables
from common.errors import ComputationError, InputError
from common.program import binary
from common.result_file import last_displacement
from exchange.calculix_deck import Explicit
from mesh_file import load_case_mesh, make_mesh

# Largest speed of imposed displacements over the shear wave speed; strains are of this order.
SPEED = 0.1
CURVE_RATE = 15 / 8  # the steepest that the loading curve of eq. 15 is
STEP_FRACTION = 0.8  # of the smallest stable step of all programs and methods
# The longer run of a motion has at least three times the steps and, in Sandglass, enough elements
# times steps for half a second, so that its excess is clear of the start-up time.
ELEMENT_STEPS = {"CalculiX": 0, "Sandglass": 4e6}


@dataclass(frozen=True)
class Run:
    """Wall and processor time of a process (s), its steps and its displacement.

    steps: increments of CalculiX, force evaluations of Sandglass. iterations: of Newton's method,
    or 0. answer: a file of displacements for `sandglass score`, or the displacement (n, 3) in m.
    """

    seconds: float
    processor_seconds: float
    steps: int
    iterations: int
    answer: object


class Bench:
    """Shared by the runs of a case: files, folder, environment for one thread, processor."""

    def __init__(self, path, folder):
        self.path, self.folder = path, Path(folder)
        self.case = read_case(path)
        self.mesh_path = self.folder / "mesh.h5"
        make_mesh(path, self.mesh_path)
        self.mesh, self.mesh_file = load_case_mesh(self.case, self.mesh_path)
        self.binary = binary()
        self.environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        self.processor = max(os.sched_getaffinity(0))
        self.versions = {
            "sandglass": self.sandglass("--version").output.split(maxsplit=1)[1].strip()
        }
        self._fresh = itertools.count()

    def fresh_folder(self):
        """An empty folder."""
        folder = self.folder / f"run-{next(self._fresh)}"
        folder.mkdir()
        return folder

    def sandglass(self, *arguments):
        """Run Sandglass: clock.Clocked.

        Raises InputError for exit code 2, ComputationError for 3.
        """
        done = clock.run([self.binary, *arguments], None, self.environment, self.processor)
        if done.code not in (0, 1):
            told = done.errors.strip().splitlines() or ["no message"]
            kind = InputError if done.code == 2 else ComputationError
            raise kind(f"sandglass {arguments[0]}: {told[-1].removeprefix('error: ')}")
        return done

    def score(self, answer):
        """Max errors of a file of displacements, as fractions.

        Relative to golden and truth or, without a golden, to the explicit twin; None if unknown.
        """
        output = self.folder / "score.json"
        self.sandglass("score", answer, "--case", self.path, "--json", output)
        record = json.loads(output.read_text(encoding="utf-8"))["records"][0]
        found = {name: record.get(name) for name in ("golden", "truth", "twin")}
        return {name: errors and errors["max_relative_error"] for name, errors in found.items()}


def calculix_at_rest(bench, element):
    """A run: ccx on the static deck of `sandglass mesh --deck`."""

    def run():
        folder = bench.fresh_folder()
        deck = folder / "deck.inp"
        bench.sandglass("mesh", bench.path, "--deck", "--element", element, "-o", deck)
        text, nodes = deck.read_text(encoding="utf-8"), len(bench.mesh.points)
        found = calculix.solve(text, nodes, folder, bench.environment, bench.processor)
        return _of_calculix(bench, found, folder / "case.frd")

    return run


def sandglass_at_rest(bench, method):
    """A run: `sandglass run`, dynamic relaxation to rest."""

    def run():
        output = bench.fresh_folder() / "result.h5"
        done = bench.sandglass("run", bench.path, "-m", method, "-t", 1, "-o", output)
        steps = int(_said(r"at rest after (\d+) steps", done.output))
        return Run(done.seconds, done.processor_seconds, steps, 0, output)

    return run


class Motion:
    """A share of a case's displacements, imposed with inertia within a number of steps.

    share: that for which they move at SPEED, at most one. Raises InputError for a case that cannot
    be run like this, ComputationError if a program cannot take a step.
    """

    def __init__(self, bench, steps, methods):
        self.bench, self.steps = bench, steps
        if bench.case.rotations or bench.case.forces:
            raise InputError(f"{bench.path}: explicit runs support only [[displacement]]")
        self.material = next(iter(read_tables(bench.path).values()))["material"]
        shear = self.material["young_modulus"] / 2 / (1 + self.material["poisson_ratio"])
        self.speed = SPEED * math.sqrt(shear / self.material["density"])
        self._set_step(1e-9)  # shorter than the step of any program
        folder = bench.fresh_folder()
        calculix_step = calculix.stable_step(self.deck("C3D8", 1), folder, bench.environment)
        self._set_step(calculix_step)
        self._set_step(STEP_FRACTION * min([calculix_step, *map(self._own_step, methods)]))

    def _set_step(self, seconds):
        """Sets the step, rounded to three digits, and the share of the displacements that fits."""
        self.time_step = float(f"{seconds:.3g}")
        way = self.speed * self.time_step * self.steps / CURVE_RATE
        self.share = min(1.0, way / self.bench.mesh.largest_imposed())

    def _own_step(self, method):
        """The mean step, s, that a method of Sandglass chooses by default."""
        done = self.bench.sandglass("run", self.write_case(1, time_step=0.0), "-m", method)
        return self.time_step * self.steps / int(_said(r"in (\d+) steps of", done.output))

    def explicit(self, longer):
        """The motion for CalculiX. longer: factor for the number of steps."""
        steps = longer * self.steps
        return Explicit(self.material["density"], self.time_step, steps, self.steps)

    def deck(self, element, longer):
        """CalculiX's deck."""
        case, mesh = self.bench.case, self.bench.mesh
        options = {"explicit": self.explicit(longer), "share": self.share}
        material = calculix.material_of(case)
        return calculix.deck(case.name, mesh, material, element, **options)

    def write_case(self, longer, time_step=None):
        """Writes the motion as a case of Sandglass; returns its path. time_step: 0: default."""
        ramp = self.time_step * self.steps
        case = {"name": self.bench.case.name, "requirement": "It moves.", "answer": "dynamic"}
        dynamics = {
            "duration": longer * ramp,
            "ramp_time": ramp,
            "time_step": self.time_step if time_step is None else time_step,
            "frames": 1,
        }
        lines = _table("[case]", case) + _table("[mesh]", {"file": str(self.bench.mesh_path)})
        lines += _table("[material]", self.material) + _table("[dynamics]", dynamics)
        for entry in self.bench.case.displacements:
            value = [self.share * component for component in entry.value]
            axes = "".join("xyz"[axis] for axis in entry.components)
            moved = {"set": entry.set_name, "value": value, "components": axes}
            lines += _table("[[displacement]]", moved)
        path = self.bench.fresh_folder() / f"{self.bench.case.name}.toml"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return path

    def longer(self, program):
        """The number of steps in the longer run of a program over that in the shorter one."""
        return max(3, round(ELEMENT_STEPS[program] / len(self.bench.mesh.cells) / self.steps))

    def largest_imposed(self):
        """Of the displacements, m."""
        return self.share * self.bench.mesh.largest_imposed()


def calculix_in_motion(motion, element, longer=1):
    """A run: ccx by *DYNAMIC, EXPLICIT. longer: factor for the number of steps."""
    bench = motion.bench

    def run():
        explicit, folder = motion.explicit(longer), bench.fresh_folder()
        text, nodes = motion.deck(element, longer), len(bench.mesh.points)
        found = calculix.move(text, nodes, folder, explicit, bench.environment, bench.processor)
        return _of_calculix(bench, found, found.displacement)

    return run


def sandglass_in_motion(motion, method, longer=1):
    """A run: `sandglass run` of the motion as a dynamic case."""
    path = motion.write_case(longer)

    def run():
        output = motion.bench.fresh_folder() / "result.h5"
        done = motion.bench.sandglass("run", path, "-m", method, "-t", 1, "-o", output)
        steps = int(_said(r"in (\d+) steps of", done.output))
        return Run(done.seconds, done.processor_seconds, steps, 0, last_displacement(output))

    return run


def _of_calculix(bench, found, answer):
    """The Run of a calculix.Solution, with its answer."""
    bench.versions["ccx"] = found.version
    times = found.process_seconds, found.processor_seconds
    return Run(*times, found.increments, found.iterations, answer)


def _said(pattern, text):
    """The match of a pattern in a program's output. Raises ComputationError if there is none."""
    found = re.search(pattern, text)
    if not found:
        raise ComputationError(f"sandglass printed {text!r}: {pattern!r} is required")
    return found[1]


def _table(name, values):
    """The lines of a TOML table; strings, numbers and lists are written as in JSON."""
    return [name, *(f"{key} = {json.dumps(value)}" for key, value in values.items()), ""]
