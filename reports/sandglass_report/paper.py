"""The paper's own figures, for comparison with ours.

Joldes, Wittek and Miller: An efficient hourglass control implementation for the uniform strain
hexahedron using the Total Lagrangian formulation. Commun. Numer. Meth. Engng 24 (2008) 1315.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Experiment:
    """One experiment of the paper and the case that replicates it."""

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
UPDATED = "ul-perturbation"
TIMED_CASE = "ellipsoid-indentation"
FIRST_CASE = "column"  # shown first on the page, as it separates all methods

# Table I: operations per element of the hourglass control. (words, our method, figure)
TABLE_1 = (
    ("Total Lagrangian", METHOD, 360),
    ("Updated Lagrangian", UPDATED, 1585),
)

# Table II: ms for one step of the ellipsoid's indentation. (words, our method, figure)
TABLE_2 = (
    ("perturbation, Total Lagrangian (TLED)", METHOD, 2.1),
    ("perturbation, Updated Lagrangian (ABAQUS Explicit)", UPDATED, 10.6),
    ("enhanced assumed strain, Updated Lagrangian (ABAQUS Explicit)", "ul-enhanced", 13.7),
)

# Descriptions of the figures; the pictures are the publisher’s and not reproduced.
FIGURES = {
    1: "The ellipsoid, undeformed and deformed.",
    2: "Surface nodes in y = 0: TLED and ABAQUS’s hybrid hexahedra, at most 0.34 % apart.",
    3: "The column undeformed; deformed without control, a zigzag; deformed with control, smooth.",
    4: "A line of nodes on the column’s side: TLED and ABAQUS, at most 1.4 % apart.",
}
