"""The lines of an Abaqus input file: keywords, their options and their data."""

import re

import numpy as np

from common.errors import InputError
from exchange.foreign_mesh import content, decoded, parsed


class Data:
    """The data lines of a keyword: raw lines, of which the first is line `first` of a file."""

    def __init__(self, path, first, raw):
        self.path, self.first, self.raw = path, first, raw
        self.lines = [line for line in raw if line.strip() and line.lstrip()[:2] != "**"]

    def fields(self):
        """(place, fields) of each line; an empty field after a last comma counts."""
        for number, line in enumerate(self.raw, self.first):
            if line.strip() and line.lstrip()[:2] != "**":
                yield f"{self.path}:{number}", [field.strip() for field in line.split(",")]

    def numbers(self, kind, read):
        """All numbers (n,), and where lines end in them. read: reads a field of a place."""
        lines = [line.rstrip(", \t") for line in self.lines]
        ends = np.cumsum([line.count(",") + 1 for line in lines], dtype=np.int64)
        text = ",".join(lines)
        if lines and not text.translate(_PLAIN):
            found = parsed(text, kind, " , ") if _separated(text) else np.empty(0)
            if len(found) == ends[-1] and (abs(found) < 2**53).all():
                return found, ends
        rows = []
        for place, fields in self.fields():
            while fields and not fields[-1]:
                fields.pop()
            rows.append([read(place, field) for field in fields])
        ends = np.cumsum([len(row) for row in rows], dtype=np.int64)
        return np.array([n for row in rows for n in row], dtype=kind), ends

    def place(self, line):
        """Where a line of `lines` is."""
        return list(self.fields())[line][0]


_PLAIN = str.maketrans("", "", "0123456789+-.eE, \t")


def _separated(text):
    """Whether one comma is between any two numbers."""
    return not re.search(r"[^\s,][ \t]+[^\s,]|,\s*,", text)


def lines_of(path):
    """The lines of a text, whatever ends them. Raises InputError."""
    text = decoded(content(path))
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def keywords(path, before):
    """(keyword, options, Data, place) one by one. before: as for _Reader.read."""
    lines = lines_of(path)
    at = [i for i, line in enumerate(lines) if "*" in line and re.match(r"\s*\*(?!\*)", line)]
    data = Data(path, 1, lines[: at[0] if at else len(lines)])
    if data.lines:
        place, fields = next(data.fields())
        if before is None:
            text = ", ".join(fields)[:40]
            raise InputError(f"{place}: {text!r} comes before the first *KEYWORD")
        yield *before, data, place
    for start, end in zip(at, [*at[1:], len(lines)]):
        line, first = lines[start].strip(), start + 1
        # The keyword's line is continued.
        while line.endswith(",") and first < end and lines[first].strip()[:1].isalpha():
            line, first = line + lines[first].strip(), first + 1
        yield *_parsed(line), Data(path, first + 1, lines[first:end]), f"{path}:{start + 1}"


def _parsed(line):
    """The keyword of a line in capitals, and its options; names keep their case."""
    words = re.findall(r'(?:[^,"]|"[^"]*")+', line[1:])
    options = {}
    for word in words[1:]:
        key, _, value = word.partition("=")
        options[key.strip().upper()] = value.strip().strip('"')
    return " ".join(words[0].upper().split()) if words else "", options


def whole_number(place, text):
    """The whole number of a field. Raises InputError with its place."""
    try:
        number = int(text)
        if abs(number) < 2**63 and "_" not in text:
            return number
    except ValueError:
        pass
    raise InputError(f"{place}: {text!r} must be a whole number")


def real_number(place, text):
    """The number of a field; 0 for an empty one. Raises InputError with its place."""
    try:
        return float(text.upper().replace("D", "E").replace("_", "?")) if text else 0.0
    except ValueError:
        raise InputError(f"{place}: {text!r} must be a number") from None
