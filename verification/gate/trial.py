"""Tests the gate with regressions planted in a copy of the solver, and for false alarms.

Builds a copy of HEAD under build/gate-trial, and again with the patches of plants/; runs the gate
with each, against a baseline of the clean copy; writes the table between the marks in README.md.
What is already there is not built or run again; delete the folder to begin anew. An hour and more.
Exit codes: 0 done, 2 bad usage, 3 something did not build or run.
"""

import argparse
import os
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from common.command import exit_code
from common.errors import ComputationError
from common.files import write_whole
from common.program import ROOT

from . import collect
from .baseline import Baseline, accept
from .bench import read_bench
from .compare import NOISY, SAME, compare
from .records import Run, read_flops, read_verdicts

HERE = Path(__file__).resolve().parent
FOLDER = ROOT / "build" / "gate-trial"
MARKS = ("<!-- trial -->", "<!-- end of trial -->")
RUNS = 20
BASELINE_PROCESSES = 24


@dataclass(frozen=True)
class Plant:
    """A planted regression: description, binary, where it shows, what switches it on."""

    words: str
    binary: str
    source: str
    switches: tuple = ()


def slower(method, share):
    """The switches that slow the steps of a method by a share."""
    return (("SANDGLASS_PLANT_SLOWER", method), ("SANDGLASS_PLANT_SHARE", str(share)))


PLANTS = {
    "slow-tl-energy-sampling-0.03": Plant(
        "steps of tl-energy-sampling 3 % slower",
        "switched",
        "speed",
        slower("tl-energy-sampling", 0.03),
    ),
    "slow-tl-perturbation-0.03": Plant(
        "steps of tl-perturbation 3 % slower", "switched", "speed", slower("tl-perturbation", 0.03)
    ),
    "slow-all-0.03": Plant(
        "steps of all methods 3 % slower", "switched", "speed", slower("all", 0.03)
    ),
    "allocation": Plant(
        "a step of tl-full allocates",
        "switched",
        "speed",
        (("SANDGLASS_PLANT_ALLOCATION", "tl-full"),),
    ),
    "loss-1e-4": Plant(
        "displacements 1e-4 too small", "switched", "accuracy", (("SANDGLASS_PLANT_LOSS", "1e-4"),)
    ),
    "multiplication": Plant(
        "one more multiplication in an hourglass control", "multiplication", "operations"
    ),
}


@contextmanager
def program(binary, switches=()):
    """Has collect.py run a binary of the trial, with its switches on."""
    added = dict(switches) | {"SANDGLASS_BINARY": str(FOLDER / "bin" / binary)}
    before = dict(os.environ)
    os.environ.update(added)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def shell(*command, cwd):
    """The output of a command. Raises ComputationError with its last line."""
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True)
    if done.returncode:
        told = f"{done.stdout[-500:]}{done.stderr[-500:]}"
        raise ComputationError(
            f"`{' '.join(map(str, command))}` ended with {done.returncode}: {told}"
        )
    return done.stdout


def build(binary):
    """Builds the copy, with the patch of this name if it exists, and keeps its program.

    The patch of a header leaves its time of change alone, and only the source that counts is
    compiled anew: kernels in which nobody looks for the plant would take half an hour.
    """
    kept = FOLDER / "bin" / binary
    if kept.exists():
        return
    tree = FOLDER / "tree"
    if not tree.exists():
        shell("git", "worktree", "prune", cwd=ROOT)
        shell("git", "worktree", "add", "--detach", str(tree), "HEAD", cwd=ROOT)
    shell("git", "checkout", "-q", "solver", cwd=tree)
    patch = HERE / "plants" / f"{binary}.patch"
    if patch.exists():
        names = shell("git", "apply", "--numstat", str(patch), cwd=tree).split()[2::3]
        headers = {tree / name: os.stat(tree / name) for name in names if name.endswith(".hpp")}
        shell("git", "apply", str(patch), cwd=tree)
        for header, times in headers.items():
            os.utime(header, ns=(times.st_atime_ns, times.st_mtime_ns))
        if headers:
            (tree / "solver" / "model" / "operations.cpp").touch()
    shell("bash", "ci/build", "release", "sandglass_cli", cwd=tree)
    kept.parent.mkdir(parents=True, exist_ok=True)
    write_whole(
        FOLDER / "bin" / "revision", shell("git", "rev-parse", "--short=12", "HEAD", cwd=tree)
    )
    (tree / "build" / "release" / "sandglass").rename(kept)


def processes(name, binary, switches, first, last):
    """Files of processes of bench; existing ones are not run again."""
    pool = FOLDER / "pool"
    pool.mkdir(parents=True, exist_ok=True)
    files = []
    for number in range(first, last + 1):
        files.append(pool / f"{name}-{number}.json")
        if not files[-1].exists():
            with program(binary, switches):
                collect.bench(pool, files[-1].stem)
    return files


