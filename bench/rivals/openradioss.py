"""Runs OpenRadioss: the starter prepares a model, the engine moves it."""

import os
import re
from pathlib import Path

from common.errors import InputError
from rivals.program import Element, Program, Run, one_line


class OpenRadioss(Program):
    """Two executables, starter and engine. The engine's time counts; two lengths of run remove the
    time that it takes to read the model."""

    deck, name = "openradioss", "OpenRadioss"

    def __init__(self, paths, **more):
        super().__init__(paths, **more)
        if len(paths) != 2:
            raise InputError("--program openradioss=STARTER,ENGINE: needs both executables")
        if "RAD_CFG_PATH" not in os.environ:
            raise InputError("RAD_CFG_PATH must name the folder hm_cfg_files of OpenRadioss")

    def elements(self, bench):
        """Physical stabilisation, viscous control, and eight points with one pressure."""
        return [Element("HEPH"), Element("viscous"), Element("H8C")]

    def run(self, deck, motion):
        folder, starter = deck.parent, Path(self.paths[0])
        name = deck.name.removesuffix("_0000.rad")
        done = self.clocked([starter, "-i", deck.name, "-np", "1", "-nt", "1"], folder)
        if done.code or not list(folder.glob(f"{name}_0000_*.rst")):
            self.fail(one_line(done.output + done.errors))
        done = self.clocked([self.paths[1], "-i", f"{name}_0001.rad", "-nt", "1"], folder)
        said = (folder / f"{name}_0001.out").read_text(errors="replace")
        answers = sorted(folder.glob(f"{name}A[0-9][0-9][0-9]"))
        # A motion that diverges ends early, but normally.
        broken = re.search(r"ZERO OR NEGATIVE VOLUME|TIME STEP LESS OR EQUAL", said + done.output)
        if broken or "NORMAL TERMINATION" not in said or not answers:
            self.fail(broken[0].lower() if broken else one_line(said))
        steps = re.findall(r"TOTAL NUMBER OF CYCLES *: *(\d+)", said)
        if not steps:
            raise InputError(f"{name}_0001.out: 'TOTAL NUMBER OF CYCLES' is required")
        return Run(done.seconds, done.processor_seconds, int(steps[-1]), 0, answers[-1])
