"""Makes the report page from verdicts, results, references and other measurements.

Usage: /usr/bin/python3 reports/make_report.py [OPTIONS] [-o FILE]; --help lists the inputs.
Verdicts, results, cases and references are required; if another input is missing, the page names
the command that makes it.
Exit codes: 0 done, 2 an input is missing, broken or does not belong to the others.
"""

import sys
import time
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from common.command import command_line, option
from sandglass_report.evidence import read_evidence
from sandglass_report.contact import read_contact
from sandglass_report.identified import read_identified
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
        identified=read_identified(options.identified) if options.identified.exists() else (),
        contact=tuple(read_contact(options.contact)) if options.contact.exists() else (),
        second=second,
        submissions=tuple(read_submissions(options.submissions)),
    )
    size = write_report(inputs, options.output)
    seconds = time.monotonic() - start
    print(f"{options.output}: {size / 1e6:.1f} MB, made in {seconds:.0f} s")


# Input -> its default place, and the command that makes it.
INPUTS = {
    "verdicts": ("build/verdicts.json", "of sandglass verify --json"),
    "results": ("build/verify", "of sandglass verify --results"),
    "cases": ("cases", "folder of case files"),
    "reference": ("reference", "folder with golden/ and truth/"),
    "bench": ("build/bench.json", "of sandglass bench --json"),
    "flops": ("build/flops.json", "of sandglass flops --json"),
    "curves": ("build/curves", "folder of sandglass choose --json"),
    "maps": ("build/stability", "folder of sandglass stability --json"),
    "kept-maps": ("reports/maps", "folder of reports/keep_maps.py"),
    "pictures": ("reports/figures", "folder of drawn failure maps"),
    "growth": ("reports/figures/growth.json", "of bench/growth.py"),
    "refinement": ("reports/figures/refinement.json", "of bench/refinement.py"),
    "identified": (
        "reports/figures/identified_stiffness.json",
        "of bench/identified_stiffness.py",
    ),
    "contact": ("reports/figures/contact_cost.json", "of bench/contact_cost.py"),
    "submissions": ("results", "folder of submitted results"),
    "claims": ("verification/claims.toml", "claims and their tests"),
    "mutants": ("verification/mutants/RESULTS.md", "of verification/mutants/run.py"),
    "root": (".", "of the tree that the claims' tests are in"),
}
main = command_line(
    make,
    __doc__,
    *(
        option(f"--{name}", type=Path, default=place, help=f"{made}; default: {place}")
        for name, (place, made) in INPUTS.items()
    ),
    option("--case", type=Path, nargs="+", default=[], help="case files beside those of --cases"),
    option("-o", "--output", type=Path, default="build/report/index.html", help="the page"),
)


if __name__ == "__main__":
    sys.exit(main())
