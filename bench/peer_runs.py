"""The runs timed by bench/peers.py: one program on one case, static or in motion.

A run is a function without arguments that returns a Run. Each works in a new folder.
"""

import itertools
import json
import math
import os
import re
import shutil
from pathlib import Path

import numpy as np

import clock
from case_file import read_case, read_tables
from common.errors import ComputationError, InputError
from common.program import binary
from exchange.convert import match_displacement
from exchange.decks.problem import DAMPING_PER_CROSSING, RELAXATION_CROSSINGS, STEP_FRACTION
from exchange.hdf5_file import read_displacement
from mesh_file import load_case_mesh, make_mesh
from rivals.program import Run

# Largest speed of imposed displacements over the shear wave speed; strains are of this order.
SPEED = 0.1
CURVE_RATE = 15 / 8  # the largest slope of the loading curve of eq. 15
# The longer run of a motion has at least three times the steps and, in programs that step quickly,
# this many elements times steps, a fifth of a second of ours, which exceeds the start-up time.
MANY = 2e7
# The lines of `sandglass run` about the steps of a motion, and the evaluations of a static run.
STEPS = r"in (\d+) steps of"
EVALUATIONS = r"equilibrium \(.*\): (\d+) evaluation"


class Bench:
    """Shared by the runs of a case: files, folder, environment for one thread, processor."""

    def __init__(self, path, folder):
        self.path, self.folder = path, Path(folder)
        self.case = read_case(path)
        self.mesh_path = self.folder / "mesh.h5"
        make_mesh(path, self.mesh_path)
        self.mesh, self.mesh_file = load_case_mesh(self.case, self.mesh_path)
        self.tables = next(iter(read_tables(path).values()))
        self.binary = binary()
        self.environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        self.processor = max(os.sched_getaffinity(0))
        self._fresh, self._decks = itertools.count(), {}

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
            lines = done.errors.strip().splitlines() or ["no message"]
            kind = InputError if done.code == 2 else ComputationError
            raise kind(f"sandglass {arguments[0]}: {lines[-1].removeprefix('error: ')}")
        return done

    def build(self):
        """Compiler and flags of Sandglass as text."""
        output = self.folder / "provenance.json"
        self.sandglass("flops", "--json", output)
        found = json.loads(output.read_text(encoding="utf-8"))
        return f"{found['compiler']}, {found['build_flags']}"

    @property
    def kappa(self):
        """The hourglass stiffness of eq. 12 that tl-perturbation uses for a neo-Hookean material: E
        / 9 over lambda + 2 mu."""
        poisson = self.material["poisson_ratio"]
        return (1 + poisson) * (1 - 2 * poisson) / (1 - poisson) / 9

    def deck(self, case, program, element):
        """The path of a case's deck for a program and one of its Elements, in a new folder."""
        key = case, program.deck, element
        if key not in self._decks:
            self._decks[key] = program.write_deck(self, case, element, self.fresh_folder())
        folder = self.fresh_folder()
        shutil.copytree(self._decks[key].parent, folder, dirs_exist_ok=True)
        return folder / self._decks[key].name

    def score(self, answer):
        """Max errors of a file of displacements, as fractions.

        Relative to golden and truth or, without a golden, to tl-mean-dilatation; None if unknown.
        """
        output = self.folder / "score.json"
        self.sandglass("score", answer, "--case", self.path, "--json", output)
        record = json.loads(output.read_text(encoding="utf-8"))["records"][0]
        found = {name: record.get(name) for name in ("golden", "truth", "twin")}
        return {name: errors and errors["max_relative_error"] for name, errors in found.items()}

    def displacement(self, answer):
        """The displacements (n, 3), m, of any answer that `sandglass score` reads.

        Raises ComputationError for an invalid answer.
        """
        output = self.folder / "displacement.h5"
        try:
            match_displacement(answer, self.mesh_path, output)
        except InputError as error:
            raise ComputationError(str(error)) from error
        return read_displacement(output, lambda text: None)[1]

    @property
    def material(self):
        """The entries of [material]. Raises InputError for several materials and other moduli."""
        material = self.tables.get("material", {})
        if not {"young_modulus", "poisson_ratio"} <= material.keys():
            raise InputError(
                f"{self.path}: explicit runs support only one [material], with young_modulus and "
                "poisson_ratio"
            )
        return material

    @property
    def shear_wave_speed(self):
        """Of the undeformed material, m/s."""
        shear = self.material["young_modulus"] / 2 / (1 + self.material["poisson_ratio"])
        return math.sqrt(shear / self.material["density"])

    def write_case(self, share, **dynamics):
        """Writes the case as a dynamic one, with a share of its displacements; returns its path.

        dynamics: entries of [dynamics]. Raises InputError for a case that has no motion.
        """
        if self.case.rotations or self.case.forces:
            raise InputError(f"{self.path}: explicit runs support only [[displacement]]")
        case = {"name": self.case.name, "requirement": "It moves.", "answer": "dynamic"}
        lines = _table("[case]", case) + _table("[mesh]", {"file": str(self.mesh_path)})
        lines += _table("[material]", self.material)
        lines += _table("[dynamics]", {"frames": 1, **dynamics})
        for entry in self.case.displacements:
            value = [share * component for component in entry.value]
            axes = "".join("xyz"[axis] for axis in entry.components)
            moved = {"set": entry.set_name, "value": value, "components": axes}
            lines += _table("[[displacement]]", moved)
        path = self.fresh_folder() / f"{self.case.name}.toml"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return path

    def own_step(self, method="tl-perturbation"):
        """The default step, s, of a method of Sandglass near the undeformed state."""
        span = self.mesh.largest_imposed() / self.shear_wave_speed
        done = self.sandglass("run", self.write_case(1e-6, duration=span), "-m", method)
        return span / _said(STEPS, done.output)

    @property
    def crossing(self):
        """The time, s, in which a shear wave crosses the body."""
        return np.linalg.norm(np.ptp(self.mesh.points, axis=0)) / self.shear_wave_speed

    def mean_step(self, method):
        """The mean step, s, of a method of Sandglass in a damped motion to the whole load.

        Raises ComputationError if the motion fails.
        """
        duration = RELAXATION_CROSSINGS * self.crossing
        settings = {"duration": duration, "damping": DAMPING_PER_CROSSING / self.crossing}
        done = self.sandglass("run", self.write_case(1.0, **settings), "-m", method)
        return duration / _said(STEPS, done.output)


