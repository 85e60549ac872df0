"""Runs CalculiX (ccx): Newton's method for static answers, central differences in motion."""

import math
import re
from pathlib import Path

from common.errors import InputError
from rivals.program import Element, Program, Run

PROGRAM = "ccx"
SECONDS = r"Total CalculiX Time: *([\d.]+)"


class CalculiX(Program):
    """One executable, from the package calculix-ccx."""

    deck, name, package, explicit = "calculix", "CalculiX", "calculix-ccx", False

    def elements(self, bench):
        """Full and reduced integration, and incompatible modes."""
        return [Element("C3D8"), Element("C3D8R"), Element("C3D8I")]

    def run(self, deck, motion):
        """If ccx considers the steps of a motion unstable, it takes more and shorter ones."""
        done = self.clocked([self.paths[0], "-i", deck.stem], deck.parent)
        if done.code or not re.search(SECONDS, done.output):
            errors = re.findall(r"\*ERROR.*", done.output)
            self.fail(f"ended with {done.code}: {errors[-1] if errors else 'no message'}")
        version = re.search(r"CalculiX Version ([\w.]+)", done.output)
        self.version = version[1] if version else "unknown"
        steps = self._moved(deck, done, motion) if motion else self._solved(deck)
        times = done.seconds, done.processor_seconds
        return Run(*times, *steps, deck.with_suffix(".frd"))

    def _solved(self, deck):
        """(increments, iterations) of a static answer."""
        increments, iterations, reached = read_progress(deck.with_suffix(".sta"))
        if reached != 1:
            self.fail(f"stopped at {reached:.4f} of the load")
        return increments, iterations

    def _moved(self, deck, done, motion):
        """(increments, 0) of a motion."""
        selected = re.search(r"SELECTED time increment: *(\S+)", done.output)
        text = _text(deck.with_suffix(".frd"))
        reached = re.findall(r"^  100CL +\d+ +(\S+)", text, re.MULTILINE)
        duration = motion[0] * motion[1]
        if (
            not (selected and reached) or abs(float(reached[-1]) / duration - 1) > 1e-5
        ):  # six digits
            self.fail(f"stopped at {(reached or '0')[-1]} s of {duration:g} s")
        return math.ceil(duration / float(selected[1]) - 1e-5), 0


def read_progress(path):
    """(increments, iterations, share of the load reached) from a progress file of ccx (.sta).

    increments: those that converged. iterations: all, including those of increments that were cut.
    Raises InputError naming the line and the rule if the file is unreadable or malformed.
    """
    increments, iterations, reached = 0, 0, 0.0
    for number, line in enumerate(_text(path).splitlines()[2:], start=3):
        try:
            _, _, attempt, count, _, time_in_step, _ = line.split()
            iterations += int(count)
            if not attempt.endswith("U"):  # ccx marks increments that did not converge
                increments, reached = increments + 1, float(time_in_step)
        except ValueError as error:
            raise InputError(
                f"{path}:{number}: {line.strip()!r}: seven columns STEP INC ATT ITRS and three "
                "times are required"
            ) from error
    return increments, iterations, reached


def _text(path):
    """The text of a file that ccx wrote. Raises InputError."""
    try:
        return Path(path).read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(
            f"{path}: cannot be read as an output file of CalculiX: {error}"
        ) from error
