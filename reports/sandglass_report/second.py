"""Goldens and truths checked by a second program: the number of cases and the distances."""

from dataclasses import dataclass

from common.errors import InputError
from common.files import read_json
from common.records import NUMBER, entries, entry


@dataclass(frozen=True)
class SecondProgram:
    """programs: their names. cases: how many were compared. largest: of the distances."""

    programs: str
    cases: int
    largest: float


def read_second_program(path):
    """kind ("golden", "truth") -> SecondProgram, of `reference/second_program.py`'s file.

    Raises InputError.
    """
    distances, programs = {}, {}
    command = "reference/second_program.py"
    for where, record in entries(path, read_json(path, command), "records"):
        kind = entry(where, record, "kind", str)
        distances.setdefault(kind, []).append(entry(where, record, "distance", NUMBER))
        programs.setdefault(kind, set()).add(entry(where, record, "program", str))
    if not distances:
        raise InputError(f"{path}: has no distance; run {command}")
    return {
        kind: SecondProgram(" and ".join(sorted(programs[kind])), len(found), max(found))
        for kind, found in distances.items()
    }
