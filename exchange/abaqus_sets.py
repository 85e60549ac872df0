"""Parts of an Abaqus input file and their sets of nodes and elements."""

import numpy as np

from common.errors import InputError
from common.hexahedron import FACES, boundary_faces
from exchange.foreign_mesh import HEXAHEDRON

NONE = np.empty(0, dtype=np.int64)
SIDES = ["S1", "S2", "S3", "S4", "S5", "S6"]  # of a hexahedron, in the order of FACES


class Part:
    """Nodes, elements and sets of a part, of the assembly, or of a file without parts.

    sets: NSET or ELSET -> name in capitals -> (spelling, [(place, instance, entry)]); an entry is
    an array of numbers, a range, another set's name, or ("ELSET", name) for the nodes of elements.
    Of a SURFACE, an entry is (label, entry), with "NODE" or the name of a face as the label.
    """

    def __init__(self, name):
        self.name, self.ids, self.points, self.blocks = name, [], [], []
        self.sets = {"NSET": {}, "ELSET": {}, "SURFACE": {}}

    def add(self, kind, name, place, *entries, instance=""):
        """Adds entries to a set; several keywords may contribute to the same set."""
        own = self.sets[kind].setdefault(name.upper(), (name, []))
        own[1].extend((place, instance.upper(), entry) for entry in entries)


class Resolver:
    """Finds the members of sets, whatever the order in which they are defined."""

    def __init__(self, parts, first):
        self.parts, self.first, self.found = {part.name.upper(): part for part in parts}, first, {}
        self.known = {}
        for part in parts:
            elements = [block.ids for block in part.blocks]
            for kind, ids in (("NSET", part.ids), ("ELSET", elements)):
                self.known[id(part), kind] = np.unique(np.concatenate([NONE, *ids]))
        self.blocks = [(b, first[id(part)]) for part in parts for b in part.blocks]

    def members(self, part, kind, given, place):
        """Sorted numbers of a set by its name. Raises InputError where one does not exist."""
        own, key = part, given.upper()
        name = key
        if key not in own.sets[kind] and "." in key:
            scope, name = key.split(".", 1)
            own = self.parts.get(scope, part)
        at = id(own), kind, name
        if at in self.found:
            if self.found[at] is None:
                raise InputError(f"{place}: set '{given}' is a member of itself")
            return self.found[at]
        if name not in own.sets[kind]:
            what = "nodes" if kind == "NSET" else "elements"
            raise InputError(f"{place}: set '{given}' of {what} is not defined in the file")
        self.found[at] = None
        spelled, entries = own.sets[kind][name]
        found = [self._entry(own, kind, spelled, *entry) for entry in entries]
        self.found[at] = np.unique(np.concatenate([NONE, *found]))
        return self.found[at]

    def _entry(self, part, kind, spelled, place, instance, entry):
        own = self.parts[instance] if instance else part
        if isinstance(entry, tuple):
            return self.nodes_of(self.members(own, "ELSET", entry[1], place))
        if isinstance(entry, str):
            scope, dot, last = entry.upper().rpartition(".")
            if not (dot and last.isdecimal() and len(last) < 19 and scope in self.parts):
                return self.members(own, kind, entry, place)
            own, entry = self.parts[scope], np.array([int(last)])
        known = self.known[id(own), kind]
        if isinstance(entry, range):  # of what exists
            some = known[np.searchsorted(known, entry[0]) : np.searchsorted(known, entry[-1] + 1)]
            entry = some[(some - entry[0]) % entry.step == 0]
        at = np.minimum(np.searchsorted(known, entry), len(known) - 1)
        missing = entry[known[at] != entry] if len(known) else entry
        if missing.size:
            what = "node" if kind == "NSET" else "element"
            where = f" of '{own.name}'" if own.name else ""
            raise InputError(
                f"{place}: set '{spelled}' names {what} {missing[0]}{where}, which does not exist"
            )
        return entry + self.first.get(id(own), 0)

    def surface(self, part, key):
        """(sorted nodes of a surface, ""), or (None, why it is not read)."""
        spelled, entries = part.sets["SURFACE"][key]
        alike = {}  # label -> where it is first, members
        for place, instance, (label, entry) in entries:
            kind = "NSET" if label == "NODE" else "ELSET"
            members = self._entry(part, kind, spelled, place, instance, entry)
            alike.setdefault(label, (place, []))[1].append(members)
        found = [NONE]
        for label, (place, some) in alike.items():
            members = np.concatenate(some)
            found += [members] if label == "NODE" else self._faces(members, label)
            if found[-1] is None:
                what = f"face {label} of such elements" if label else "a surface without faces"
                return None, f"{place}: surface '{spelled}': {what} is not read"
        return np.unique(np.concatenate(found)), ""

    def _faces(self, elements, label):
        """Nodes of the faces of elements with a label; without one, of all that are outside. The
        last entry is None where elements have no such face."""
        for block, base in self.blocks:
            inside = np.isin(block.ids + base, elements)
            nodes = block.nodes[inside] + base
            if not inside.any():
                continue
            if block.dimension < 3 and label in ("SPOS", "SNEG", ""):
                yield nodes.ravel()
            elif block.kind == HEXAHEDRON and label in SIDES:
                yield nodes[:, FACES[SIDES.index(label)]].ravel()
            elif block.kind == HEXAHEDRON and not label:
                yield self._outside(nodes[:, FACES].reshape(-1, 4))
            else:
                yield None
                return

    def _outside(self, faces):
        """The nodes of those faces that belong to one hexahedron only."""
        cells = [b.nodes + base for b, base in self.blocks if b.kind == HEXAHEDRON]
        every = np.concatenate([boundary_faces(np.concatenate(cells)), faces])
        _, first, count = np.unique(
            np.sort(every, axis=1), axis=0, return_index=True, return_counts=True
        )
        return every[first[count > 1]].ravel()

    def nodes_of(self, elements):
        """The sorted nodes of elements."""
        found = [(b.nodes + base)[np.isin(b.ids + base, elements)] for b, base in self.blocks]
        return np.unique(np.concatenate([NONE, *(some.ravel() for some in found)]))
