"""Richardson's extrapolation is exact on sequences with a known limit, and its result is stored."""

import math
import re

import h5py
import numpy as np
import pytest

import convergence
from convergence import attributes_of, richardson
from reference_file import (
    KINDS,
    NOT_ESTIMATED,
    path_of,
    read_reference,
    stored,
    write_estimate,
    write_reference,
)

GENERATOR = np.random.default_rng(5)
LIMIT, COEFFICIENT = GENERATOR.normal(size=(2, 7, 3))
STORED = [(kind, name) for kind in KINDS for name in stored(kind)]


def sequence(order, meshes, first=1.0):
    """Fields LIMIT + COEFFICIENT h^order for h = first, first/2, ..."""
    return [LIMIT + COEFFICIENT * (first / 2**n) ** order for n in range(meshes)]


@pytest.mark.parametrize("order", [1.1, 1.37, 2.0, 3.0])
@pytest.mark.parametrize("meshes", [3, 4, 5])
def test_order_and_limit_of_a_power_are_found(order, meshes):
    found = richardson(sequence(order, meshes), assumed_order=7.0)
    # Differences of numbers of size 1, the last of them 2^-15 of it, in double precision.
    assert found.order == pytest.approx(order, abs=1e-10)
    assert found.origin == "measured"
    assert np.abs(found.limit - LIMIT).max() < 1e-10


def test_two_meshes_take_the_assumed_order():
    coarse, fine = sequence(2.0, 2)
    found = richardson([coarse, fine], assumed_order=2.0)
    assert (found.order, found.origin) == (2.0, "assumed")
    assert np.abs(found.limit - LIMIT).max() < 1e-14
    # The error of the coarse field is 4/3 of the difference, that of the fine one 1/3.
    difference = fine - coarse
    assert np.allclose(found.limit - coarse, 4 / 3 * difference, rtol=1e-12)
    assert np.allclose(found.limit - fine, difference / 3, rtol=1e-12)


def test_only_the_finest_three_show_the_order():
    disturbed = sequence(2.0, 4)
    disturbed[0] = disturbed[0] + 100.0
    found = richardson(disturbed, assumed_order=1.0)
    assert found.order == pytest.approx(2.0, abs=1e-12)


def test_lower_orders_than_an_elastic_edge_allows_are_not_used():
    fields = sequence(0.3, 3)
    found = richardson(fields, assumed_order=2.0)
    assert found.order == 1.0
    assert found.origin == "the lowest, measured 0.30"
    # At order 1 the error of the finest field equals its difference from the previous one.
    assert np.allclose(found.limit - fields[2], fields[2] - fields[1], rtol=1e-12)


def test_sequences_that_do_not_converge_have_no_limit():
    assert richardson([LIMIT], 2.0) is None
    assert richardson([LIMIT, LIMIT + 1, LIMIT - 1], 2.0) is None
    assert richardson([LIMIT, LIMIT + 1, LIMIT + 1], 2.0) is None


def test_attributes_hold_the_distance_of_the_stored_field_from_the_limit():
    fields = sequence(2.0, 3)
    for field, share in ((fields[0], 1.0), (fields[2], 1 / 16)):
        found = attributes_of(fields, field, unit=0.5, reason="no reason")
        distance = share * np.linalg.norm(COEFFICIENT, axis=1) / 0.5
        assert found["own_error_max"] == pytest.approx(distance.max(), rel=1e-9)
        assert found["own_error_rms"] == pytest.approx(np.sqrt((distance**2).mean()), rel=1e-9)
        assert found["own_error_order"] == pytest.approx(2.0, abs=1e-9)
        assert found["own_error_note"].endswith("3 meshes; order 2.00: measured")


def test_a_missing_estimate_has_a_reason():
    found = attributes_of([LIMIT], LIMIT, unit=1.0, reason="a mesh of 9 cells would cost too much")
    assert math.isnan(found["own_error_max"]) and math.isnan(found["own_error_order"])
    assert found["own_error_note"] == "not estimated: a mesh of 9 cells would cost too much"
    apart = attributes_of([LIMIT, LIMIT + 1, LIMIT - 1], LIMIT, unit=1.0, reason="-")
    assert apart["own_error_note"] == "not estimated: differences do not fall"


def test_splits_stay_below_the_largest_number_of_cells():
    for cells in (1, 5, 160, 270, 1100, 1500, 10**6):
        splits = convergence.splits_of(cells)
        assert splits == 0 or cells * 8**splits <= convergence.MOST_CELLS
        assert (
            splits == convergence.MOST_SPLITS or cells * 8 ** (splits + 1) > convergence.MOST_CELLS
        )


def test_an_estimate_does_not_change_the_displacement(tmp_path):
    source = path_of("golden", "column")
    points, displacement, attributes = read_reference(source)
    path = tmp_path / "golden.h5"
    write_reference(path, points, displacement, attributes | NOT_ESTIMATED)

    def chunk():
        with h5py.File(path, "r") as file:
            return file["displacement"].id.read_direct_chunk((0, 0))

    before = chunk()
    write_estimate(path, NOT_ESTIMATED | {"own_error_max": 0.25, "own_error_note": "a test"})
    assert chunk() == before
    _, after, found = read_reference(path)
    assert (after == displacement).all()
    assert (found["own_error_max"], found["own_error_note"]) == (0.25, "a test")
    assert {name: found[name] for name in found if name not in NOT_ESTIMATED} == {
        name: attributes[name] for name in attributes if name not in NOT_ESTIMATED
    }


@pytest.mark.parametrize("kind, name", STORED)
def test_every_stored_result_has_an_estimate_or_a_reason(kind, name):
    _, _, attributes = read_reference(path_of(kind, name))
    note = attributes["own_error_note"]
    if "not estimated: " in note:
        assert math.isnan(attributes["own_error_max"]) and "has not been run" not in note
        return
    assert attributes["own_error_max"] >= attributes["own_error_rms"] > 0
    assert attributes["own_error_order"] >= convergence.LOWEST_ORDER
    truth = "(inside .* %.*, edges|edges alone): "  # truth.py: the parts of its bar
    assert re.match((truth if kind == "truth" else "") + "Richardson's extrapolation of ", note)
