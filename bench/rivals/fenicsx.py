"""Runs FEniCSx: the golden's element of reference/ with Newton's method; static answers only."""

import re

import h5py

from common.program import ROOT
from common.result_file import text_of
from rivals.program import Element, Program, Run, one_line

# Elements -> load steps: those of the goldens, and a single one, which is faster.
LOAD_STEPS = {"Q1-P0": 10, "Q1-P0-in-1-step": 1}
# The line of newton.py about a load step.
STEP = re.compile(r"^load .*: (\d+) iterations, .*, ([\d.]+) s$", re.MULTILINE)


class FEniCSx(Program):
    """A Python with FEniCSx. Its seconds are those of Newton's method, without set-up."""

    deck, name, package, explicit, moves = "fenicsx", "FEniCSx", "python3-dolfinx", False, False

    def elements(self, bench):
        """The golden's element."""
        return [Element(name) for name in LOAD_STEPS]

    def write_deck(self, bench, case, element, folder):
        """A list of the arguments of reference/solve.py, and the mesh."""
        bench.sandglass("mesh", case, "-o", folder / "mesh.h5")
        words = ["golden", case, "--mesh", folder / "mesh.h5"]
        words += ["--load-steps", LOAD_STEPS[element.name]]
        (folder / "arguments.txt").write_text("\n".join(map(str, words)))
        return folder / "arguments.txt"

    def run(self, deck, motion):
        answer = deck.with_name("answer.h5")
        words = [*deck.read_text().splitlines(), "-o", answer]
        script = ROOT / "reference/solve.py"
        done = self.clocked([self.paths[0], script, *words], deck.parent)
        steps = STEP.findall(done.errors)
        if done.code or not steps:
            self.fail(one_line(done.errors))
        with h5py.File(answer) as file:
            self.version = text_of(file.attrs["dolfinx_version"])
        seconds = sum(float(time) for _, time in steps)
        iterations = sum(int(count) for count, _ in steps)
        return Run(seconds, done.processor_seconds, len(steps), iterations, answer)
