"""The goldens by a second program: in how many cases, to how many digits."""

from dataclasses import dataclass

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entries, entry


@dataclass(frozen=True)
class SecondGolden:
    """programs: their names. cases: how many were compared. largest: of the distances."""

    programs: str
    cases: int
    largest: float


def read_second_golden(path):
    """The SecondGolden of `reference/second_golden.py`'s file. Raises InputError."""
    found, programs = [], set()
    command = "reference/second_golden.py"
    for where, record in entries(path, read_json(path, command), "records"):
        if "reason" in record:
            continue
        found.append(entry(where, record, "distance", NUMBER))
        programs.add(entry(where, record, "program", str))
    if not found:
        raise InputError(f"{path}: has no distance; run {command}")
    return SecondGolden(", ".join(sorted(programs)), len(found), max(found))
