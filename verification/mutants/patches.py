"""The mutants: one patch file each, NNN-short-name.patch in this folder.

The text before the diff is its head: a description of the mistake, up to the first empty line; then
where such a mistake was seen, or `Equivalent: ` and the proof that no test can notice it.
"""

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
EQUIVALENT = "Equivalent: "


@dataclass(frozen=True)
class Patch:
    """A mutant: the name of its file, its mistake in a sentence, the files that it changes."""

    path: Path
    name: str
    mistake: str
    equivalent: bool
    files: tuple
    digest: str


def read_patch(path):
    """The Patch of a file. Raises ValueError if its head or its diff is missing."""
    text = path.read_text(encoding="utf-8")
    head, found, _ = text.partition("\n--- ")
    files = tuple(re.findall(r"^\+\+\+ b/(\S+)", text, re.MULTILINE))
    paragraphs = [" ".join(p.split()) for p in head.split("\n\n")]
    if not found or not files or not paragraphs[0] or paragraphs[0].startswith("diff "):
        raise ValueError(f"{path}: needs a sentence that says the mistake, then a unified diff")
    equivalent = any(p.startswith(EQUIVALENT) for p in paragraphs)
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    return Patch(path, path.stem, paragraphs[0], equivalent, files, digest)


def read_patches():
    """All patches, by number."""
    return [read_patch(path) for path in sorted(FOLDER.glob("*.patch"))]