def speed_run(files):
    """The Run of files of bench."""
    records, machine, document = read_bench(files)
    return Run(records, document.get("revision"), machine)


def other_run(name, plant):
    """The Run of a verify or flops command, kept."""
    folder = FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    file, collected, read = {
        "accuracy": ("verdicts.json", collect.verdicts, read_verdicts),
        "operations": ("flops.json", collect.flops, read_flops),
    }[plant.source]
    if not (folder / file).exists():
        with program(plant.binary, plant.switches):
            collected(folder)
    records, document = read(folder / file)
    return Run(records, document.get("revision"))


def outcomes_of(baseline, name, plant):
    """The gate's outcome; it runs a third more processes before it fails on speed."""
    if plant.source != "speed":
        return compare(baseline, other_run(name, plant), [plant.source])
    for count in (collect.PROCESSES, collect.PROCESSES * 4 // 3):
        files = processes(name, plant.binary, plant.switches, 1, count)
        outcomes = compare(baseline, speed_run(files), ["forces", "memory", "speed"])
        if not any(outcome.area == "speed" and outcome.fails for outcome in outcomes):
            break
    return outcomes


def row(words, outcomes):
    """A row of the table: the regression, whether and where it was caught, other outcomes."""
    failing = [outcome for outcome in outcomes if outcome.fails]
    noisy = sum(outcome.verdict == NOISY for outcome in outcomes)
    first = f"`{failing[0].name}`, {failing[0].figure}: {failing[0].reason}" if failing else "-"
    caught = "yes" if failing else "no"
    return f"| {words} | {caught} | {len(failing)} of {len(outcomes)} | {noisy} | {first} |"


def baseline_of_the_clean():
    """A Baseline of the clean copy."""
    baseline = Baseline()
    clean = Plant("nothing", "clean", "speed")
    run = speed_run(processes("base", "clean", (), 1, BASELINE_PROCESSES))
    accept(baseline, run, ["forces", "memory", "speed"], "trial", "today")
    for source in ("accuracy", "operations"):
        run = other_run("clean", Plant(clean.words, clean.binary, source))
        accept(baseline, run, [source], "trial", "today")
    return baseline


def told(runs, again):
    """The text about runs without a planted regression."""
    alarms = sum(any(outcome.fails for outcome in outcomes) for outcomes in runs)
    noisy = sorted(sum(outcome.verdict == NOISY for outcome in outcomes) for outcomes in runs)
    moved = sum(outcome.verdict != SAME for outcome in again)
    ratios = sum(outcome.area == "speed" for outcome in runs[0])
    return (
        f"Nothing planted: {alarms} of {RUNS} runs raise a false alarm. Of the {ratios} ratios of "
        f"a run {noisy[RUNS // 2]} in the median and {noisy[-1]} at most were too noisy to tell "
        f"from {collect.PROCESSES} processes. Accuracy run again: {moved} of {len(again)} figures "
        f"move by more than they may."
    )


def origin(baseline):
    """The line on the table's making."""
    revision = (FOLDER / "bin" / "revision").read_text().strip()
    load = f"{os.getloadavg()[2]:.0f} programs wanted its {os.cpu_count()} processors"
    machines = ", ".join(baseline.machines)
    return f"Made by `ci/gate-trial` at revision {revision}, while {load}: {machines}."


def trial():
    """Runs the trial and returns the text of the table."""
    for binary in ("clean", "switched", "multiplication"):
        build(binary)
    baseline = baseline_of_the_clean()
    rows = [
        "| planted | caught | figures that fail | too noisy to tell | the first of them |",
        "|---|---|---|---|---|",
    ]
    rows += [row(plant.words, outcomes_of(baseline, name, plant)) for name, plant in PLANTS.items()]
    clean = Plant("nothing", "clean", "speed")
    runs = [outcomes_of(baseline, f"run-{number}", clean) for number in range(1, RUNS + 1)]
    again = outcomes_of(baseline, "again", Plant("nothing", "clean", "accuracy"))
    rows += ["", told(runs, again), "", origin(baseline)]
    return "\n".join(rows)


def tabulate():
    """Writes the table into README.md, and prints it. Raises InputError or ComputationError."""
    readme = HERE / "README.md"
    table = trial()
    before, after = readme.read_text(encoding="utf-8").split(MARKS[0])
    after = after.split(MARKS[1])[1]
    write_whole(readme, f"{before}{MARKS[0]}\n{table}\n{MARKS[1]}{after}")
    print(table)


def main(given=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(prog="ci/gate-trial", description=__doc__.splitlines()[0])
    parser.parse_args(given)
    return exit_code(tabulate)


if __name__ == "__main__":
    sys.exit(main())
