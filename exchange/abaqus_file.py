"""Reads Abaqus and CalculiX input files (.inp): the mesh, its sets and its surfaces.

meshio is not used: it ends a list of nodes at a comment, lets a second *NODE, or a second *NSET of
the same name, replace the first, drops sets made of sets, mixes up the blocks of element sets, and
rejects lower-case types.
"""

import difflib
import re
from collections import Counter

import numpy as np

from common.errors import InputError
from exchange.abaqus_sets import NONE, Part, Resolver
from exchange.abaqus_text import Data, keywords, lines_of, real_number, whole_number
from exchange.foreign_mesh import HEXAHEDRON, SCOPE, Block, ForeignMesh

GENERATING = ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM")
AS_NSET = "; list its nodes as *NSET if the case needs them"
SURFACES = ("SFM", "CPS", "CPE", "CAX")  # without meaning of their own in three dimensions
VOLUME = re.compile(r"(A?C|D?C|Q|G|GK|COH|E)3D\d|SC[68]R|CSS8|C3D")
BRICK = re.compile(r"C3D8[A-Z]*")
# The digits of a type are the number of its nodes, except those of beams and of one shell.
NODES = re.compile(r"(?!V?U\d)[A-Z]+?(?:[23]D)?(\d+)")
EXCEPTIONS = {"21": 2, "22": 3, "23": 2, "31": 2, "32": 3, "33": 2, "65": 6}


def read(path):
    """The ForeignMesh of an .inp file: sets of nodes and of elements become node sets, those of
    elements element sets as well; of the same name in the same part, the set of nodes counts. The
    nodes of a surface are a set, too.

    Parts are read where *INSTANCE places them. As in Abaqus, names are not case-sensitive; the
    first spelling is kept. Raises InputError naming the line.
    """
    reader = _Reader()
    reader.read(path, 0, None)
    return reader.mesh(path)


