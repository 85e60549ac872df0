"""What the project claims, what tests it, by which oracle; which planted mistakes are noticed."""

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
    """A sentence of the project, and what it rests on."""

    says: str
    oracle: str  # what knows the right answer
    tests: tuple  # paths of files below the root of the tree
    figure: str  # section of the page that shows it, or ""
    limits: tuple = ()  # Limits of the verdicts that measure it
    noticed: int = 0  # planted mistakes that these tests noticed


@dataclass(frozen=True)
class Mutant:
    """A planted mistake and what became of it."""

    name: str
    mistake: str
    verdict: str  # killed, survived, not run
    by: str  # the first test that failed, or ""
    file: str  # of that test, or ""
    revision: str


@dataclass(frozen=True)
class Evidence:
    """All of the section; `made` is the line of the mutants' table that says when and how."""

    claims: tuple = ()
    mutants: tuple = ()
    made: str = ""

    def worst_first(self):
        """The mutants: those that no test noticed, those that were not run, and the rest."""
        order = {"survived": 0, "not run": 1}
        return sorted(self.mutants, key=lambda mutant: order.get(mutant.verdict, 2))

    def count(self, verdict):
        """How many mutants have a verdict."""
        return sum(m.verdict == verdict for m in self.mutants)


def read_evidence(claims, mutants, root, limits):
    """Evidence from a TOML file of claims and the table of mutants; each may be absent.

    root: of the tree, where the tests are. limits: of the verdicts. Raises InputError when a file
    is broken, or when a claim names a test or a limit that is not there.
    """
    files = _files_of_suites(Path(root))
    made, found = _read_mutants(Path(mutants), files)
    return Evidence(_read_claims(Path(claims), Path(root), limits, found), found, made)


def _read_claims(path, root, limits, mutants):
    """The claims of a file; none without it."""
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
            raise InputError(f"{where}: {says!r}: there is no test {test}")
    return Claim(
        says,
        entry(where, table, "oracle", str),
        tests,
        table.get("figure", ""),
        tuple(_limit(where, says, words, limits) for words in table.get("limits", [])),
        sum(m.verdict == "killed" and m.file in tests for m in mutants),
    )


def _limit(where, says, words, limits):
    """The limit "CASE METHOD KAPPA FIGURE" of the verdicts; None where the case was not run."""
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
    """(the line that says how it was made, mutants) of the table; nothing without a file."""
    if not path.is_file():
        return "", ()
    lines = path.read_text(encoding="utf-8").splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if "|" in line]
    if not rows or tuple(rows[0]) != COLUMNS or any(len(row) != len(COLUMNS) for row in rows):
        raise InputError(f"{path}: not the table of verification/mutants/run.py: its columns must be {COLUMNS}")
    made = next((line for line in lines if line.startswith("Made by")), "")
    return made, tuple(_mutant(row, files) for row in rows[2:])


def _mutant(row, files):
    name, mistake, verdict, by, _, revision = ("" if cell == "-" else cell for cell in row)
    file = by.split("::")[0]
    if "::" not in by:
        parts = by.split(".")[0].split("/")
        file = next((files[part] for part in parts if part in files), "")
    return Mutant(name, mistake, verdict, by, file, revision)
