"""Pictures of bodies: the paper's figures 1 and 3, and a small one of every case."""

import numpy as np
from matplotlib.colors import to_rgb

from common.hexahedron import boundary_faces
from sandglass_report import paper, style
from sandglass_report.plates import Panel, Plate
from sandglass_report.shapes import View, draw_surface, frame, window

BODY = "#c9d3dd"
HELD = "#76818d"
DRIVEN = "#465565"
ALL_ROUND = View(azimuth=28.0, elevation=24.0)
FROM_THE_SIDE = View(azimuth=16.0, elevation=14.0)


def view_of(points):
    """A viewing direction for points (n, 3): slender bodies from the side, others from above."""
    size = np.ptp(points, axis=0)
    return FROM_THE_SIDE if size[2] > 3 * max(size[0], size[1]) else ALL_ROUND


def gallery_panel(subject):
    """A case, undeformed and deformed, side by side at one scale; its title names the source of the
    answer. None if the case has no mesh, or none of the answers that `answer_to_show` allows."""
    shown = answer_to_show(subject)
    if subject.points is None or shown is None:
        return None
    u, source = shown
    view = view_of(subject.points)
    faces = boundary_faces(subject.cells)
    flat_width = np.ptp(view.project(subject.points)[0][:, 0])
    aside = view.axes()[0] * flat_width * 1.25

    limits = window([subject.points, subject.points + u + aside], view)

    def draw(axes):
        marked = _marked(subject)
        draw_surface(axes, subject.points, faces, view, BODY, marked, True)
        draw_surface(axes, subject.points + u + aside, faces, view, BODY, marked, True)
        frame(axes, limits)

    alt = f"{subject.name}: undeformed (left) and deformed (right: {source})."
    wide, high = limits[1] - limits[0]
    return Panel(f"case.{subject.name}", source, alt, draw, 300, round(300 * high / wide))


def shape_plate(subject, experiment, palette):
    """The paper's picture of deformed shapes (figure 1 or 3) as a plate, or None."""
    if subject.points is None:
        return None
    number = experiment.shape_figure
    shapes = [("undeformed", np.zeros_like(subject.points), BODY)]
    for method, words in (
        (paper.WITHOUT_CONTROL, "no control"),
        (paper.METHOD, "with control"),
    ):
        u = subject.displacement(method)
        shapes.append((f"{words}: {method}", u, _colour(palette, method)))
    golden = None if subject.golden is None else subject.golden.displacement
    shapes.append(("mixed element: golden", golden, style.GOLDEN[0]))
    view = view_of(subject.points)
    limits = window(_scale_setters(subject, shapes), view, 0.05)
    panels = tuple(
        _shape_panel(
            subject, f"figure-{number}.{'abcd'[i]}", f"({'abcd'[i]}) ", shape, view, limits
        )
        for i, shape in enumerate(shapes)
    )
    return Plate(f"figure-{number}", f"Figure {number}. {experiment.title}", panels, len(panels))


def _shape_panel(subject, name, letter, shape, view, limits):
    words, u, colour = shape
    faces = boundary_faces(subject.cells)

    def draw(axes):
        draw_surface(axes, subject.points + u, faces, view, _pale(colour), _marked(subject))
        frame(axes, limits)

    alt = f"{subject.name}, {words}: surface mesh."
    wide, high = limits[1] - limits[0]
    missing = "no result" if u is None else ""
    return Panel(name, letter + words, alt, draw, 260, round(260 * min(high / wide, 1.9)), missing)


def _scale_setters(subject, shapes):
    """Bodies that set the common scale; one that greatly exceeds the others is cut off."""
    bodies = [subject.points + u for _, u, _ in shapes if u is not None]
    extent = min(np.ptp(body, axis=0).max() for body in bodies)
    return [body for body in bodies if np.ptp(body, axis=0).max() < 1.6 * extent]


def answer_to_show(subject):
    """The displacement that represents a case, (n, 3), m, and its source in words.

    The golden's or, without a golden, that of the method whose errors the page shows beside it,
    never that of another method. None if there is neither.
    """
    if subject.golden is not None:
        return subject.golden.displacement, "the golden"
    if subject.motion is not None:
        when = f"{style.plain(subject.motion.time, 2)} s, where it has moved farthest"
        return subject.motion.displacement, f"the golden at {when}"
    u = subject.displacement(paper.METHOD)
    return None if u is None else (u, f"{paper.METHOD}, as no golden is stored")


def _marked(subject):
    """Held and driven faces with their colours."""
    return [
        (subject.sets[name], DRIVEN if np.any(value) else HELD)
        for name, value in subject.imposed
        if name in subject.sets
    ]


def _colour(palette, method):
    return palette.colour(method) if palette.knows(method) else BODY


def _pale(colour):
    """A line's colour adapted to bodies: light enough for shading to be visible."""
    if colour == BODY:
        return colour
    return tuple(1 - 0.62 * (1 - np.array(to_rgb(colour))))
