"""Laws with parameters that differ from element to element: one law for each element.

The solver shares kernels between equal laws, so this costs nothing where values repeat.
"""

import numpy as np

import _sandglass

_MOST = 2**16 - 1  # laws of a case


class ElementLaws:
    """The laws of a body, of which those with arrays as parameters are one for each element.

    `laws`: for the case. `element_sets`: new ones, of one element each, by name. Raises InputError
    for arrays of another length than the law has elements.
    """

    def __init__(self, materials, mesh):
        self.laws, self.element_sets = [], {}
        self._parts = []  # for each material its keys with arrays, its first law, and how many
        for material in materials:
            keys = [key for key, value in material._values.items() if _varies(material, key)]
            first = len(self.laws)
            if keys:
                self._add(material, keys, mesh, alone=len(materials) == 1)
            else:
                self.laws.append(material)
            self._parts.append((keys, first, len(self.laws) - first))

    def _add(self, material, keys, mesh, alone):
        name = material._name()
        elements = _elements(material, mesh, alone)
        for key in keys:
            count = len(material._values[key])
            if count != len(elements):
                raise _sandglass.InputError(
                    f"{name}: {key} must be a number or have the shape ({len(elements)},), one for "
                    f"each element of the law, but has {count} entries"
                )
        if len(self.laws) + len(elements) > _MOST:
            raise _sandglass.InputError(
                f"{name}: {keys[0]} differs between {len(elements)} elements; at most {_MOST}"
            )
        columns = {key: material._values[key] for key in keys}
        for n, element in enumerate(elements):
            title = f"element {element}"
            self.element_sets[title] = np.array([element])
            own = {key: column[n] for key, column in columns.items()}
            self.laws.append(type(material)(**(material._values | own | {"elements": title})))

    def gathered(self, derivatives):
        """Derivatives of each material from those of each law, a list of dicts.

        By a parameter that is an array they are an array, by another one the sum over elements.
        """
        found = []
        for keys, first, count in self._parts:
            own = derivatives[first : first + count]
            columns = {key: np.array([each[key] for each in own]) for key in own[0]}
            found.append({key: c if key in keys else float(c.sum()) for key, c in columns.items()})
        return tuple(found)

    def spread(self, changes):
        """Changes of each law from those of each material, a list of dicts of numbers or arrays."""
        if len(changes) != len(self._parts):
            return changes  # the solver says what is wrong
        found = []
        for (_, _, count), change in zip(self._parts, changes):
            for key, value in change.items() if hasattr(change, "items") else ():
                if np.shape(value) not in ((), (count,)) or (np.shape(value) and count == 1):
                    raise _sandglass.InputError(
                        f"materials: {key} must be a number"
                        + (f" or have the shape ({count},)" if count > 1 else "")
                    )
            for n in range(count):
                found.append(
                    {key: np.ravel(v)[n] if np.shape(v) else v for key, v in change.items()}
                    if hasattr(change, "items")
                    else change
                )
        return found

    def shape(self, m, key):
        """The shape of a parameter of a material: (its elements,) if it is an array, else ()."""
        keys, _, count = self._parts[m] if m < len(self._parts) else ((), 0, 0)
        return (count,) if key in keys else ()

    def of_bodies(self, parameters):
        """Parameters (bodies,) of each law from those of each material, (bodies, ...)."""
        if len(parameters) != len(self._parts):
            raise _sandglass.InputError(
                f"materials: {len(parameters)} were given; it must be one for each of the "
                f"{len(self._parts)} of the body"
            )
        return [
            {key: column[:, n] if column.ndim == 2 else column for key, column in given.items()}
            for (_, _, count), given in zip(self._parts, parameters)
            for n in range(count)
        ]


def _varies(material, key):
    declared = material._keys[key]
    single = declared["type"] == "number" and declared["count"] == 1
    return single and isinstance(material._values[key], list)


def _elements(material, mesh, alone):
    """The elements of a law, in the order in which its set was given."""
    name = material.elements
    if name is None and alone:
        return range(len(mesh.cells))
    if name in mesh._as_given:
        return mesh._as_given[name].tolist()
    raise _sandglass.InputError(
        f"{material._name()}: parameters that are arrays need `elements`, a set that is an array "
        f"of elements, but that is {name!r}"
    )
