"""Data of the page's 3D viewer: surfaces of deformed bodies with a colour for every face.

All arrays are small integers in base64: positions in steps of 1/65535 of their bounding box (the
width of a picture is a few thousand pixels), colours in steps of 1/255 of their scale.
"""

import base64

import numpy as np
from matplotlib import colormaps

from common.accuracy import relative_distances
from common.hexahedron import FACES, boundary_faces, gauss_jacobians
from sandglass_report.bodies import view_of

STOPS = 32  # of a colour scale; the page draws the nearest one
LEAST_ERROR = 1e-5  # fractions; the logarithmic scale of errors begins here
GOLDEN = "golden"

# The colourings of faces: words, unit, scale and colour map (distinguishable when colour-blind).
COLOURS = {
    "error": ("distance from the golden", "% of the imposed displacement", "log", "viridis"),
    "volume": ("volume ratio, det F", "deformed over undeformed", "linear", "PuOr"),
    "hourglass": ("hourglass energy", "J/m³", "linear", "viridis"),
}


def volumes(points, cells):
    """Volumes (m,) of trilinear hexahedra, m^3. points: (n, 3), m. cells: (m, 8), VTK order."""
    return gauss_jacobians(points, cells).sum(axis=0)


def viewer_data(subjects):
    """The cases with a mesh, and the colour scales, ready for JSON."""
    return {
        "scales": {
            name: {"words": words, "unit": unit, "scale": scale, "map": _stops(colours)}
            for name, (words, unit, scale, colours) in COLOURS.items()
        },
        "cases": {s.name: _case(s) for s in subjects if s.points is not None and s.displacements},
    }


def _case(subject):
    """Surface, answers and colour limits of a case."""
    faces, owners = _faces(subject.cells)
    nodes, local = np.unique(faces, return_inverse=True)
    undeformed = volumes(subject.points, subject.cells)
    main = {m: u for (m, kappa), u in subject.displacements.items() if kappa is None}
    answers = {m: u for m, u in main.items() if np.isfinite(u).all()}
    if subject.golden is not None:
        answers = {GOLDEN: subject.golden.displacement} | answers
    fields = {name: _fields(subject, name, u, undeformed) for name, u in answers.items()}
    limits = _limits(fields)
    view = view_of(subject.points)
    return {
        "faces": _packed(local, np.uint16 if len(nodes) < 65536 else np.uint32),
        "wide": len(nodes) >= 65536,
        "rest": _places(subject.points[nodes]),
        "view": [view.azimuth, view.elevation],
        "limits": {name: [float(f"{v:.4g}") for v in pair] for name, pair in limits.items()},
        "answers": {
            name: {
                "places": _places((subject.points + u)[nodes]),
                "largest": float(f"{fields[name]['error'].max():.4g}") if subject.golden else None,
            }
            | {
                key: _levels(values[faces].max(axis=1) if key == "error" else values[owners], pair)
                for key, pair in limits.items()
                for values in [fields[name].get(key)]
                if values is not None
            }
            for name, u in answers.items()
        },
    }


def _faces(cells):
    """Boundary faces (k, 4) and the element (k,) that each belongs to."""
    faces = boundary_faces(cells)
    every = np.sort(np.asarray(cells)[:, FACES].reshape(-1, 4), axis=1)
    element = {tuple(face): i // 6 for i, face in enumerate(every.tolist())}
    return faces, np.array([element[tuple(face)] for face in np.sort(faces, axis=1).tolist()])


def _fields(subject, name, u, undeformed):
    """Values by name: errors of nodes (fractions), other values of elements."""
    found = {"volume": volumes(subject.points + u, subject.cells) / undeformed}
    if subject.golden is not None:
        golden = subject.golden.displacement
        found["error"] = relative_distances(u, golden, subject.unit_of(subject.golden))
    if (name, None) in subject.hourglass:
        found["hourglass"] = subject.hourglass[name, None]
    return found


def _limits(fields):
    """Limits of the colour scales of a case, the same for all its answers.

    Failing answers would stretch them, so a scale ends at twice the median of the answers' maxima.
    """
    limits = {}
    errors = [f["error"].max() for n, f in fields.items() if "error" in f and n != GOLDEN]
    if errors:
        limits["error"] = LEAST_ERROR, max(2 * float(np.median(errors)), 10 * LEAST_ERROR)
    strains = [np.abs(f["volume"] - 1).max() for f in fields.values()]
    reach = min(max(2 * float(np.median(strains)), 1e-3), 1.0)
    limits["volume"] = 1 - reach, 1 + reach
    energies = [f["hourglass"].max() for f in fields.values() if "hourglass" in f]
    if energies and max(energies) > 0:
        limits["hourglass"] = 0.0, 2 * float(np.median([e for e in energies if e > 0]))
    return limits


def _levels(values, limits):
    """Values as levels 0..255 of the scale between limits; errors logarithmically."""
    low, high = limits
    if low == LEAST_ERROR:
        values, low, high = np.log(np.maximum(values, low)), np.log(low), np.log(high)
    level = 255 * (np.nan_to_num(values, posinf=high) - low) / (high - low)
    return _packed(np.rint(np.clip(level, 0, 255)), np.uint8)


def _places(points):
    """Points (n, 3) as integers in their bounding box."""
    low, high = points.min(axis=0), points.max(axis=0)
    size = max(float((high - low).max()), 1e-300)
    steps = np.rint(65535 * (points - low) / size)
    return {"low": [float(f"{v:.7g}") for v in low], "size": size, "xyz": _packed(steps, np.uint16)}


def _packed(values, kind):
    """Integers as base64, little-endian."""
    array = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<"))
    return base64.b64encode(array.tobytes()).decode("ascii")


def _stops(name):
    """A colour map as hexadecimal colours, without its darkest shades, as they hide edges."""
    shades = (255 * colormaps[name](np.linspace(0.08, 0.98, STOPS))[:, :3]).round().astype(int)
    return ["#%02x%02x%02x" % tuple(int(c) for c in shade) for shade in shades]
