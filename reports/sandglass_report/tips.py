"""Tables of computed over published displacements and forces: beams, panels, bending, contact."""

from dataclasses import dataclass


@dataclass(frozen=True)
class TipTable:
    """One family of cases against one reference: a row per method, a column per variant."""

    family: str
    reference: str  # the source of the published values, or "the truth"
    variants: tuple
    rows: tuple  # (method, (Tip or None per variant))

    def ratio(self, tip):
        """Computed over reference; None if the run failed or there is no reference."""
        if tip is None or not tip.ok:
            return None
        return tip.to_truth if self.reference == "the truth" else tip.to_published


def tip_tables(tips, of="end"):
    """The tables of all families, in the order of the file; relative to the truth if available.

    of: what the values are of, "end" for displacements and rotations, "force" of obstacles.

    Families with known values of other programs have their own tables (published.py), and measured
    values their own plate (experiment.py).
    """
    tips = [t for t in tips if not t.programs and t.scatter is None and t.of == of]
    tables = []
    for family in dict.fromkeys(tip.family for tip in tips):
        own = [tip for tip in tips if tip.family == family]
        variants = tuple(dict.fromkeys(tip.variant for tip in own))
        at = {(tip.method, tip.variant): tip for tip in own}
        methods = dict.fromkeys(tip.method for tip in own)
        rows = tuple((m, tuple(at.get((m, v)) for v in variants)) for m in methods)
        tables.append(TipTable(family, own[0].source, variants, rows))
        if any(tip.to_truth is not None for tip in own):
            tables.append(TipTable(family, "the truth", variants, rows))
    return tuple(tables)
