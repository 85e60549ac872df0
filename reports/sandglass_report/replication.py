"""The paper's Tables I and II with our counts and times."""

from dataclasses import dataclass

from sandglass_report import paper
from sandglass_report.measured import OWN_MESH


@dataclass(frozen=True)
class Counted:
    """One framework of Table I: operations per element and step, None where not counted."""

    words: str
    method: str
    paper: int  # of the hourglass control
    as_written: int | None  # of eq. 14 as the paper writes it
    control: int | None  # of the control in the kernel that runs
    element: int | None  # of the whole kernel, for an element


@dataclass(frozen=True)
class Timed:
    """One column of Table II: ms for a step, and its ratio to the first one."""

    words: str
    method: str
    paper: float
    paper_ratio: float
    ours: float | None
    our_ratio: float | None


def table_1(counts):
    """Operations of the hourglass control, Total and Updated Lagrangian; Counted for each."""
    kinds = (("paper", "hourglass"), ("kernel", "hourglass"), ("kernel", "element"))
    return tuple(
        Counted(words, method, figure, *(_count(counts, method, *kind) for kind in kinds))
        for words, method, figure in paper.TABLE_1
    )


def table_2(points):
    """Time of a step on the ellipsoid, in double on one thread; Timed for each.

    points: of the main chart, whose costs these are.
    """
    ours = [_milliseconds(points, method) for _, method, _ in paper.TABLE_2]
    first = paper.TABLE_2[0][2]
    return tuple(
        Timed(words, method, ms, ms / first, our, our / ours[0] if our and ours[0] else None)
        for (words, method, ms), our in zip(paper.TABLE_2, ours)
    )


def _milliseconds(points, method):
    wanted = (paper.TIMED_CASE, method, "double", OWN_MESH)
    found = (p for p in points if (p.case, p.method, p.precision, p.mesh) == wanted)
    return next((1e3 * p.step for p in found if p.counts and p.step is not None), None)


def _count(counts, method, form, part):
    wanted = (method, form, part)
    return next((c.total for c in counts if (c.method, c.form, c.part) == wanted), None)