class _Reader:
    def __init__(self):
        self.model = self.part = Part("")
        self.parts, self.instances, self.notes = {}, [], []
        self.unread = {}  # keyword -> where it is first
        self.assembly = Part("Assembly")

    def read(self, path, depth, before):
        """Reads all keywords of a file and of the files it includes. before: the keyword and the
        options that the first data lines belong to, or None. Returns the same for the lines that
        follow. Raises InputError."""
        for keyword, options, data, where in keywords(path, before):
            if keyword == "INCLUDE":
                if depth > 9 or not options.get("INPUT"):
                    raise InputError(f"{where}: *INCLUDE needs INPUT=FILE, nested at most ten deep")
                before = self.read(path.parent / options["INPUT"], depth + 1, before)
                if not data.lines:
                    continue
                keyword, options = before or (keyword, options)
            before = keyword, options
            if file := options.get("INPUT"):
                if data.lines:
                    raise InputError(f"{where}: *{keyword} has both INPUT and data lines")
                other = path.parent / file
                data = Data(other, 1, lines_of(other))
            if keyword in GENERATING:
                raise InputError(
                    f"{where}: *{keyword} is not supported; write all nodes and elements"
                )
            if read := getattr(self, "_read_" + keyword.lower().replace(" ", "_"), None):
                read(options, data, where)
            elif not keyword.startswith(("END ", "HEADING")):
                self.unread.setdefault(keyword, where)
        return before

    def _read_part(self, options, data, where):
        name = options.get("NAME", "").upper()
        if name in self.parts:
            raise InputError(f"{where}: *PART: '{name}' is given twice; names must differ")
        self.part = self.parts[options.get("NAME", "").upper()] = Part(options.get("NAME", ""))

    def _read_assembly(self, options, data, where):
        self.part = self.assembly
        self.assembly.name = options.get("NAME") or "Assembly"

    def _read_instance(self, options, data, where):
        name, source = options.get("NAME", ""), self.parts.get(options.get("PART", "").upper())
        if not name or source is None:
            known = ", ".join(part.name for part in self.parts.values()) or "none"
            raise InputError(f"{where}: *INSTANCE needs NAME= and PART=, of {known}")
        if self.part in self.parts.values():
            raise InputError(f"{where}: *INSTANCE: parts hold no instances; close *PART before it")
        if name.upper() in [part.name.upper() for part in self.instances]:
            raise InputError(f"{where}: *INSTANCE: '{name}' is given twice; names must differ")
        rows = [
            [real_number(at, field) for field in fields if field] for at, fields in data.fields()
        ]
        if [len(row) for row in rows] not in ([], [3], [3, 7]):
            raise InputError(
                f"{where}: *INSTANCE: a line of three numbers (translation) and one of seven "
                "(two points of an axis, an angle) are allowed"
            )
        self.part = Part(name)
        for key in ("ids", "blocks"):
            setattr(self.part, key, list(getattr(source, key)))
        self.part.points = [_placed(points, rows, where) for points in source.points]
        self.part.sets = {
            kind: {key: (spelled, list(entries)) for key, (spelled, entries) in sets.items()}
            for kind, sets in source.sets.items()
        }
        self.instances.append(self.part)

    def _read_end_part(self, options, data, where):
        self.part = self.model

    _read_end_assembly = _read_end_part

    def _read_end_instance(self, options, data, where):
        self.part = self.assembly

    def _read_node(self, options, data, where):
        if options.get("SYSTEM", "R").upper() != "R":
            raise InputError(f"{where}: *NODE, SYSTEM: rectangular coordinates are required")
        table, ends = data.numbers(float, real_number)
        whole = (table[::4] == np.round(table[::4])) & (abs(table[::4]) < 2**53)
        if (np.diff(ends, prepend=0) == 4).all() and whole.all():
            table = table.reshape(-1, 4)
            ids, points = table[:, 0].astype(np.int64), table[:, 1:]
        else:
            ids, points = [], []
            short = []
            for place, fields in data.fields():
                while len(fields) > 4 and not fields[-1]:
                    fields.pop()
                if len(fields) not in (3, 4, 7) or fields[:3].count(""):
                    raise InputError(
                        f"{place}: {', '.join(fields)!r}: a node needs an id and three coordinates"
                    )
                short += [place] if len(fields) == 3 or not fields[3] else []
                ids.append(whole_number(place, fields[0]))
                xyz = [real_number(place, field) for field in fields[1:4]]
                points.append(xyz + [0.0] * (3 - len(xyz)))
            if short:
                rule = "have fewer than three coordinates, the first here; the missing ones are 0"
                self.notes.append(f"{short[0]}: {len(short)} of {len(ids)} nodes {rule}")
        self.part.ids.append(np.array(ids, dtype=np.int64))
        self.part.points.append(np.array(points).reshape(-1, 3))
        if name := options.get("NSET"):
            self.part.add("NSET", name, where, self.part.ids[-1])

    def _read_element(self, options, data, where):
        kind = options.get("TYPE", "").upper()
        if not kind:
            raise InputError(f"{where}: *ELEMENT needs TYPE=")
        brick, digits = BRICK.fullmatch(kind), NODES.match(kind)
        numbers, ends = data.numbers(np.int64, whole_number)
        width = 1 + EXCEPTIONS.get(digits[1], int(digits[1])) if digits else 0
        starts = np.concatenate([[0], ends[:-1]])
        wanted = np.arange(0, len(numbers), width) if width else starts
        continued = [line.rstrip()[-1] == "," for line in data.lines]
        if width and len(numbers) % width == 0 and np.isin(wanted, starts).all():
            rows = [numbers.reshape(-1, width)]
        elif brick:
            # The first line at which no element begins, or after which one is too short.
            lost = np.setdiff1d(wanted, starts)
            at = max(0, int(np.searchsorted(ends, lost[0])) if len(lost) else len(ends) - 1)
            place = data.place(at)
            raise InputError(f"{place}: {kind} needs an id and eight nodes for each element")
        elif any(continued):
            place = data.place(continued.index(True))
            raise InputError(
                f"{place}: ends with a comma; where its element ends is unknown for type {kind}"
            )
        else:
            alike = {}
            for row in np.split(numbers, ends[:-1]):
                alike.setdefault(len(row), []).append(row)
            rows = [np.array(some) for some in alike.values()]
        dimension = 3 if VOLUME.match(kind) else 2
        for table in rows if data.lines else ():
            block = Block(
                HEXAHEDRON if brick else kind, dimension, table[:, 0].copy(), table[:, 1:]
            )
            self.part.blocks.append(block)
            if name := options.get("ELSET"):
                self.part.add("ELSET", name, where, block.ids)

    def _read_nset(self, options, data, where, kind="NSET"):
        name, instance = options.get(kind), options.get("INSTANCE", "")
        if not name:
            raise InputError(f"{where}: *{kind} needs a name: {kind}=NAME")
        # In the assembly, what belongs to an instance is `instance.name`.
        if instance and instance.upper() not in [part.name.upper() for part in self.instances]:
            raise InputError(f"{where}: *{kind}: there is no instance '{instance}' before it")
        self.part.add(kind, name, where)
        if kind == "NSET" and options.get("ELSET"):
            self.part.add(kind, name, where, ("ELSET", options["ELSET"]), instance=instance)
        for place, fields in data.fields():
            while fields and not fields[-1]:
                fields.pop()
            if "" in fields:
                raise InputError(f"{place}: *{kind}: a member is missing between two commas")
            if "GENERATE" in options:
                ends = [whole_number(place, field) for field in fields]
                step = ends[2] if len(ends) == 3 else 1
                if not 2 <= len(ends) <= 3 or step < 1 or ends[1] < ends[0]:
                    raise InputError(f"{place}: GENERATE needs first, last, and a positive step")
                entries = [range(ends[0], ends[1] + 1, step)]
            elif all(field.isdigit() for field in fields):
                entries = [np.array([whole_number(place, f) for f in fields], dtype=np.int64)]
            else:
                entries = [
                    np.array([whole_number(place, f)]) if f.lstrip("+-").isdigit() else f
                    for f in fields
                ]
            self.part.add(kind, name, place, *entries, instance=instance)

    def _read_elset(self, options, data, where):
        self._read_nset(options, data, where, "ELSET")

    def _read_surface(self, options, data, where):
        """Surfaces of nodes and of elements; others stay without entries, which is a note."""
        name, kind = options.get("NAME"), options.get("TYPE", "ELEMENT").upper()
        if not name:
            raise InputError(f"{where}: *SURFACE needs a name: NAME=")
        if kind not in ("NODE", "ELEMENT") or "COMBINE" in options:
            rule = "only TYPE=NODE and TYPE=ELEMENT without COMBINE are read"
            self.notes.append(f"{where}: surface '{name}': {rule}{AS_NSET}")
            return
        self.part.add("SURFACE", name, where)
        for place, (target, *more) in data.fields():
            label = more[0].upper() if more and kind == "ELEMENT" else kind.removeprefix("ELEMENT")
            entry = np.array([whole_number(place, target)]) if target.isdigit() else target
            self.part.add("SURFACE", name, place, (label, entry))

    def _ignored(self):
        """Notes on the keywords that are not read, and on elements that have no volume."""
        known = [name[6:].upper().replace("_", " ") for name in dir(self) if name[:6] == "_read_"]
        words = []
        for keyword, where in self.unread.items():
            near = difflib.get_close_matches(keyword, known, 1, 0.8)
            hint = f", did you mean *{near[0]}?" if near else ""
            words.append(f"*{keyword} ({where.rpartition('/')[2]}{hint})")
        if words:
            rule = "materials, constraints, ties and loads are given by the case"
            yield f"not read: {', '.join(words)}; {rule}"
        kinds = Counter()
        for part in [self.model, self.assembly, *self.instances]:
            for block in part.blocks:
                if block.dimension < 3 and not block.kind.startswith(SURFACES):
                    kinds[block.kind] += len(block.ids)
        if kinds:
            words = ", ".join(f"{count} of type {kind}" for kind, count in kinds.items())
            yield f"elements that are no hexahedra define sets, without stiffness or mass: {words}"

    def mesh(self, path):
        """The ForeignMesh. Raises InputError where a set names what does not exist."""
        if self.parts and not self.instances:
            if len(self.parts) > 1:
                names = ", ".join(part.name for part in self.parts.values())
                raise InputError(f"{path}: parts {names} are not placed; *INSTANCE is required")
            self.instances = list(self.parts.values())
        everywhere = [self.model, *self.instances, self.assembly]
        spaces = [part for part in everywhere if part.ids or part.blocks]
        single = len(spaces) < 2
        first = {id(part): (0 if single else i * SCOPE) for i, part in enumerate(spaces)}
        ids, points, blocks, sets, element_sets = [NONE], [np.empty((0, 3))], [], {}, {}
        self.model.name = "Model" if self.instances else ""
        for part in spaces:
            base = first[id(part)]
            if not single and any((abs(some) >= SCOPE).any() for some in part.ids):
                raise InputError(f"{path}: numbers of nodes must be less than {SCOPE}")
            ids += [some + base for some in part.ids]
            points += part.points
            blocks += [
                Block(b.kind, b.dimension, b.ids + base, b.nodes + base) for b in part.blocks
            ]
        resolver, spelled = Resolver(everywhere, first), {}
        for part in everywhere:
            for key, (name, _) in (part.sets["ELSET"] | part.sets["NSET"]).items():
                spelled.setdefault(key, name)
            for key in part.sets["ELSET"]:
                name = spelled[key]
                found = resolver.members(part, "ELSET", key, path)
                element_sets[part.name, name] = found
                if key not in part.sets["NSET"]:  # a node set of the same name takes precedence
                    sets[part.name, name] = resolver.nodes_of(found)
            for key in part.sets["NSET"]:
                sets[part.name, spelled[key]] = resolver.members(part, "NSET", key, path)
            for key, (name, _) in part.sets["SURFACE"].items():
                nodes, why = resolver.surface(part, key)
                scope = f"{part.name}.Surface" if part.name else "Surface"
                if why:
                    self.notes.append(why + AS_NSET)
                else:
                    sets[scope, name] = nodes
        names = [] if single else [part.name for part in spaces]
        return ForeignMesh(
            np.concatenate(ids),
            np.concatenate(points),
            _joined(blocks),
            sets,
            element_sets=element_sets,
            scopes=names,
            notes=[*self._ignored(), *self.notes],
        )


def _placed(points, rows, where):
    """Points moved and then turned, as the data lines of *INSTANCE say."""
    if rows:
        points = points + rows[0]
    if len(rows) < 2:
        return points
    start, end, angle = np.array(rows[1][:3]), np.array(rows[1][3:6]), np.radians(rows[1][6])
    length = np.linalg.norm(end - start)
    if not length > 0:
        raise InputError(f"{where}: *INSTANCE: the two points of the axis must differ")
    axis, arm = (end - start) / length, points - start
    along = np.outer(arm @ axis, axis)
    turned = along + np.cos(angle) * (arm - along) + np.sin(angle) * np.cross(axis, arm)
    return start + turned


def _joined(blocks):
    """The blocks; blocks of the same kind and width are joined."""
    alike = {}
    for block in blocks:
        alike.setdefault((block.kind, block.dimension, block.nodes.shape[1]), []).append(block)
    return [
        Block(
            kind,
            dimension,
            np.concatenate([b.ids for b in some]),
            np.concatenate([b.nodes for b in some]),
        )
        for (kind, dimension, _), some in alike.items()
    ]
