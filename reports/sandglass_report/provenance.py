"""The origin of every figure on the page: machine, program, cases, meshes and references."""

import hashlib
from dataclasses import dataclass, replace
from pathlib import Path

from sandglass_report.measured import Source

NAMES = {
    "processor": "Processor",
    "compiler": "Compiler",
    "build_flags": "Build",
    "version": "Version",
    "revision": "Revision",
}
VERIFY = "sandglass verify --json build/verdicts.json --results build/verify"


@dataclass(frozen=True)
class CaseOrigin:
    """The hashes of a case, and its references."""

    case: str
    case_hash: str
    mesh_hash: str
    references: tuple  # (kind, how it was computed, SHA-256 of its displacements)


def program(verdicts):
    """(name, value) about the program and the machine."""
    return [(NAMES.get(name, name), value) for name, value in verdicts.provenance.items()]


def sources(verdicts, path, measured):
    """All files that the page reads, verdicts first; files of one folder and origin are grouped."""
    groups = {}
    for source in measured.sources:
        made = [(source.facts or {}).get(name) for name in ("revision", "processor")]
        key = source.command, source.facts is None, *made
        groups.setdefault(key, []).append(source)
    rows = [Source(_short(path), VERIFY, verdicts.provenance)]
    for group in groups.values():
        where = _short(group[0].path)
        if len(group) > 1:
            where = f"{where.rpartition('/')[0]}/: {len(group)} files"
        rows.append(replace(group[0], path=where))
    return tuple(rows)


def _short(path):
    """A path relative to the root of the tree, if it is inside."""
    path = Path(path)
    return "/".join(path.parts[-2:]) if path.is_absolute() else path.as_posix()


def of_another_revision(source, verdicts):
    """Whether a file states another revision than that of the verdicts."""
    own = (source.facts or {}).get("revision")
    return own is not None and own != verdicts.provenance.get("revision")


def elsewhere(facts, own):
    """Machine and revision of a file in words if they differ from the page's, else nothing.

    facts: of the file. own: of the verdicts. Facts that neither states count as equal.
    """
    differs = any(
        facts.get(name) != own.get(name)
        for name in ("processor", "revision")
        if name in facts and name in own
    )
    if not differs:
        return ""
    return f"{facts.get('processor', 'this machine')}, revision {facts.get('revision', 'unknown')}"


def origins(subjects):
    """A CaseOrigin for every case."""
    return tuple(
        CaseOrigin(
            s.name,
            s.hashes.get("case_hash", ""),
            s.hashes.get("mesh_hash", ""),
            tuple(
                (kind, _words(reference.attributes), _hash(reference.displacement))
                for kind, reference in _references(s)
                if reference is not None
            ),
        )
        for s in subjects
    )


def _references(subject):
    """(kind, reference or None) of a case; the hash of a motion is that of the state shown."""
    return (
        ("golden", subject.golden),
        ("golden, in motion", subject.motion),
        ("truth", subject.truth),
    )


def _words(about):
    """How a reference was computed, from its attributes."""
    split = f", edges split {about['refinements']}×" if about.get("refinements") else ", same mesh"
    program = f", dolfinx {about['dolfinx_version']}" if "dolfinx_version" in about else ""
    return f"{about.get('element', 'unknown element')}{split}{program}"


def _hash(displacement):
    """The first sixteen digits of the SHA-256 of the displacements' bytes."""
    return hashlib.sha256(displacement.astype("<f8").tobytes()).hexdigest()[:16]
