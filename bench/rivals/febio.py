"""Runs FEBio: Newton's method for static answers, central differences in motion."""

import re

from rivals.program import Element, Program, Run, one_line


class FEBio(Program):
    """One executable; its log has the steps and iterations."""

    deck, name, explicit = "febio", "FEBio", False

    def elements(self, bench):
        """The three-field element (the golden's), and one point with hourglass control."""
        return [Element("three-field-solid"), Element("udg-hex")]

    def run(self, deck, motion):
        done = self.clocked([self.paths[0], "-i", deck.name, "-noconfig"], deck.parent)
        log, answer = deck.with_suffix(".log"), deck.parent / "displacement.log"
        said = log.read_text(errors="replace") if log.exists() else done.output
        if "N O R M A L   T E R M I N A T I O N" not in said or not answer.exists():
            self.fail(one_line(said))
        counts = [
            re.findall(rf"{words} *\.+ *: *(\d+)", said)
            for words in (
                "Number of time steps completed",
                "Total number of equilibrium iterations",
            )
        ]
        steps, iterations = (int(found[-1]) if found else 0 for found in counts)
        return Run(done.seconds, done.processor_seconds, steps, iterations, answer)
