"""Derivatives of static answers against differences of the answers themselves."""

import ast
import zlib

import numpy as np
import pytest
from module_folder import readme_code

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
    """Parameters of any declared law: moduli of 1 to 2 kPa, bulk moduli of ten times that."""
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


def expect_parameters(found, law, materials, J, share, rest):
    """Expects the derivatives by all parameters to be differences of J(materials).

    share: the step over the scale of a parameter. rest: the error of the differences over the
    largest of them.
    """
    own, scales = {}, {}
    for m, material in enumerate(materials):
        assert set(found[m]) == set(declared(law))
        for name, (ends, unit) in declared(law).items():

            def answer(change):
                moved = [dict(each) for each in materials]
                moved[m][name] += change
                return J(moved)

            scales[m, name] = scale(ends, unit, material[name])
            own[m, name] = difference(answer, share * scales[m, name])
    largest = max(abs(own[key]) * scales[key] for key in own)
    assert largest > 0
    for m, name in own:
        error = abs(found[m][name] - own[m, name])
        allowed = 1e-6 * abs(own[m, name]) + rest * largest / scales[m, name]
        assert error <= allowed, (m, name, found[m][name], own[m, name])


def compare_parameters(law, name, **method):
    """`name` and further arguments of `Body.solve`."""
    method = {"name": name} | method
    rng = np.random.default_rng(zlib.crc32(law.encode()))
    materials = [sample(law, rng), sample(law, rng)]
    solution = body(law, materials).solve(**method)
    of_u, of_R, J = scalar(solution.displacement.shape)
    found = solution.gradient(of_u, of_R).materials
    expect_parameters(
        found, law, materials, lambda each: J(body(law, each).solve(**method)), SHARE, REST
    )


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


@pytest.mark.parametrize("law", LAWS)
def test_every_law(law):
    compare_parameters(law, "tl-perturbation")
    if not law.startswith("Viscoelastic"):
        compare_parameters(law, "tl-mean-dilatation")
        compare_parameters(law, "tl-enhanced")


