"""Parameters of laws that differ from element to element, as arrays."""

import numpy as np
import pytest

import sandglass as sg

LAW = {"poisson_ratio": 0.4, "density": 1000.0}
SETS = {"base": {"z": [0, 0]}, "head": {"z": [0.2, 0.2]}}
LOADS = [sg.Displacement(set="base", value=(0, 0, 0)), sg.Force(set="head", total=(0.3, 0.1, 0.2))]
GENERATOR = sg.Box(size=(0.1, 0.1, 0.2), elements=(2, 2, 4))
MODULI = 3000.0 * (1 + np.arange(16) / 16)


def body(law, mesh=GENERATOR, **more):
    exact = sg.Relaxation(tolerance=1e-11)
    return sg.Body(mesh, law, [*LOADS, exact], sets=SETS, **more)


@pytest.fixture(scope="module")
def varying():
    return body(sg.NeoHookean(young_modulus=MODULI, **LAW))


def test_it_is_the_body_with_a_law_for_each_element(varying):
    """The same case, so the same bits. In the other order of elements the answer differs."""
    sets = {f"e{n}": [n] for n in range(16)}
    laws = [sg.NeoHookean(young_modulus=E, elements=f"e{n}", **LAW) for n, E in enumerate(MODULI)]
    by_hand = body(laws, element_sets=sets).solve()
    found = varying.solve()
    assert np.array_equal(found.displacement, by_hand.displacement)
    turned = body(sg.NeoHookean(young_modulus=MODULI[::-1], **LAW)).solve()
    assert np.abs(turned.displacement - found.displacement).max() > 1e-4


def test_equal_moduli_are_one_modulus():
    """Up to the tolerance of the search."""
    u = [
        body(sg.NeoHookean(young_modulus=E, **LAW)).solve().displacement
        for E in (3000.0, np.full(16, 3000.0))
    ]
    assert np.abs(u[1] - u[0]).max() < 1e-9 * np.abs(u[0]).max()


def test_a_law_of_a_set_has_numbers_for_its_elements(varying):
    """In the order in which the set was given, sorted or not."""
    mesh = sg.Mesh.of(GENERATOR)
    height = mesh.points[mesh.cells][:, :, 2].mean(axis=1)
    high, low = np.flatnonzero(height > 0.1)[::-1], np.flatnonzero(height < 0.1)
    laws = [
        sg.NeoHookean(young_modulus=MODULI[high], elements="high", **LAW),
        sg.NeoHookean(young_modulus=MODULI[low], elements="low", **LAW),
    ]
    found = body(laws, element_sets={"high": high, "low": low}).solve()
    expected = varying.solve()
    assert np.abs(found.displacement - expected.displacement).max() < 1e-9
    weights = np.ones_like(found.points)
    one, other = expected.gradient(weights).materials[0], found.gradient(weights).materials
    for part, elements in zip(other, (high, low)):
        a, b = part["young_modulus"], one["young_modulus"][elements]
        assert np.allclose(a, b, rtol=1e-6, atol=1e-6 * np.abs(b).max())
    ratio = sum(part["poisson_ratio"] for part in other)
    assert ratio == pytest.approx(one["poisson_ratio"], rel=1e-6)


def test_derivatives_by_each_modulus(varying):
    """The force of an element is proportional to its modulus, hourglass control included, so the
    derivative times the modulus is that by the factor of its stiffness: 1e-9 for roundings of two
    linear solutions. And central differences, with an error of 1e-6 of the largest."""
    solution = varying.solve()
    weights = np.zeros_like(solution.points)
    weights[solution.sets["head"], 0] = 1.0
    gradient = solution.gradient(weights)
    by_modulus = gradient.materials[0]["young_modulus"]
    largest = np.abs(gradient.stiffness).max()
    assert np.allclose(by_modulus * MODULI, gradient.stiffness, rtol=0, atol=1e-9 * largest)
    along = np.sin(np.arange(16))  # both signs
    change = solution.sensitivity({"young_modulus": along * MODULI})
    assert (weights * change).sum() == pytest.approx(along @ (by_modulus * MODULI), rel=1e-7)
    h = 1e-4
    ends = [
        body(sg.NeoHookean(young_modulus=MODULI * (1 + s * h * along), **LAW)).solve().displacement
        for s in (1, -1)
    ]
    difference = (ends[0] - ends[1]) / (2 * h)
    assert np.abs(difference - change).max() < 1e-6 * np.abs(change).max()
    assert solution.sensitivity({"poisson_ratio": 1.0}).shape == weights.shape


def test_it_is_saved_with_its_mesh_and_read_again(varying, tmp_path):
    varying.save(tmp_path / "varying.toml")
    again = sg.Body.read(tmp_path / "varying.toml")
    assert np.array_equal(again.solve().displacement, varying.solve().displacement)
    assert varying.simulation().step_size == again.simulation().step_size


@pytest.mark.parametrize(
    "made, words",
    [
        (lambda: body(sg.NeoHookean(young_modulus=MODULI[:5], **LAW)), r"shape \(16,\)"),
        (lambda: body(sg.NeoHookean(young_modulus=[], **LAW)), "young_modulus must be a number"),
        (lambda: body(sg.NeoHookean(young_modulus=-MODULI, **LAW)), "young_modulus = -3000"),
        (
            lambda: body(
                sg.NeoHookean(young_modulus=MODULI, elements="low", **LAW),
                element_sets={"low": {"z": [0, 0.1]}},
            ),
            "need `elements`, a set that is an array",
        ),
    ],
)
def test_wrong_arrays_are_named(made, words):
    with pytest.raises(sg.InputError, match=words):
        made().solve()


def test_wrong_changes_are_named(varying):
    with pytest.raises(sg.InputError, match=r"young_modulus must be a number or have the shape"):
        varying.solve().sensitivity({"young_modulus": MODULI[:3]})
