"""One case with all its data: mesh, references, runs and their displacements."""

from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

from common.errors import InputError
from common.case_tables import read_tables
from common.result_file import text_of
from sandglass_report.accuracy import accuracy, ordered_profile
from sandglass_report.verdicts import REFERENCES

# verdicts.json and a recomputation differ only by rounding of the square root; see the tests.
AGREEMENT = 1e-9
HOURGLASS = "hourglass_energy_density"


@dataclass(frozen=True)
class Reference:
    """A stored answer: displacement (n, 3) in m, and the attributes of its file."""

    displacement: np.ndarray
    attributes: dict


@dataclass(frozen=True)
class MotionGolden:
    """The golden of a motion at its largest displacement, and the file's attributes."""

    displacement: np.ndarray  # (n, 3), m, at `time`
    time: float  # s
    attributes: dict


@dataclass(frozen=True)
class Subject:
    """A case, its mesh (None if no run has a result file), its references and its runs."""

    name: str
    requirement: str
    unit: float  # largest imposed displacement, m; 0 if loads alone move the body
    imposed: tuple  # (set name, value in m; of a rotation its axis times the angle in degrees)
    profile_set: str | None
    profile_order: str | None
    runs: tuple
    points: np.ndarray | None = None  # (n, 3), m
    cells: np.ndarray | None = None  # (m, 8), VTK order
    sets: dict = field(default_factory=dict)
    golden: Reference | None = None
    truth: Reference | None = None
    motion: MotionGolden | None = None  # of a case in motion, which has no single golden field
    displacements: dict = field(default_factory=dict)  # (method, kappa or None) -> (n, 3), m
    hourglass: dict = field(default_factory=dict)  # the same -> energy density (m,), J/m^3
    hashes: dict = field(default_factory=dict)  # of the case and its mesh, as the results have them

    def main_run(self, method):
        """The run of a method with its default settings (kappa auto, if it has one), or None."""
        return next((r for r in self.runs if r.method == method and r.is_main), None)

    def displacement(self, method):
        """Displacements (n, 3), m, of a method's main run, or None if there are none."""
        return self.displacements.get((method, None))

    def profile(self):
        """(nodes in order along the profile line, coordinate), or None; see ordered_profile."""
        if self.points is None or self.profile_set is None:
            return None
        return ordered_profile(self.points, self.sets[self.profile_set], self.profile_order)

    def unit_of(self, reference):
        """The unit of errors against a Reference, m: the largest imposed displacement or, if loads
        alone move the body, the largest of the reference."""
        return self.unit or float(np.linalg.norm(reference.displacement, axis=1).max())

    def golden_to_truth(self):
        """Accuracy of the golden relative to the truth, or None if one is missing."""
        if self.golden is None or self.truth is None:
            return None
        nodes = self.sets.get(self.profile_set)
        return accuracy(
            self.golden.displacement, self.truth.displacement, self.unit_of(self.truth), nodes
        )


def read_subjects(verdicts, cases, references, results, files=()):
    """A Subject for every case of the verdicts.

    cases: folder of case files. references: folder with golden/ and truth/. results: folder with
    the result files of the runs. files: other case files, which take precedence over those of the
    folder. Raises InputError if a file is missing, is broken or belongs to other runs.
    """
    case_files = _case_files(Path(cases), files)
    return tuple(
        _read_subject(verdicts, name, case_files, Path(references), Path(results))
        for name in verdicts.case_names
    )


def _case_files(folder, files=()):
    """Case name -> (path, tables) for every case of the files in the folder, and of the others."""
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder of cases")
    found = {}
    for path in (*sorted(folder.glob("*.toml")), *files):
        found |= {name: (path, tables) for name, tables in read_tables(path).items()}
    return found


def _read_subject(verdicts, name, case_files, references, results):
    if name not in case_files:
        raise InputError(f"case {name!r} is in the verdicts, but no case file has this name")
    path, tables = case_files[name]
    runs = tuple(run for run in verdicts.runs if run.case == name)
    try:
        imposed = _imposed(tables)
        requirement = tables["case"]["requirement"]
        profile = tables.get("profile", {})
        profile_set, profile_order = profile.get("set"), profile.get("order")
        stored = tables.get("comparison", {})
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path}: not a case of this solver: {error!r}") from error
    files = _result_files(runs, results)
    mesh, displacements, hourglass, hashes = _read_results(files)
    moves = tables["case"].get("answer") == "dynamic"
    places = {
        kind: path.parent / stored[kind] if kind in stored else references / folder / f"{name}.h5"
        for kind, folder in (("golden", "motion" if moves else "golden"), ("truth", "truth"))
    }
    motion = _read_motion(places.pop("golden"), name, hashes) if moves else None
    stored_answers = {
        kind: _read_reference(place, name, hashes, mesh.get("points"))
        for kind, place in places.items()
    }
    subject = Subject(
        name=name,
        requirement=requirement,
        unit=_unit(tables, stored_answers),
        imposed=imposed,
        profile_set=profile_set,
        profile_order=profile_order,
        runs=runs,
        displacements=displacements,
        hourglass=hourglass,
        hashes=hashes,
        motion=motion,
        **mesh,
        **stored_answers,
    )
    if profile_set is not None and files and profile_set not in subject.sets:
        raise InputError(f"{files[0][1]}: node set {profile_set} of the profile is missing")
    _require_same_runs(subject, files)
    return subject