KINDS = {
    "springs and a rotation": [
        sg.Support(set="side", stiffness=2e4),
        sg.Rotation(set="end", axis="z", angle=20, center=(0.05, 0.05, 0)),
    ],
    "hanging nodes and weight": [sg.Refine(elements="low"), sg.Gravity(value=(0, -2, 0))],
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("method", ["tl-perturbation", "t4-anp", "linear"])
def test_loads_imposed_displacements_and_elements(kind, method):
    """A force on a node, an element's stiffness, and the displacement of a driven set."""
    materials = [sample("NeoHookean", np.random.default_rng(k)) for k in (1, 2)]
    named = SETS | {"one": {"x": [0.1, 0.1], "y": [0.1, 0.1], "z": [0.15, 0.15]}}
    if "rotation" in kind:
        named["end"] = named.pop("head")

    def made(force=0.0, moved=0.0, stiffer=0.0):
        loads = [
            sg.Displacement(set="base", value=(moved, 0, 0)),
            sg.Force(set="side", total=(0.2, 0.3, 0.1)),
            sg.Force(set="one", total=(0.05, 0.05 + force, 0), on="nodes"),
            sg.Relaxation(tolerance=1e-12),
            *KINDS[kind],
        ]
        low = {"elements": "low"}
        laws = [sg.NeoHookean(**materials[0]), sg.NeoHookean(**materials[1] | low)]
        modulus = 1500 * (1 + stiffer)  # never that of others, with which t4-anp would average it
        laws.append(sg.NeoHookean(**materials[0] | {"young_modulus": modulus, "elements": "third"}))
        rules = {
            "low": {"z": [0, 0.1]},
            "third": {"x": [0, 0.05], "y": [0.05, 0.1], "z": [0.15, 0.2]},
        }
        return sg.Body(BOX, laws, loads, sets=named, element_sets=rules)

    solution = made().solve(name=method)
    rng = np.random.default_rng(5)
    of_u, of_R = rng.standard_normal(solution.displacement.shape), rng.standard_normal(3) * 1e-2

    def J(**change):
        answer = made(**change).solve(name=method)
        return (of_u * answer.displacement).sum() + of_R @ answer.reactions["base"]

    found = solution.gradient(of_u, {"base": of_R})
    one, base = solution.sets["one"], solution.sets["base"]
    third = solution.element_sets["third"]
    assert len(one) == 1 and len(third) == 1
    pairs = {
        "force": (found.forces[one[0], 1], 1e-2),
        "moved": (found.imposed[base, 0].sum(), 1e-3),
        "stiffer": (found.stiffness[third[0]], 1e-2),
    }
    for name, (derivative, step) in pairs.items():
        own = difference(lambda x: J(**{name: x}), step)
        assert derivative == pytest.approx(own, rel=1e-6), name
    free = np.ones(len(of_u), bool)
    free[
        np.concatenate([solution.sets[name] for name in named if name in ("base", "end", "head")])
    ] = False
    assert not found.imposed[free].any() and found.imposed[base].all()
    # Forward sensitivities are the same derivatives.
    force, imposed = np.zeros_like(of_u), np.zeros_like(of_u)
    force[one[0], 1] = 1
    imposed[base, 0] = 1
    only_u = solution.gradient(of_u)
    along = {
        "force": (solution.sensitivity(forces=force), only_u.forces[one[0], 1]),
        "imposed": (solution.sensitivity(imposed=imposed), only_u.imposed[base, 0].sum()),
        "modulus": (
            solution.sensitivity([{}, {"young_modulus": 1.0}, {}]),
            only_u.materials[1]["young_modulus"],
        ),
    }
    for name, (du, derivative) in along.items():
        assert (of_u * du).sum() == pytest.approx(derivative, rel=1e-7), name
    assert np.allclose(along["imposed"][0][base], [1, 0, 0])


def test_a_kappa_that_was_chosen():
    compare_parameters("NeoHookean", "tl-perturbation", kappa=0.2, kappa_modulus="shear")


def test_like_materials_share_averages():
    """Elements that average over nodes do so within like materials; derivatives keep that."""
    material = sample("NeoHookean", np.random.default_rng(7))
    solution = body("NeoHookean", [material] * 2).solve(name="t4-anp")
    of_u, of_R, J = scalar(solution.displacement.shape)
    found = [own["young_modulus"] for own in solution.gradient(of_u).materials]
    for m in range(2):
        du = solution.sensitivity([{"young_modulus": float(n == m)} for n in range(2)])
        assert (of_u * du).sum() == pytest.approx(found[m], rel=1e-7)

    def answer(change):
        stiffer = material | {"young_modulus": material["young_modulus"] + change}
        moved = body("NeoHookean", [stiffer] * 2).solve(name="t4-anp").displacement
        return (of_u * moved).sum()

    assert sum(found) == pytest.approx(difference(answer, 1.0), rel=1e-6)


def test_a_parameter_at_the_end_of_its_range():
    """Zero may not be passed, so both differences go upwards."""
    rng = np.random.default_rng(6)
    materials = [sample("MooneyRivlin", rng) | {"c01": 0.0}, sample("MooneyRivlin", rng)]
    solution = body("MooneyRivlin", materials).solve()
    of_u, of_R, J = scalar(solution.displacement.shape)

    def answer(c01):
        return J(body("MooneyRivlin", [materials[0] | {"c01": c01}, materials[1]]).solve())

    weights, step = np.array([-25, 48, -36, 16, -3]) / 12, 0.5
    own = sum(w * answer(k * step) for k, w in enumerate(weights)) / step
    assert solution.gradient(of_u, of_R).materials[0]["c01"] == pytest.approx(own, rel=1e-6)
    du = solution.sensitivity([{"c01": 1.0}, {}])
    found = solution.gradient(of_u).materials[0]["c01"]
    assert (of_u * du).sum() == pytest.approx(found, rel=1e-7)


def test_wrong_input_and_answers_without_derivatives():
    """Exceptions name the argument and the rule, or the reason."""
    materials = [sample("NeoHookean", np.random.default_rng(k)) for k in (1, 2)]
    solution = body("NeoHookean", materials).solve()
    n = len(solution.points)
    for arguments, error, words in [
        (
            {"displacement": np.zeros((n, 2))},
            sg.InputError,
            rf"displacement must have the shape \({n}, 3\)",
        ),
        ({"displacement": np.full((n, 3), np.nan)}, sg.InputError, "displacement must be finite"),
        ({"displacement": "up"}, TypeError, "displacement must be an array of numbers"),
        (
            {"reactions": {"side": (1, 0, 0)}},
            sg.InputError,
            "'side' is no driven set; allowed: base, head",
        ),
        (
            {"reactions": {"head": (np.inf, 0, 0)}},
            sg.InputError,
            "reactions: 'head' must be finite",
        ),
        (
            {"reactions": {"head": (1, 2)}},
            sg.InputError,
            r"reactions: 'head' must have the shape \(3,\), but has \(2,\)",
        ),
        ({"reactions": [1, 2, 3]}, TypeError, "reactions must be a dict from sets to arrays"),
        ({"reactions": {3: (1, 2, 3)}}, TypeError, "a name in reactions must be a text"),
        ({"points": "all"}, TypeError, "points must be True or False, but is a str"),
    ]:
        with pytest.raises(error, match=words):
            solution.gradient(**arguments)
    for arguments, words in [
        ({"materials": [{}]}, "1 were given; it must be one for each of the 2 of the body"),
        (
            {"materials": [{}, {"mu": 1.0}]},
            "'mu' is not a parameter of 'neo-hookean'; allowed: young_modulus, poisson",
        ),
        ({"materials": [{}, {"young_modulus": np.nan}]}, "young_modulus must be finite"),
        ({"forces": np.zeros(3)}, "forces must have the shape"),
        ({"imposed": np.zeros((1, 3))}, "imposed must have the shape"),
    ]:
        with pytest.raises(sg.InputError, match=words):
            solution.sensitivity(**arguments)
    for changes, words in [
        ("soft", "materials must be a list of dicts, but is a str"),
        ([{}, 3], r"materials\[1\] must be a dict, but is a int"),
        ([{}, {"young_modulus": "soft"}], r"materials\[1\]: young_modulus must be an array of num"),
    ]:
        with pytest.raises(TypeError, match=words):
            solution.sensitivity(changes)
    nothing = solution.gradient(np.zeros((n, 3)))
    assert not nothing.forces.any() and nothing.materials[0]["young_modulus"] == 0
    wall = sg.Obstacle(name="wall", set="side", shape="plane", point=(0.2, 0, 0), normal=(-1, 0, 0))
    for table, method, words in [
        (
            sg.Pressure(set="side", value=10),
            {},
            r"\[\[pressure\]\] is not supported, for .*potential",
        ),
        (wall, {}, r"\[\[obstacle\]\] is not supported"),
        (
            sg.Relaxation(tolerance=1e-4),
            {"precision": "float"},
            "precision = 'float' is too coarse",
        ),
    ]:
        made = body("NeoHookean", materials)
        made.tables = [
            t for t in made.tables if type(t) is not type(table) and type(t) is not sg.Relaxation
        ]
        made.tables.append(table)
        with pytest.raises(sg.InputError, match=words):
            made.solve(**method).gradient()


def test_an_unstable_answer_has_no_derivatives():
    """A compressed, straight column of a law whose stability the search does not decide."""
    law = sg.StVenantKirchhoff(young_modulus=3e3, poisson_ratio=0.3, density=1000)
    sets = {"base": {"z": [0, 0]}, "head": {"z": [0.2, 0.2]}}

    def column(down):
        loads = [
            sg.Displacement(set="base", value=(0, 0, 0)),
            sg.Displacement(set="head", value=(0, 0, -down)),
        ]
        return sg.Body(sg.Box(size=(0.02, 0.02, 0.2), elements=(2, 2, 20)), law, loads, sets=sets)

    sideways = np.zeros((9 * 21, 3))
    sideways[:, 0] = 1
    assert column(1e-4).solve().gradient(sideways).forces[:, 0].sum() > 0
    with pytest.raises(sg.ComputationError, match="unstable|not solved"):
        column(0.01).solve().gradient(sideways)


def test_derivatives_of_large_and_small_numbers():
    """A gradient is linear in its weights, whose squares need not be numbers."""
    solution = body("NeoHookean", [sample("NeoHookean", np.random.default_rng(k)) for k in (1, 2)])
    solution = solution.solve()
    weights = np.random.default_rng(3).standard_normal(solution.points.shape)
    one = solution.gradient(weights, {"head": (0.01, 0, 0)})
    for size in (1e-160, 1e160, 1e250):
        found = solution.gradient(size * weights, {"head": (0.01 * size, 0, 0)})
        for name in ("forces", "imposed", "stiffness"):
            scaled, own = getattr(found, name) / size, getattr(one, name)
            assert np.abs(scaled - own).max() < 1e-8 * np.abs(own).max(), (size, name)


def test_the_readme_identifies_two_moduli():
    """Exactly those with which its displacements were made: the tolerance of the search is 1e-8."""
    code = readme_code("Derivatives")
    found = {}
    exec(compile(code, "README.md", "exec"), found)
    assert np.allclose(found["moduli"], [12e3, 30e3], rtol=1e-6)
    start = found["body"]([20e3, 20e3]).solve().displacement
    assert np.abs(start - found["measured"]).max() > 0.1 * np.abs(start).max()
