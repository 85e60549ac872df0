"""Writes meshes as Abaqus and CalculiX input files (.inp)."""

import re

from common.errors import InputError


def number(value):
    """A number in at most 20 characters, as more are not read; exact if they suffice."""
    texts = (repr(float(value)), f"{value:.13e}", f"{value:.12e}")
    return next(text for text in texts if len(text) <= 20)


def mesh_lines(mesh, element="C3D8", element_set=None):
    """The lines of *NODE, *ELEMENT, *NSET and *ELSET of a HexMesh; ids count from one.

    element: an eight-node brick type. element_set: name of a set of all elements, or None.
    Raises InputError for a set name that the format does not allow.
    """
    lines = ["*NODE"]
    lines += [f"{i}, " + ", ".join(map(number, point)) for i, point in enumerate(mesh.points, 1)]
    # VTK and Abaqus number the vertices of a brick in the same order.
    lines.append(f"*ELEMENT, TYPE={element}" + (f", ELSET={element_set}" if element_set else ""))
    lines += [f"{i}, " + ", ".join(map(str, cell)) for i, cell in enumerate(mesh.cells + 1, 1)]
    lines += _set_lines("NSET", mesh.sets) + _set_lines("ELSET", mesh.element_sets)
    return lines


def _set_lines(keyword, sets):
    """The lines of sets, which count from zero. Raises InputError for a name."""
    lines, spelled = [], {}
    for name, members in sets.items():
        if not name.isprintable() or '"' in name or len(name) > 80:
            raise InputError(
                f"set {name!r}: names in .inp must be printable, without quotes, at most 80 "
                "characters"
            )
        other = spelled.setdefault(name.upper(), name)
        if other != name:
            raise InputError(f"sets '{other}' and '{name}': names in .inp are not case-sensitive")
        plain = re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII)
        lines.append(f"*{keyword}, {keyword}=" + (name if plain else f'"{name}"'))
        ids = [str(member + 1) for member in members]
        lines += [", ".join(ids[at : at + 16]) for at in range(0, len(ids), 16)]
    return lines
