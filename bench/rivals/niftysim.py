"""Runs NiftySim, whose one-point hexahedron computes in single precision."""

import re

from rivals.program import Element, Program, Run


class NiftySim(Program):
    """One executable; it diverges with exit code 0 or 1 and reports it."""

    deck, name, precision = "niftysim", "NiftySim", "float"

    def elements(self, bench):
        """At the stiffness of its own models, and at that of Sandglass."""
        return [Element("H8", 0.075), Element("H8", bench.kappa)]

    def run(self, deck, motion):
        done = self.clocked([self.paths[0], "-x", deck.name, "-v"], deck.parent)
        said = done.output + done.errors
        answer = deck.parent / "U.txt"
        diverged = re.search(r".*[Dd]iverge.*", said)
        if diverged or done.code or not answer.exists():
            self.fail(diverged[0].strip(" !") if diverged else "no answer")
        return Run(done.seconds, done.processor_seconds, motion[1], 0, answer)