def run_of(bench, program, element, case, motion=None):
    """A run: a program's answer to a case. motion: (time step in s, steps); None: static."""
    return lambda: program.run(bench.deck(case, program, element), motion)


def own_run(bench, method, precision, case, counted):
    """A run: `sandglass run`. precision: "double" or "float". counted: a pattern of its steps."""

    def run():
        output = bench.fresh_folder() / "result.h5"
        words = ["run", case, "-m", method, "--precision", precision, "-t", 1, "-o", output]
        done = bench.sandglass(*words)
        return Run(done.seconds, done.processor_seconds, _said(counted, done.output), 0, output)

    return run


class Motion:
    """A share of a case's displacements, imposed with inertia within a number of steps.

    share: the one at which they move with SPEED, at most one. Raises InputError for a case that
    cannot be run like this.
    """

    def __init__(self, bench, steps, methods):
        self.bench, self.steps = bench, steps
        step = STEP_FRACTION * min(map(bench.own_step, methods))
        self.time_step = float(f"{step:.3g}")
        way = SPEED * bench.shear_wave_speed * self.time_step * steps / CURVE_RATE
        self.share = min(1.0, way / bench.mesh.largest_imposed())

    def write_case(self, longer):
        """Writes the motion as a case; returns its path. longer: factor for its steps."""
        duration = self.time_step * self.steps * longer
        return self.bench.write_case(self.share, duration=duration, time_step=self.time_step)

    def of(self, longer):
        """(time step in s, steps). longer: as in write_case()."""
        return self.time_step, self.steps * longer

    def longer(self, quick):
        """The number of steps in the longer run over that in the shorter one.

        quick: whether the program is made for explicit steps.
        """
        least = MANY / len(self.bench.mesh.cells) / self.steps if quick else 0
        return max(3, round(least))

    def largest_imposed(self):
        """The largest of the imposed displacements, m."""
        return self.share * self.bench.mesh.largest_imposed()


def _said(pattern, text):
    """The number that a pattern finds in an output. Raises ComputationError if there is none."""
    found = re.search(pattern, text)
    if not found:
        raise ComputationError(f"sandglass printed {text!r}: {pattern!r} is required")
    return int(found[1])


def _table(name, values):
    """The lines of a TOML table; strings, numbers and lists are written as in JSON."""
    return [name, *(f"{key} = {json.dumps(value)}" for key, value in values.items()), ""]
