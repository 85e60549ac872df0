"""The fastest static answer of a program that only integrates in time.

Such a program reaches a quasi-static answer by a damped motion, whose step, duration and damping
its user has to choose. They are searched for here, in its favour: first the longest step with which
the answer stays sound, then the shortest motion whose end differs by less than WITHIN of the
imposed displacement from that of a long, slow one. The search is not part of the seconds to rest.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from common.accuracy import relative_errors
from common.errors import ComputationError
from exchange.decks.problem import STEP_FRACTION

WITHIN = 1e-3
# Durations and dampings in units of the crossing time of shear waves.
SLOW, SLOW_DAMPING = 40, 2.0
DURATIONS = (20, 14, 10, 7, 5, 3.5, 2.5)
DAMPINGS = (0.5, 1.0, 2.0, 4.0)
TRIED = 10  # crossings of the motions that test a step
GROWTH, TRIES = 1.1, 12
SOUND = 1e-2  # largest change of the answer by a longer step, over the imposed displacement


@dataclass(frozen=True)
class Way:
    """A program's motion to a static answer.

    case: path of the damped motion. time_step, duration: s. damping: 1/s.
    """

    case: object
    time_step: float
    steps: int
    duration: float
    damping: float


class RestSearch:
    """The search for one program and element."""

    def __init__(self, bench, program, element):
        self.bench, self.program, self.element = bench, program, element
        self.crossing = bench.crossing

    @cached_property
    def base_step(self):
        """A step, s, that every program should take."""
        return STEP_FRACTION * self.bench.own_step()

    def quickest(self):
        """The fastest Way. Raises ComputationError if the slow motion fails."""
        slow = self._answer(self._way(SLOW, SLOW_DAMPING, self.base_step))
        step = self._longest_step()
        best = self._way(SLOW, SLOW_DAMPING, step)
        for damping in DAMPINGS:
            for duration in DURATIONS:
                way = self._way(duration, damping, step)
                if way.steps >= best.steps:
                    continue
                if self._distance(way, slow) > WITHIN:
                    break
                best = way
        return best

    def run(self, way):
        """A Run of a Way."""
        deck = self.bench.deck(way.case, self.program, self.element)
        return self.program.run(deck, (way.time_step, way.steps))

    def _longest_step(self):
        """The longest step with which a motion ends like one with the step of Sandglass."""
        sound = self._answer(self._way(TRIED, SLOW_DAMPING, self.base_step))
        step = self.base_step
        for _ in range(TRIES):
            way = self._way(TRIED, SLOW_DAMPING, GROWTH * step)
            if self._distance(way, sound) > SOUND:
                break
            step = way.time_step
        return step

    def _way(self, duration, damping, step):
        seconds = duration * self.crossing
        steps = max(1, round(seconds / step))
        step = seconds / steps
        settings = {"duration": seconds, "time_step": step, "damping": damping / self.crossing}
        case = self.bench.write_case(1.0, **settings)
        return Way(case, step, steps, seconds, damping / self.crossing)

    def _answer(self, way):
        return self.bench.displacement(self.run(way).answer)

    def _distance(self, way, other):
        """Largest distance from another answer over the imposed displacement; inf if it fails."""
        try:
            found = self._answer(way)
        except ComputationError:
            return np.inf
        return relative_errors(found, other, self.bench.mesh.largest_imposed())[0]
