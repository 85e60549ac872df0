"""The project's claims with their tests and oracles, and the detection of planted mistakes."""

import re
from dataclasses import dataclass
from pathlib import Path

from common.errors import InputError
from common.files import read_toml
from common.records import entries, entry

SUITE = re.compile(r"^(?:TYPED_)?TEST\w*\(\s*(\w+)", re.MULTILINE)
COLUMNS = ("mutant", "mistake", "verdict", "by", "s", "revision")


@dataclass(frozen=True)
class Claim:
    """A claim of the project, and its evidence."""

    says: str
    oracle: str  # the source of the right answer
    tests: tuple  # paths of files below the root of the tree
    figure: str  # section of the page that shows it, or ""
    limits: tuple = ()  # Limits of the verdicts that measure it
    noticed: int = 0  # planted mistakes that these tests detected first


@dataclass(frozen=True)
class Mutant:
    """A planted mistake and its outcome."""

    name: str
    mistake: str
    verdict: str  # killed, survived, not run
    by: str  # the first test that failed, or ""
    file: str  # of that test, or ""
    revision: str


@dataclass(frozen=True)
class Evidence:
    """The data of the section; `made` is the line of the mutants' table on its making."""

    claims: tuple = ()
    mutants: tuple = ()
    made: str = ""

    def worst_first(self):
        """The mutants: first those that no test detected, then those not run, then the rest."""
        order = {"survived": 0, "not run": 1}
        return sorted(self.mutants, key=lambda mutant: order.get(mutant.verdict, 2))

    def count(self, verdict):
        """How many mutants have a verdict."""
        return sum(m.verdict == verdict for m in self.mutants)


def read_evidence(claims, mutants, root, limits):
    """Evidence from a TOML file of claims and the table of mutants; each may be absent.

    root: of the tree that contains the tests. limits: of the verdicts. Raises InputError if a file
    is broken or a claim names a test or a limit that does not exist.
    """
    files = _files_of_suites(Path(root))
    made, found = _read_mutants(Path(mutants), files)
    return Evidence(_read_claims(Path(claims), Path(root), limits, found), found, made)


def _read_claims(path, root, limits, mutants):
    """The claims of a file; none if it is missing."""
    if not path.is_file():
        return ()
    found = read_toml(path)
    return tuple(
        _claim(where, table, root, limits, mutants)
        for where, table in (entries(path, found, "claim") if "claim" in found else ())
    )


def _claim(where, table, root, limits, mutants):
    """A checked [[claim]] table as a Claim."""
    says, tests = entry(where, table, "says", str), tuple(entry(where, table, "tests", list))
    for test in tests:
        if not (root / test).is_file():
            raise InputError(f"{where}: {says!r}: test {test} does not exist")
    return Claim(
        says,
        entry(where, table, "oracle", str),
        tests,
        table.get("figure", ""),
        tuple(_limit(where, says, words, limits) for words in table.get("limits", [])),
        sum(m.verdict == "killed" and m.file in tests for m in mutants),
    )


def _limit(where, says, words, limits):
    """The limit "CASE METHOD KAPPA FIGURE" of the verdicts; None if the case was not run."""
    case, method, kappa, figure = (words.split() + [""] * 4)[:4]
    of_case = [limit for limit in limits if limit.case == case]
    for limit in of_case:
        if (limit.method, limit.kappa, limit.figure) == (method, kappa, figure):
            return limit
    if of_case:
        raise InputError(f"{where}: {says!r}: the verdicts have no limit {words!r}")
    return None


def _files_of_suites(root):
    """Name of a GoogleTest suite -> path of its file."""
    found = {}
    for path in sorted((root / "verification").rglob("*_test.cpp")):
        for suite in SUITE.findall(path.read_text(encoding="utf-8")):
            found.setdefault(suite, path.relative_to(root).as_posix())
    return found


def _read_mutants(path, files):
    """(the line on its making, mutants) of the table; empty if the file is missing."""
    if not path.is_file():
        return "", ()
    lines = path.read_text(encoding="utf-8").splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if "|" in line]
    if not rows or tuple(rows[0]) != COLUMNS or any(len(row) != len(COLUMNS) for row in rows):
        raise InputError(
            f"{path}: not the table of verification/mutants/run.py: its columns must be {COLUMNS}"
        )
    made = next((line for line in lines if line.startswith("Made by")), "")
    return made, tuple(_mutant(row, files) for row in rows[2:])


def _mutant(row, files):
    name, mistake, verdict, by, _, revision = ("" if cell == "-" else cell for cell in row)
    file = by.split("::")[0]
    if "::" not in by:
        parts = by.split(".")[0].split("/")
        file = next((files[part] for part in parts if part in files), "")
    return Mutant(name, mistake, verdict, by, file, revision)
