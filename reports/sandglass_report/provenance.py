"""Where every figure of the page comes from: machine, program, cases, meshes and references."""

import hashlib
from dataclasses import dataclass, replace

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
    """The hashes of a case and what its references are."""

    case: str
    case_hash: str
    mesh_hash: str
    references: tuple  # (kind, words on how it was computed, SHA-256 of its displacements)


def program(verdicts):
    """(name, value) of what ran and where."""
    return [(NAMES.get(name, name), value) for name, value in verdicts.provenance.items()]


def sources(verdicts, path, measured):
    """All files that the page reads, verdicts first; those of one folder and one making as one."""
    groups = {}
    for source in measured.sources:
        key = source.command, str(sorted((source.facts or {}).items()))
        groups.setdefault(key, []).append(source)
    rows = [Source(str(path), VERIFY, verdicts.provenance)]
    for group in groups.values():
        first = group[0]
        where = f"{first.path.rpartition('/')[0]}/: {len(group)} files"
        rows.append(first if len(group) == 1 else replace(first, path=where))
    return tuple(rows)


def of_another_revision(source, verdicts):
    """Whether a file was made by another revision than the verdicts, as far as it says."""
    own = (source.facts or {}).get("revision")
    return own is not None and own != verdicts.provenance.get("revision")


def origins(subjects):
    """A CaseOrigin for every case."""
    return tuple(
        CaseOrigin(
            s.name,
            s.hashes.get("case_hash", ""),
            s.hashes.get("mesh_hash", ""),
            tuple(
                (kind, _words(reference.attributes), _hash(reference.displacement))
                for kind, reference in (("golden", s.golden), ("truth", s.truth))
                if reference is not None
            ),
        )
        for s in subjects
    )


def _words(about):
    """How a reference was computed, from its attributes."""
    split = f", mesh split {about['refinements']}×" if about.get("refinements") else ", same mesh"
    program = f", dolfinx {about['dolfinx_version']}" if "dolfinx_version" in about else ""
    return f"{about.get('element', 'unknown element')}{split}{program}"


def _hash(displacement):
    """SHA-256 of the displacements' bytes, its first sixteen digits."""
    return hashlib.sha256(displacement.astype("<f8").tobytes()).hexdigest()[:16]
