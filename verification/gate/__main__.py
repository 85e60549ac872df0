"""Compares the solver's accuracy and operations with what was last accepted.

Areas not given as files are run: SANDGLASS_BINARY, else build/release/sandglass.
Exit codes: 0 no regression, 1 a regression, 2 bad usage or input, 3 the solver failed.
"""

import datetime
import sys
from collections import Counter
from pathlib import Path

from common.command import command_line, option
from common.errors import InputError, suggestion
from common.files import write_whole
from common.program import binary, output_of
from common.records import entry

from . import baseline as baselines
from .figures import AREAS, BETTER, FAILING, NEW, VANISHED, WORSE, compare
from .figures import read_flops, read_verdicts

# The command that makes each file, and its reader. ci/verify reports broken limits of `verify`.
SOURCES = {
    "accuracy": (("verify", "--no-costs"), read_verdicts),
    "operations": (("flops",), read_flops),
}
ORIGIN = ("processor", "compiler", "build_flags")
MOST = 40  # figures listed for one verdict


def find(options):
    """(figures, revision, machine), from files or, without them, from the program."""
    figures, revision, machine = {}, None, None
    for area in options.areas:
        command, read = SOURCES[area]
        file = getattr(options, area)
        if file is None:
            print(f"gate: running for {area}", file=sys.stderr, flush=True)
            file = options.output / f"{area}.json"
            file.parent.mkdir(parents=True, exist_ok=True)
            output_of(binary(), *command, "--json", file, allowed=(0, 1))
        found, document = read(file)
        figures |= found
        revision = document.get("revision", revision)
        if "processor" in document:
            machine = "; ".join(entry(file, document, key, str) for key in ORIGIN)
    return figures, revision, machine


def table(outcomes):
    """The figures that changed, worst first, then their number by verdict."""
    rows = []
    for verdict in (WORSE, VANISHED, NEW, BETTER):
        listed = [outcome for outcome in outcomes if outcome.verdict == verdict]
        for o in listed[:MOST]:
            values = [
                "-" if v is None else f"{v:.6g}" if isinstance(v, float) else str(v)
                for v in (o.baseline, o.found)
            ]
            rows.append((verdict, o.area, o.name, o.figure, *values, o.reason))
        if len(listed) > MOST:
            rows.append((verdict, f"and {len(listed) - MOST} more", "", "", "", "", ""))
    if rows:
        rows.insert(0, ("verdict", "area", "what", "figure", "baseline", "found", ""))
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
    counts = Counter(outcome.verdict for outcome in outcomes)
    regressions = sum(counts[verdict] for verdict in FAILING)
    parts = [f"{len(outcomes)} figures", f"{regressions} regressions"]
    parts += [f"{counts[verdict]} {verdict}" for verdict in (NEW, BETTER) if counts[verdict]]
    lines.append(f"gate: {'FAILED' if regressions else 'passed'}: {', '.join(parts)}")
    return "\n".join(lines)


def gate(options):
    """Runs the gate; returns the exit code. Raises InputError or ComputationError."""
    for area in options.areas:
        if area not in AREAS:
            raise InputError(f"AREA: '{area}' is not known; {suggestion(area, AREAS)}")
    if options.accept and not (options.reason or "").strip():
        raise InputError("--accept: --reason TEXT is required: why is this the new baseline?")
    if options.reason and not options.accept:
        raise InputError("--reason: goes with --accept")
    options.areas = options.areas or list(AREAS)
    known = options.baseline.exists() or not options.accept
    baseline = baselines.read(options.baseline) if known else baselines.Baseline()
    figures, revision, machine = find(options)
    if options.accept:
        about = {"date": str(datetime.date.today()), "revision": revision}
        about["reason"] = options.reason.strip()
        changed = baselines.accept(baseline, figures, options.areas, machine, about)
        baselines.write(options.baseline, baseline)
        said = "; ".join(f"{area}: {what}" for area, what in changed.items())
        print(f"accepted in {options.baseline}: {said or 'nothing changed'}")
        return 0
    outcomes = compare(baseline.of(options.areas, machine), figures)
    text = table(outcomes)
    options.output.mkdir(parents=True, exist_ok=True)
    write_whole(options.output / "gate.txt", text + "\n")
    print(text)
    return 1 if any(outcome.verdict in FAILING for outcome in outcomes) else 0


BASELINE = "verification/gate/baseline.json"
main = command_line(
    gate,
    __doc__,
    option("areas", nargs="*", metavar="AREA", help=f"{', '.join(AREAS)}; all when left out"),
    option("--baseline", type=Path, default=BASELINE, help="default: %(default)s"),
    option("--verdicts", dest="accuracy", type=Path, help="of sandglass verify, not of a run"),
    option("--flops", dest="operations", type=Path, help="of sandglass flops, not of a run"),
    option("-o", "--output", type=Path, default="build/gate", help="folder (%(default)s)"),
    option("--accept", action="store_true", help="make what is found the baseline; needs --reason"),
    option("--reason", help="why, for the baseline's history"),
    prog="ci/gate",
)

if __name__ == "__main__":
    sys.exit(main())