def _result_files(runs, folder):
    """(run, path) of every run with a result file; a run in equilibrium must have one."""
    found = []
    for run in runs:
        path = folder / run.file_name
        if path.is_file():
            found.append((run, path))
        elif run.ok:
            raise InputError(
                f"{path}: no such result file, but the verdicts say that {run.label} on {run.case} "
                f"is ok; make both in one run: sandglass verify --json FILE --results {folder}"
            )
    return found


def _read_results(files):
    """Mesh (of the first file), last displacements and hourglass energies by run, and hashes."""
    mesh, displacements, hourglass, hashes = {}, {}, {}, {}
    for run, path in files:
        with _open(path) as file:
            try:
                frames = file["frames"]
                last = frames[max(frames)]
                u = last["displacement"][...]
                density = last[HOURGLASS][...] if HOURGLASS in last else None
                own = {key: text_of(file.attrs[key]) for key in ("case_hash", "mesh_hash")}
                if not mesh:
                    group, hashes = file["mesh"], own
                    sets = {name: nodes[...] for name, nodes in group.get("sets", {}).items()}
                    mesh = {"points": group["points"][...], "cells": group["cells"][...]}
                    mesh["sets"] = sets
            except (KeyError, ValueError) as error:
                raise InputError(f"{path}: not a result file of this solver: {error}") from error
        if own != hashes or u.shape != mesh["points"].shape:
            raise InputError(
                f"{path}: belongs to another case or mesh than {files[0][1].name}; run verify again"
            )
        key = run.method, None if run.is_main else run.kappa
        displacements[key] = u
        if density is not None:
            hourglass[key] = density
    return mesh, displacements, hourglass, hashes


def _imposed(tables):
    """(set name, value) of all imposed motions; zero for held sets."""
    moved = [(d["set"], tuple(map(float, d["value"]))) for d in tables.get("displacement", [])]
    for turned in tables.get("rotation", []):
        axis, angle = turned["axis"], float(turned["angle"])
        axis = [axis == letter for letter in "xyz"] if isinstance(axis, str) else axis
        moved.append((turned["set"], tuple(angle * float(a) for a in axis)))
    return tuple(moved)


def _unit(tables, references):
    """The largest imposed displacement, m; if sets rotate, the one stored in the references."""
    if "rotation" in tables:
        for reference in references.values():
            if reference is not None:
                return float(reference.attributes["largest_imposed"])
    values = [displacement["value"] for displacement in tables.get("displacement", [])]
    return max((float(np.linalg.norm(value)) for value in values), default=0.0)


def _read_reference(path, name, hashes, points):
    """The Reference in a file, None if there is no file. points: of the runs' mesh, or None."""
    if not path.is_file():
        return None
    with _open(path) as file:
        attributes = {key: text_of(value) for key, value in file.attrs.items()}
        if "displacement" not in file:
            raise InputError(f"{path}: dataset displacement is missing; not a reference")
        displacement = file["displacement"][...]
    _require_hashes(path, name, attributes, hashes)
    if points is not None and displacement.shape != points.shape:
        raise InputError(
            f"{path}: displacement has shape {displacement.shape}, but the mesh of the runs has "
            f"{points.shape}; regenerate it: reference/regenerate {name}"
        )
    return Reference(displacement, attributes)


def _read_motion(path, name, hashes):
    """The MotionGolden in a file, None if there is no file."""
    if not path.is_file():
        return None
    with _open(path) as file:
        attributes = {key: text_of(value) for key, value in file.attrs.items()}
        try:
            frames = file["displacement"]
            u = np.array([frames[number][...] for number in sorted(frames)])
            times = file["times"][...]
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"{path}: not the golden of a motion: {error}") from error
    _require_hashes(path, name, attributes, hashes)
    farthest = int(np.linalg.norm(u, axis=2).max(axis=1).argmax())
    return MotionGolden(u[farthest], float(times[farthest]), attributes)


def _require_hashes(path, name, attributes, hashes):
    """Raises InputError unless a reference has the hashes of the case and mesh of the runs."""
    for key, expected in hashes.items():
        if attributes.get(key) != expected:
            raise InputError(
                f"{path}: {key} is {attributes.get(key)}, but the runs have {expected}; the "
                f"reference belongs to another case or mesh; run reference/regenerate {name}"
            )


def _require_same_runs(subject, files):
    """Raises InputError unless the result files give the figures of the verdicts."""
    profile = None if subject.profile_set is None else subject.sets.get(subject.profile_set)
    for run, path in files:
        u = subject.displacements[run.method, None if run.is_main else run.kappa]
        for kind in REFERENCES:
            reference, given = getattr(subject, kind), getattr(run, kind)
            if reference is None or given is None:
                continue
            found = accuracy(u, reference.displacement, subject.unit_of(reference), profile)
            if abs(found.max - given.max) > AGREEMENT * max(1.0, given.max):
                raise InputError(
                    f"{path}: its largest error against the {kind} is {found.max:.6g}, but the "
                    f"verdicts say {given.max:.6g}: they come from different runs; run verify again"
                )


def _open(path):
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise InputError(f"{path}: cannot be read as HDF5: {error}") from error
