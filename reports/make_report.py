"""Makes the report page from verdicts, results, references and other measurements.

Usage: /usr/bin/python3 reports/make_report.py [OPTIONS] [-o FILE]; --help lists the inputs.
Verdicts, results, cases and references are required; if another input is missing, the page names
the command that makes it.
Exit codes: 0 done, 2 an input is missing, broken or does not belong to the others.
"""

import argparse
import sys
import time
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import exit_code
from sandglass_report.evidence import read_evidence
from sandglass_report.growth import growth_plate, read_growth
from sandglass_report.verdicts import read_verdicts
from sandglass_report.measured import read_measured
from sandglass_report.page import Inputs, write_report
from sandglass_report.refinement import read_refinement, refinement_plate
from sandglass_report.second import read_second_program
from sandglass_report.submissions import read_submissions
from sandglass_report.subject import read_subjects


def make(options):
    """Reads all inputs and writes the page. Raises InputError."""
    start = time.monotonic()
    verdicts = read_verdicts(options.verdicts)
    subjects = read_subjects(
        verdicts, options.cases, options.reference, options.results, options.case
    )
    files = options.bench, options.flops, options.curves, options.maps, options.kept_maps
    found = read_measured(*files)
    evidence = read_evidence(options.claims, options.mutants, options.root, verdicts.limits)
    pictures = tuple(sorted(options.pictures.glob("stability.*.png")))
    growth = growth_plate(read_growth(options.growth)) if options.growth.exists() else None
    second_path = options.reference / "second_program.json"
    second = read_second_program(second_path) if second_path.exists() else {}
    refined = options.refinement
    inputs = Inputs(
        verdicts,
        options.verdicts,
        subjects,
        found,
        evidence,
        pictures,
        growth=growth,
        refinement=refinement_plate(read_refinement(refined)) if refined.exists() else None,
        second=second,
        submissions=tuple(read_submissions(options.submissions)),
    )
    size = write_report(inputs, options.output)
    seconds = time.monotonic() - start
    print(f"{options.output}: {size / 1e6:.1f} MB, made in {seconds:.0f} s")


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add = parser.add_argument
    add("--verdicts", type=Path, default="build/verdicts.json", help="of sandglass verify --json")
    add("--results", type=Path, default="build/verify", help="of sandglass verify --results")
    add("--cases", type=Path, default="cases", help="folder of case files")
    add(
        "--case",
        type=Path,
        nargs="+",
        default=[],
        help="case files in addition to those of the folder",
    )
    add("--reference", type=Path, default="reference", help="folder with golden/ and truth/")
    add("--bench", type=Path, default="build/bench.json", help="of sandglass bench --json")
    add("--flops", type=Path, default="build/flops.json", help="of sandglass flops --json")
    add("--curves", type=Path, default="build/curves", help="folder of sandglass choose --json")
    add("--maps", type=Path, default="build/stability", help="folder of sandglass stability --json")
    add("--kept-maps", type=Path, default="reports/maps", help="folder of reports/keep_maps.py")
    add("--pictures", type=Path, default="reports/figures", help="folder of drawn failure maps")
    add("--growth", type=Path, default="reports/figures/growth.json", help="of bench/growth.py")
    add(
        "--refinement",
        type=Path,
        default="reports/figures/refinement.json",
        help="of bench/refinement.py",
    )
    add("--submissions", type=Path, default="results", help="folder of submitted results")
    add("--claims", type=Path, default="verification/claims.toml", help="claims and their tests")
    add(
        "--mutants",
        type=Path,
        default="verification/mutants/RESULTS.md",
        help="of verification/mutants/run.py",
    )
    add("--root", type=Path, default=".", help="of the tree that the claims' tests are in")
    add("-o", "--output", type=Path, default="build/report/index.html", help="the page to write")
    return exit_code(make, parser.parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
