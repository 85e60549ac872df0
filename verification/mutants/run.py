"""Mutation tests: does a test fail for every mistake?

Applies each patch of this folder to a copy of HEAD, builds it and tests it until the first failure.
Prints what killed each mutant and writes RESULTS.md. Finished mutants are stored under
build/mutant-results and not run again while patch and tree are the same. With --random, the
mistakes are planted at random in the lines of a change instead.
Exit codes: 0 all killed or proven equivalent, 1 some survived, 2 bad usage, 3 interrupted, or a
mutant without a verdict.
"""

import datetime
import hashlib
import signal
import sys
import tempfile
import threading
import time
from pathlib import Path

if __name__ == "__main__":
    ROOT_OF_ALL = Path(__file__).resolve().parents[2]
    sys.path[1:1] = [str(ROOT_OF_ALL), str(ROOT_OF_ALL / "ci")]

import outcomes
from common.command import command_line, option
from common.errors import InputError
from common.program import ROOT
from patches import read_patch, read_patches
from plant import git, plant
from worker import OutOfTime, Stopped, Worker, programs_of


def tree_digest():
    """Of all files of HEAD that can affect a verdict: no texts, no mutants."""
    lines = [
        line
        for line in git(ROOT, "ls-tree", "-r", "HEAD").splitlines()
        if "\tverification/mutants/" not in line and not line.endswith(".md")
    ]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def result_of(worker, patch, timeout):
    """(verdict, the test or the compiler's error) of one mutant."""
    try:
        failure = worker.first_failure(patch, timeout)
    except OutOfTime as error:
        return "no verdict", str(error)
    if not failure:
        return "equivalent" if patch.equivalent else "survived", ""
    # A test that hangs would be noticed as well.
    hangs = failure.kind == "timeout"
    return "killed" if hangs else failure.kind, failure.by + (" (timeout)" if hangs else "")


def is_finished(patch, tree):
    """Whether this patch has a verdict on this tree."""
    result = outcomes.stored(patch.name)
    if result is None or result["verdict"] not in ("killed", "survived", "equivalent"):
        return False
    return (result["patch"], result["tree"]) == (patch.digest, tree)


def chosen_patches(names):
    """The patches whose names begin with one of the given names, or all. Raises InputError."""
    patches = read_patches()
    for name in names:
        if not any(patch.name.startswith(name) for patch in patches):
            raise InputError(f"NAME: no mutant begins with '{name}' in verification/mutants")
    return [patch for patch in patches if patch.name.startswith(tuple(names) or "")]


def run_patches(options, stop):
    """Runs the patches of this folder; returns their verdicts. Raises InputError."""
    patches = chosen_patches(options.names)
    tree, revision = tree_digest(), git(ROOT, "rev-parse", "--short=12", "HEAD").strip()
    todo = [] if options.table else [one for one in patches if not is_finished(one, tree)]
    if todo:
        with Worker(revision, stop, options.jobs) as worker:
            for patch in todo:
                started = time.monotonic()
                verdict, by = result_of(worker, patch, options.timeout)
                seconds = time.monotonic() - started
                print(f"{verdict:<10} {patch.name:<44} {seconds:5.0f} s  {by}", flush=True)
                result = {"patch": patch.digest, "tree": tree, "verdict": verdict, "by": by}
                result |= {"seconds": seconds, "revision": revision}
                outcomes.store(patch.name, result | {"date": str(datetime.date.today())})
    rows = outcomes.write_table(read_patches(), revision)
    names = {patch.name for patch in patches}
    return [row[2] for row in rows if row[0] in names]


def run_random(options, stop):
    """Plants mistakes at random in the lines of a change; returns their verdicts."""
    planted = plant(ROOT, options.since, options.random, options.seed, options.files)
    if not planted:
        raise InputError(f"--since {options.since}: no lines of C++ were added in these files")
    for name in options.tests:
        known = [program.name for program in programs_of(ROOT)]
        if name not in known:
            raise InputError(f"--tests {name}: allowed are {', '.join(known)}")
    verdicts, sources_only = [], all(mistake.file.endswith(".cpp") for mistake in planted)
    worker = Worker("HEAD", stop, options.jobs, options.tests, sources_only)
    with tempfile.TemporaryDirectory() as folder, worker:
        for number, (mistake, text) in enumerate(planted.items(), start=1):
            path = Path(folder) / f"{number:03}-{mistake.kind}.patch"
            path.write_text(mistake.patch(text), encoding="utf-8")
            verdict, by = result_of(worker, read_patch(path), options.timeout)
            verdict = {"killed": "noticed", "broken": "does not compile"}.get(verdict, verdict)
            verdicts.append(verdict)
            lines = [f"- {line.strip()}" for line in mistake.before]
            lines += [f"+ {line.strip()}" for line in mistake.after]
            head = f"{mistake.file}:{mistake.line}, {mistake.kind}: {verdict}"
            head += f" by {by}" if verdict in ("noticed", "false alarm") else ""
            print(head, *lines, sep="\n    ", flush=True)
    noticed, survived = verdicts.count("noticed"), verdicts.count("survived")
    if noticed + survived:
        share = 100 * noticed / (noticed + survived)
        print(f"noticed: {noticed} of {noticed + survived} that compile, {share:.0f} %")
    return verdicts


def run(options, stop):
    """Runs the mutants; returns the exit code. Raises InputError."""
    try:
        verdicts = (run_random if options.random else run_patches)(options, stop)
    except Stopped:
        return 3
    for verdict in sorted(set(verdicts)):
        print(f"{verdicts.count(verdict):4} {verdict}")
    if {"broken", "no verdict", "not run", "false alarm"} & set(verdicts):
        return 3
    return 1 if "survived" in verdicts else 0


def run_until_interrupted(options):
    """Runs the mutants until they finish or a signal arrives; returns the exit code."""
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    return run(options, stop)


main = command_line(
    run_until_interrupted,
    __doc__,
    option("names", nargs="*", metavar="NAME", help="mutants, or how their names begin: 017"),
    option("--random", type=int, default=0, metavar="N", help="plant N mistakes at random instead"),
    option("--seed", type=int, default=1, help="of --random (default 1)"),
    option("--since", default="HEAD~1", metavar="REV", help="of --random: what changed (HEAD~1)"),
    option("--files", nargs="+", default=["*"], metavar="GLOB", help="of --random: 'solver/*.cpp'"),
    option("--tests", nargs="+", default=[], metavar="NAME", help="of --random: these, not all"),
    option("--jobs", type=int, default=1, help="compilers side by side (default 1)"),
    option("--timeout", type=float, default=1800, help="s of tests for each mutant (1800)"),
    option("--table", action="store_true", help="write RESULTS.md, and run nothing"),
)


if __name__ == "__main__":
    sys.exit(main())
