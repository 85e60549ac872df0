"""The tables of case files."""

from common.files import read_toml
from common.records import entry


def read_tables(path):
    """The tables of every case in a file, with variants merged in: case name -> dict.

    path: str or Path of a TOML file. A file without [variants] has one case. Raises InputError.
    """
    tables = read_toml(path)
    family = entry(f"{path}: case", entry(path, tables, "case", dict), "name", str)
    cases = {family: tables}
    for axis in tables.pop("variants", {}).values():
        longer = {}
        for name, so_far in cases.items():
            for variant in axis:
                merged = _merged(so_far, {k: v for k, v in variant.items() if k != "name"})
                longer[f"{name}-{variant['name']}"] = merged
        cases = longer
    return cases


def _merged(tables, changes):
    """Tables with changes applied: nested tables are merged, other values replaced."""
    merged = dict(tables)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(tables.get(key), dict)
        merged[key] = _merged(tables[key], value) if both else value
    return merged
