"""The interface of all programs that are timed on a deck of `sandglass mesh --deck`."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path

import clock
from common.errors import ComputationError, InputError
from exchange.decks import PROGRAMS as DECKS


@dataclass(frozen=True)
class Run:
    """Wall and processor time of a program (s), its steps and its answer.

    steps: of time, or increments of Newton's method. iterations: of Newton's method, or 0. answer:
    a file of displacements for `sandglass score`.
    """

    seconds: float
    processor_seconds: float
    steps: int
    iterations: int
    answer: Path


@dataclass(frozen=True)
class Element:
    """An element of a program by the name of its decks, and its hourglass coefficient or None."""

    name: str
    hourglass: float | None = None

    def __str__(self):
        return self.name if self.hourglass is None else f"{self.name} {self.hourglass:.3g}"


class Program(ABC):
    """A named program, with all that it needs to run on one thread of one processor.

    deck: its name for `sandglass mesh --deck`. explicit: whether it only integrates in time, so
    that it finds static answers by a damped motion. moves: whether it can integrate in time.
    """

    deck: str
    name: str
    explicit = moves = True
    precision = "double"

    def __init__(self, paths, build="", about=""):
        """paths: of its executables. build: distinguishes builds of a program. about: its revision,
        compiler and flags as text. Before it runs, `environment` and `processor` are set."""
        self.paths, self.build, self.about = paths, build, about
        self.environment, self.processor, self.version = {}, None, ""
        for path in paths:
            if not Path(path).is_file():
                raise InputError(f"--program {self.deck}={path}: no such file")

    def __str__(self):
        return f"{self.name} ({self.build})" if self.build else self.name

    @abstractmethod
    def run(self, deck, motion):
        """A Run on a deck, in its folder. motion: (time step in s, steps) of a motion, or None.

        Raises ComputationError if the program fails, InputError if its output cannot be read.
        """

    def write_deck(self, bench, case, element, folder):
        """Writes a case for the program and one of its Elements into an empty folder.

        Returns the path of the file to run. Raises InputError for unsupported features.
        """
        output = folder / f"deck{DECKS[self.deck].ENDING}"
        words = ["mesh", case, "--deck", self.deck, "--element", element.name, "-o", output]
        if element.hourglass is not None:
            words += ["--hourglass", repr(element.hourglass)]
        bench.sandglass(*words)
        return output

    @abstractmethod
    def elements(self, bench):
        """The Elements to time. bench: has kappa, the hourglass stiffness of Sandglass."""

    def provenance(self):
        """The origin of its figures, for the JSON file."""
        return {
            "program": self.deck,
            "name": self.name,
            "build": self.build,
            "version": self.version,
            "about": self.about,
        }

    def clocked(self, command, folder):
        """The clock.Clocked of a command in a folder."""
        return clock.run(command, folder, self.environment, self.processor)

    def fail(self, reason):
        """Raises ComputationError."""
        raise ComputationError(f"{self}: {reason}")


def one_line(text):
    """The last line of an output that mentions an error, or else the last line."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    found = [line for line in lines if "error" in line.lower()]
    return (found or lines or ["no message"])[-1]
