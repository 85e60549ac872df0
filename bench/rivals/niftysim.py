"""Runs NiftySim, whose one-point hexahedron computes in single precision."""

import re

from rivals.program import Element, Program, Run


class NiftySim(Program):
    """One executable; it diverges with exit code 0 or 1, and says so."""

    deck, name, precision = "niftysim", "NiftySim", "float"

    def elements(self, kappa):
        """At the stiffness of its own models, and at that of Sandglass."""
        return [Element("H8", 0.075), Element("H8", kappa)]

    def run(self, deck, motion):
        done = self.clocked([self.paths[0], "-x", deck.name, "-v"], deck.parent)
        said = done.output + done.errors
        answer = deck.parent / "U.txt"
        if re.search(r"[Dd]iverge", said) or done.code or not answer.exists():
            self.fail(f"{one(said)}")
        return Run(done.seconds, done.processor_seconds, motion[1], 0, answer)


def one(said):
    """What it says of a failure, in one line."""
    found = re.search(r".*[Dd]iverge.*", said)
    return found[0].strip(" !") if found else "no answer"
