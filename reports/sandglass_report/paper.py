"""The paper's own figures, which ours are laid beside.

Joldes, Wittek and Miller: An efficient hourglass control implementation for the uniform strain
hexahedron using the Total Lagrangian formulation. Commun. Numer. Meth. Engng 24 (2008) 1315.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Experiment:
    """One experiment of the paper and the case that repeats it."""

    case: str
    title: str
    profile_error: float  # section 3.2: largest difference on the line over imposed displacement
    shape_figure: int
    line_figure: int


EXPERIMENTS = (
    Experiment("ellipsoid-indentation", "Indentation of an ellipsoid", 0.0034, 1, 2),
    Experiment("column", "Deformation of a column", 0.014, 3, 4),
)

METHOD = "tl-perturbation"
WITHOUT_CONTROL = "tl-none"
LINE_METHODS = (WITHOUT_CONTROL, METHOD, "ul-perturbation", "tl-full", "tl-mean-dilatation")
