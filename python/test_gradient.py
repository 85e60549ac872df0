"""Derivatives of static answers against differences of the answers themselves."""

import ast
import zlib

import numpy as np
import pytest

import sandglass as sg

BOX = sg.Box(size=(0.1, 0.1, 0.2), elements=(2, 2, 4))
SETS = {"base": {"z": [0, 0]}, "head": {"z": [0.2, 0.2]}, "side": {"x": [0.1, 0.1]}}
LAWS = [n for n, c in sg.tables.CLASSES.items() if c._declared["table"] == "material"]
METHODS = sg.Method._keys["name"]["allowed"].split(", ")

# The differences have the order four. Answers are exact to 1e-12, which leaves 1e-8 of the largest
# change of an answer; a derivative may be small beside it.
SHARE, REST = 1e-3, 1e-8


def declared(law):
    """The parameters of the derivatives: name -> ends of their range, unit."""
    keys = getattr(sg, law)._keys.values()
    numbers = [k for k in keys if k["type"] == "number" and k["count"] == 1]
    ends = {k["name"]: k["allowed"][1:-1].replace("inf", "1e999").split(", ") for k in numbers}
    units = {k["name"]: k["unit"] for k in numbers}
    return {n: ([*map(ast.literal_eval, ends[n])], units[n]) for n in ends if n != "density"}


def scale(ends, unit, value):
    """A length over which answers vary with a parameter."""
    least = min(value - ends[0], ends[1] - value)
    return least if np.isfinite(least) else max(abs(value), 300.0 if unit == "Pa" else 1.0)


def sample(law, rng):
    """Parameters of a law, for any declaration: moduli of 1 to 2 kPa, bulk moduli of ten times that."""
    parameters = {"density": 1000.0}
    if "fibre_direction" in getattr(sg, law)._keys:
        parameters |= {"fibre_direction": [1, 0, 1], "sheet_direction": [0, 1, 0]}
    for name, (ends, unit) in declared(law).items():
        size = 1 + rng.random()
        if np.isfinite(ends[1]):  # Poisson's ratios, shares
            parameters[name] = ends[1] * (0.4 if ends[1] < 1 else 0.2) * size
        else:
            parameters[name] = size * (10e3 if "bulk" in name else 1e3 if unit == "Pa" else 2.0)
    return parameters


def body(law, materials, total=(0, 0.3, 0.1), head=(0.004, 0.02, 0.03), *tables):
    loads = [
        sg.Displacement(set="base", value=(0, 0, 0)),
        sg.Displacement(set="head", value=head),
        sg.Force(set="side", total=total),
        sg.Relaxation(tolerance=1e-12),
        *tables,
    ]
    laws = [getattr(sg, law)(**materials[0]), getattr(sg, law)(**materials[1], elements="low")]
    return sg.Body(BOX, laws, loads, sets=SETS, element_sets={"low": {"z": [0, 0.1]}})


def scalar(shape):
    """dJ/du and dJ/dR of a scalar J, and J."""
    rng = np.random.default_rng(1)
    of_u, of_R = rng.standard_normal(shape), {"head": 0.01 * rng.standard_normal(3)}
    return of_u, of_R, lambda s: (of_u * s.displacement).sum() + of_R["head"] @ s.reactions["head"]


def difference(answer, step):
    """The derivative at 0 of answer(x)."""
    near = answer(step) - answer(-step)
    far = answer(2 * step) - answer(-2 * step)
    return (8 * near - far) / (12 * step)


def compare_parameters(law, method):
    rng = np.random.default_rng(zlib.crc32(law.encode()))
    materials = [sample(law, rng), sample(law, rng)]
    solution = body(law, materials).solve(name=method)
    of_u, of_R, J = scalar(solution.displacement.shape)
    found = solution.gradient(of_u, of_R).materials
    own, scales = {}, {}
    for m, material in enumerate(materials):
        assert set(found[m]) == set(declared(law))
        for name, (ends, unit) in declared(law).items():

            def answer(change):
                moved = [dict(each) for each in materials]
                moved[m][name] += change
                return J(body(law, moved).solve(name=method))

            scales[m, name] = scale(ends, unit, material[name])
            own[m, name] = difference(answer, SHARE * scales[m, name])
    largest = max(abs(own[key]) * scales[key] for key in own)
    for m, name in own:
        error = abs(found[m][name] - own[m, name])
        allowed = 1e-6 * abs(own[m, name]) + REST * largest / scales[m, name]
        assert error <= allowed, (m, name, found[m][name], own[m, name])
    return solution, found


@pytest.mark.parametrize("method", METHODS)
def test_every_method_with_a_potential(method):
    why = {"tl-none": "does not resist hourglass modes", "ul-viscous": "no equilibrium"}
    if method not in why and not method.startswith("ul-"):
        compare_parameters("NeoHookean", method)
        return
    made = body("NeoHookean", [sample("NeoHookean", np.random.default_rng(2))] * 2)
    with pytest.raises(Exception, match=why.get(method, f"'{method}' has no potential")) as caught:
        made.solve(name=method).gradient()
    assert caught.type in (sg.InputError, sg.ComputationError)


@pytest.mark.parametrize("method", ["tl-perturbation", "tl-mean-dilatation", "tl-enhanced"])
@pytest.mark.parametrize("law", LAWS)
def test_every_law(law, method):
    compare_parameters(law, method)
