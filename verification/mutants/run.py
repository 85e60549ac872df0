"""Mutation tests: does a test fail for every plausible mistake?

Each patch of this folder is applied to a copy of HEAD, built and tested until the first failure.
Prints what killed each mutant and writes RESULTS.md. Finished mutants are kept under
build/mutant-results and not run again while patch and tree are the same.
Exit codes: 0 all killed or proven equivalent, 1 some survived or a clean tree failed, 2 bad usage,
3 interrupted or a mutant that does not build.
"""

import argparse
import datetime
import hashlib
import queue
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent.parent))

import outcomes
from clean_runs import CleanRuns
from common.command import exit_code
from common.errors import InputError
from common.program import ROOT
from patches import read_patches
from worker import OutOfTime, Stopped, Worker


def git(*arguments):
    """The output of a git command in the checkout."""
    command = ["git", "-C", str(ROOT), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def tree_digest():
    """Of all files of HEAD that can decide a verdict: not of texts, nor of the mutants."""
    lines = [
        line
        for line in git("ls-tree", "-r", "HEAD").splitlines()
        if "\tverification/mutants/" not in line and not line.endswith(".md")
    ]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def result_of(worker, patch, programs, timeout):
    """The result of one mutant, as stored."""
    started = time.monotonic()
    result = {"patch": patch.digest, "by": "", "program": ""}
    try:
        failure = worker.first_failure(patch, programs, timeout)
    except OutOfTime as error:
        result |= {"verdict": "no verdict", "by": str(error)}
    else:
        result["verdict"] = "equivalent" if patch.equivalent else "survived"
        if failure:
            # A test that hangs would also be noticed.
            hangs = failure.kind == "timeout"
            result["verdict"] = "killed" if hangs else failure.kind
            result["by"] = failure.by + (" (timeout)" if hangs else "")
            result["program"] = failure.program
    return result | {"seconds": time.monotonic() - started}


def work(worker, todo, options, tree, revision):
    """Takes mutants from a queue until it is empty."""
    programs = worker.programs()
    seconds = outcomes.stored(outcomes.CLEAN)["seconds"]
    while True:
        try:
            patch = todo.get_nowait()
        except queue.Empty:
            return
        killers = outcomes.killers()
        for program in programs:
            program.seconds, program.kills = seconds[program.name], killers[program.name]
        programs.sort(key=lambda program: program.cost())
        result = result_of(worker, patch, programs, options.timeout)
        result |= {"tree": tree, "revision": revision, "date": str(datetime.date.today())}
        outcomes.store(patch.name, result)
        told = f"{patch.name:<44} {result['seconds']:5.0f} s  {result['by']}"
        print(f"{result['verdict']:<10} {told}", flush=True)


def is_finished(patch, tree):
    """Whether this patch has a verdict on this tree."""
    result = outcomes.stored(patch.name)
    wanted = (patch.digest, tree)
    if result is None or result["verdict"] in ("broken", "no verdict"):
        return False
    return (result["patch"], result["tree"]) == wanted


def chosen_patches(names):
    """The patches whose names begin with one of the given names, or all. Raises InputError.

    The name of the clean tree is not of a patch: alone, it asks for the clean runs only.
    """
    patches = read_patches()
    if not names:
        return patches
    names = [name for name in names if name != outcomes.CLEAN]
    for name in names:
        if not any(patch.name.startswith(name) for patch in patches):
            raise InputError(f"NAME: no mutant begins with '{name}' in verification/mutants")
    return [patch for patch in patches if patch.name.startswith(tuple(names))]


def conclude(verdicts, stopped):
    """Prints the number of mutants per verdict; returns the exit code."""
    for verdict in sorted(set(verdicts)):
        print(f"{verdicts.count(verdict):4} {verdict}")
    if stopped or {"broken", "no verdict", "not run"} & set(verdicts):
        return 3
    return 1 if "survived" in verdicts else 0


def run(options, stop):
    """Runs the mutants; returns the exit code. Raises InputError."""
    patches = chosen_patches(options.names)
    names = {patch.name for patch in patches}
    tree, revision = tree_digest(), git("rev-parse", "--short=12", "HEAD").strip()
    if options.table:
        rows = outcomes.write_table(read_patches(), revision)
        return conclude([row[2] for row in rows if row[0] in names], False)
    todo = queue.Queue()
    for patch in patches:
        if not is_finished(patch, tree):
            todo.put(patch)
    errors = []

    clean = CleanRuns(max(1, options.clean), tree, revision)

    def one_worker():
        try:
            with Worker(revision, stop) as worker:
                clean.work(worker)
                while not clean.is_done():
                    if stop.wait(0.2):
                        return
                clean.conclude()
                work(worker, todo, options, tree, revision)
        except Stopped:
            pass
        except Exception as error:  # the other workers end, and the error is reported
            errors.append(error)
            stop.set()

    count = min(max(1, options.jobs), todo.qsize() + clean.missing())
    threads = [threading.Thread(target=one_worker) for n in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    rows = outcomes.write_table(read_patches(), revision)
    for error in errors:
        print(f"error: {error}", file=sys.stderr)
    if errors:
        return 1
    return conclude([row[2] for row in rows if row[0] in names], stop.is_set())


def main():
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="verification/mutants/run.py",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "names",
        nargs="*",
        metavar="NAME",
        help="mutants, or how they begin: 017; 'clean': the clean tree, and no mutant by itself",
    )
    parser.add_argument("--jobs", type=int, default=1, help="copies side by side (default 1)")
    parser.add_argument("--timeout", type=float, default=1800, help="s for each mutant (1800)")
    parser.add_argument("--clean", type=int, default=1, help="runs of the clean tree first (1)")
    parser.add_argument("--table", action="store_true", help="write RESULTS.md, and run nothing")
    options = parser.parse_args()
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    return exit_code(run, options, stop)


if __name__ == "__main__":
    sys.exit(main())
