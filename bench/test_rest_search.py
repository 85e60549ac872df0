"""The search for the fastest way, with a program whose errors follow a formula."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from common.errors import ComputationError
from rest_search import DAMPINGS, DURATIONS, GROWTH, WITHIN, RestSearch
from rivals.program import Run

UNIT = 2.0  # largest imposed displacement, m
LONGEST = 1.5  # stable step of the program over that of Sandglass


class Body:
    """A bench whose shear wave crosses the body in half a second; a case is its settings."""

    crossing = 0.5
    mesh = SimpleNamespace(largest_imposed=lambda: UNIT)

    def own_step(self):
        """s."""
        return 1e-3

    def write_case(self, share, **settings):
        """The settings."""
        assert share == 1.0
        return settings

    def deck(self, case, program, element):
        """The settings."""
        return case

    def displacement(self, answer):
        """The exact displacement, except for the error of the motion."""
        return answer


class Program:
    """Leaves an error that falls with the time, fastest at a damping of one per crossing."""

    def __init__(self, longest=LONGEST):
        self.longest, self.runs = longest, 0

    def run(self, deck, motion):
        """Diverges if steps are too long."""
        self.runs += 1
        step, steps = motion
        assert step == deck["time_step"] and step * steps == pytest.approx(deck["duration"])
        if step > self.longest * 0.8e-3:
            raise ComputationError("diverges")
        damping, duration = 0.5 * deck["damping"], deck["duration"] / 0.5
        error = math.exp(-duration * damping / (1 + damping**2))
        return Run(1.0, 1.0, steps, 0, np.array([[0.0, 0.0, UNIT * error], [0.0, 0.0, UNIT]]))


def test_the_longest_step_and_the_shortest_motion_are_found():
    way = RestSearch(Body(), Program(), None).quickest()
    # 0.8 ms times powers of 1.1, rounded to whole numbers of steps: 1.1^4 = 1.46 is the last.
    assert way.time_step == pytest.approx(0.8e-3 * GROWTH**4, rel=1e-2)
    # exp(-t / 2) < 1e-3 from t = 13.8 on.
    assert WITHIN == 1e-3 and 14 in DURATIONS and 1.0 in DAMPINGS
    assert way.duration == pytest.approx(14 * 0.5)
    assert way.damping == pytest.approx(1.0 / 0.5)
    assert way.steps == round(way.duration / way.time_step)


def test_a_program_that_takes_no_longer_steps_keeps_those_of_sandglass():
    way = RestSearch(Body(), Program(longest=1.05), None).quickest()
    assert way.time_step == pytest.approx(0.8e-3, rel=1e-2)


def test_a_program_that_diverges_with_the_steps_of_sandglass_is_reported():
    with pytest.raises(ComputationError, match="diverges"):
        RestSearch(Body(), Program(longest=0.5), None).quickest()
