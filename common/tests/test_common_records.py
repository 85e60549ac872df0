"""Documents are validated key by key; messages name file, key, value and rule."""

from dataclasses import dataclass

import pytest

from common.errors import InputError
from common.records import NUMBER, as_dataclass, entries, entry, facts, key


@pytest.mark.parametrize(
    "value, kind, told",
    [
        ("3", int, "'3' must be a whole number"),
        (3.0, int, "3.0 must be a whole number"),
        (True, int, "True must be a whole number"),
        (True, NUMBER, "True must be a number"),
        (1, bool, "1 must be true or false"),
        (None, str, "None must be a text"),
        ([], dict, r"\[\] must be an object"),
        (float("nan"), NUMBER, "nan must be finite"),
        (float("inf"), NUMBER, "inf must be finite"),
    ],
)
def test_others_are_refused(value, kind, told):
    with pytest.raises(InputError, match=f"^a.json: key = {told}$"):
        entry("a.json", {"key": value}, "key", kind)
    with pytest.raises(InputError, match=rf"^a.json: list\[2\].key = {told}"):
        entry("a.json: list[2]", {"key": value}, "key", kind)


def test_lists_of_objects():
    document = {"records": [{"a": 1}, {"a": 2}], "mixed": [{}, 7], "none": {}}
    assert entries("x.json", document, "records") == [
        ("x.json: records[0]", {"a": 1}),
        ("x.json: records[1]", {"a": 2}),
    ]
    for name, told in (
        ("mixed", r"mixed\[1\] = 7 must be an object"),
        ("none", "none = {} must be a list"),
        ("absent", "absent is missing; it must be a list"),
    ):
        with pytest.raises(InputError, match=f"^x.json: {told}"):
            entries("x.json", document, name)


@dataclass(frozen=True)
class Figure:
    """Read by the tests: one object within another."""

    max: float = key("max_error")


@dataclass(frozen=True)
class Run:
    """Read by the tests."""

    case: str
    steps: int
    golden: Figure | None
    truth: Figure | None
    rest: float | None = key("seconds_to_rest")


RECORD = {"case": "c", "steps": 3, "golden": {"max_error": 1}, "truth": None, "seconds_to_rest": 2}


def test_an_object_becomes_a_dataclass():
    assert as_dataclass(Run, "a.json: runs[0]", RECORD) == Run("c", 3, Figure(1), None, 2)
    assert as_dataclass(Run, "a.json", RECORD | {"case": 3}, case="known").case == "known"


@pytest.mark.parametrize(
    "changed, told",
    [
        ({"steps": 1.5}, "steps = 1.5 must be a whole number"),
        ({"golden": 0.1}, "golden = 0.1 must be an object or null"),
        ({"golden": {"max": 1}}, "golden.max_error is missing; it must be a number"),
        ({"seconds_to_rest": "2"}, "seconds_to_rest = '2' must be a number or null"),
    ],
)
def test_an_object_of_another_kind_is_refused(changed, told):
    with pytest.raises(InputError, match=rf"^a.json: runs\[0\].{told}$"):
        as_dataclass(Run, "a.json: runs[0]", RECORD | changed)


def test_facts_are_what_is_no_list_and_no_object():
    document = {"revision": "r", "threads": 2, "records": [], "machine": {}, "none": None}
    assert facts(document) == {"revision": "r", "threads": "2"}
