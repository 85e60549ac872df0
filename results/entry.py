"""An entry of results/: the errors of a program's displacements on a case, and their cost.

The displacements are stored beside it under the hash of their file, so that anyone can score them
again: errors are checked, times are as submitted.
"""

import hashlib
import json
import tempfile
from dataclasses import dataclass
from pathlib import Path

import h5py

from common.errors import InputError
from common.files import read_json
from common.program import ROOT, binary, output_of
from common.result_file import text_of
from exchange.convert import match_displacement

FOLDER = ROOT / "results"
FIGURES = {"max": "max_relative_error", "rms": "rms_relative_error"}
PROFILE = "profile_relative_error"
# Scoring again repeats the same arithmetic; another compiler may only sum in another order.
SAME = 1e-9


def schema():
    """The published JSON Schema, a dict."""
    return json.loads((FOLDER / "schema.json").read_text(encoding="utf-8"))


def entry_files(folder=FOLDER):
    """The paths of all entries in a folder, in order of their names."""
    return sorted(path for path in folder.glob("*.json") if path.name != "schema.json")


def read_entry(path):
    """The entry in a file, a valid dict. Raises InputError naming key and rule."""
    found = read_json(path)
    require_valid(path, found)
    return found


def require_valid(path, entry):
    """Raises InputError unless an entry conforms to the schema. path: for the message."""
    import jsonschema  # only needed here; package python3-jsonschema

    broken = sorted(jsonschema.Draft7Validator(schema()).iter_errors(entry), key=str)
    if broken:
        place = ".".join(map(str, broken[0].absolute_path)) or "entry"
        raise InputError(f"{path}: {place}: {broken[0].message}")


def displacement_file(entry, folder=FOLDER):
    """The path of an entry's displacements."""
    return folder / "displacements" / f"{entry['displacement']}.h5"


def hash_of(content):
    """SHA-256 of bytes, in hexadecimal digits."""
    return hashlib.sha256(content).hexdigest()


@dataclass(frozen=True)
class Score:
    """The score of a file of displacements.

    case: its name. mesh_hash: of the case's mesh. errors: as in an entry. displacement: the bytes
    of the file that stores the displacements in the order of the case's nodes.
    """

    case: str
    mesh_hash: str
    errors: dict
    displacement: bytes


def scored(case, answer):
    """The Score of a file of displacements, by `sandglass score`.

    case: name or file of a case. Raises InputError and ComputationError.
    """
    with tempfile.TemporaryDirectory() as name:
        score, mesh, matched = (Path(name) / file for file in ("s.json", "mesh.h5", "u.h5"))
        output_of(binary(), "score", answer, "--case", case, "--json", score, allowed=(0, 1))
        record = read_json(score)["records"][0]
        output_of(binary(), "mesh", case, "-o", mesh)
        match_displacement(Path(answer), mesh, matched)
        with h5py.File(mesh) as file:
            mesh_hash = text_of(file.attrs["mesh_hash"])
        displacement = matched.read_bytes()
    errors = {}
    for name in ("golden", "truth"):
        if found := record.get(name):
            errors[name] = {figure: found[key] for figure, key in FIGURES.items()}
            if found.get(PROFILE) is not None:
                errors[name]["profile"] = found[PROFILE]
    if not errors:
        raise InputError(f"case {case}: has neither golden nor truth to compare with")
    return Score(record["case"], mesh_hash, errors, displacement)


def check(path):
    """Scores an entry again. Raises InputError unless it matches its displacements."""
    entry = read_entry(path)
    stored = displacement_file(entry, path.parent)
    if not stored.is_file():
        raise InputError(f"{path}: displacement: {stored.name} is not in displacements/")
    if hash_of(stored.read_bytes()) != entry["displacement"]:
        raise InputError(f"{path}: displacement: {stored.name} has another SHA-256: it was changed")
    score = scored(entry["case"], stored)
    if score.mesh_hash != entry["mesh_hash"]:
        raise InputError(f"{path}: mesh_hash: the mesh of {entry['case']} is {score.mesh_hash}")
    if set(score.errors) != set(entry["errors"]):
        raise InputError(f"{path}: errors: those to {', '.join(sorted(score.errors))} are required")
    for reference, figures in score.errors.items():
        for figure, value in figures.items():
            kept = entry["errors"][reference].get(figure)
            if kept is None or abs(kept - value) > SAME * max(1.0, abs(value)):
                raise InputError(
                    f"{path}: errors.{reference}.{figure} = {kept}: its displacements score {value}"
                )
