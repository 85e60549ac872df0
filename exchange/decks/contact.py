"""Contact in decks: obstacles, pairs of surfaces, and what a program can express of them."""

from dataclasses import dataclass, field

import numpy as np

from common.errors import InputError

SHAPES = ("plane", "sphere", "capsule", "cylinder", "box", "ellipsoid", "surface")
AT_REST = "static equilibrium"


def _no_vector():
    return np.zeros(3)


@dataclass(frozen=True)
class Obstacle:
    """A rigid obstacle where it starts, with the keys of [[obstacle]].

    point, end, normal, half_sizes, displacement (its whole way): (3,), m. radius: m. points (n, 3),
    m, and triangles (k, 3): of a closed surface, outward, around `point`. faces: (f, 4), nodes of
    the body's faces that may touch it. stiffness: pressure per depth of its penalty, Pa/m. overlap:
    how deep the undeformed body is inside of it at the end, m; negative outside.
    """

    name: str
    shape: str
    faces: np.ndarray
    stiffness: float
    overlap: float = 0.0
    method: str = "kinematic"
    inside: bool = False
    friction: float = 0.0
    radius: float = 0.0
    point: np.ndarray = field(default_factory=_no_vector)
    end: np.ndarray = field(default_factory=_no_vector)
    normal: np.ndarray = field(default_factory=_no_vector)
    half_sizes: np.ndarray = field(default_factory=_no_vector)
    displacement: np.ndarray = field(default_factory=_no_vector)
    points: np.ndarray | None = None
    triangles: np.ndarray | None = None

    @property
    def words(self):
        """How messages and titles name it."""
        return f"obstacle '{self.name}'"


@dataclass(frozen=True)
class Pair:
    """Two surfaces of deformable bodies, or one that may touch itself, as [[contact]] gives them.

    faces, other_faces: (f, 4), nodes; other_faces is None if the surface touches itself. stiffness:
    pressure per depth of its penalty, Pa/m.
    """

    name: str
    faces: np.ndarray
    stiffness: float
    other_faces: np.ndarray | None = None
    method: str = "kinematic"
    friction: float = 0.0

    @property
    def words(self):
        """How messages and titles name it."""
        return f"contact '{self.name}'"


@dataclass(frozen=True)
class Expressible:
    """What the deck of a program can hold of contact.

    shapes: of obstacles. inside: whether bodies may be inside of them. obstacles, pairs, itself: in
    which of AT_REST, "kinematic" and "penalty" (methods of motions) it knows obstacles, two
    surfaces, and a surface that touches itself. how: what the deck makes of them, for README.md.
    """

    shapes: tuple = ()
    inside: bool = False
    obstacles: tuple = ()
    pairs: tuple = ()
    itself: tuple = ()
    how: str = "refused"


def check(problem, program):
    """Raises InputError for contact of a Problem that a program (its module) cannot express."""
    known = program.CONTACT

    def require(one, key, value, allowed, otherwise):
        if value in allowed:
            return
        allowed = f"allowed: {', '.join(allowed)}" if allowed else otherwise
        raise InputError(
            f"{one.words}: {key} = '{value}' is not known to {program.NAME}; {allowed}"
        )

    for one in problem.obstacles:
        require(one, "shape", one.shape, known.shapes, "its decks hold no obstacles")
        if one.inside and not known.inside:
            require(one, "inside", "true", ("false",), "")
    for one in [*problem.obstacles, *problem.pairs]:
        if isinstance(one, Obstacle):
            methods, what = known.obstacles, "obstacles"
        elif one.other_faces is None:
            methods, what = known.itself, "surfaces that touch themselves"
        else:
            methods, what = known.pairs, "[[contact]]"
        if not problem.motion:
            require(one, "answer", AT_REST, methods, f"its decks hold no {what}")
            continue
        moving = [method for method in methods if method != AT_REST]
        where = f"{what} in {AT_REST} only" if methods else f"no {what}"
        require(one, "method", one.method, moving, f"its decks hold {where}")
