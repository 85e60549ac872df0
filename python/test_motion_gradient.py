"""Derivatives of motions against differences of whole runs with the same steps, and an oracle."""

import numpy as np
import pytest
from module_folder import readme_code
from test_gradient import (
    BOX,
    LAWS,
    METHODS,
    SETS,
    difference,
    expect_parameters,
    sample,
)

import sandglass as sg

STEP, STEPS, FRAMES = 2e-3, 50, 5

# The differences have the order four and no tolerance but rounding; a derivative may be small
# beside the largest change of the answer. A longer step passes kinks, where fibres begin to bear.
SHARE, REST = 1e-4, 1e-9


def moving(laws, method="tl-perturbation", tables=(), sets=SETS, velocity=(0.1, 0, 0.2), **change):
    """A body that is driven, pushed and thrown; `change` by what its motion depends on."""
    moved, force, damping = (change.get(key, 0.0) for key in ("moved", "force", "damping"))
    loads = [
        sg.Displacement(set="base", value=(moved, 0, 0)),
        sg.Force(set="side", total=(0.02, 0.1, 0.05)),
        sg.Force(set="one", total=(0.0, 0.05 + force, 0.0), on="nodes"),
        sg.Velocity(set="side", value=np.array(velocity) + [change.get("thrown", 0.0), 0, 0]),
        sg.Dynamics(duration=STEPS * STEP, time_step=STEP, frames=FRAMES, damping=3.0 + damping),
        *tables,
    ]
    sets = sets | {"one": {"x": [0.1, 0.1], "y": [0.1, 0.1], "z": [0.15, 0.15]}}
    body = sg.Body(BOX, laws, loads, sets=sets, element_sets={"low": {"z": [0, 0.1]}})
    return body.solve(name=method)


def laws_of(law, materials):
    return [getattr(sg, law)(**materials[0]), getattr(sg, law)(**materials[1], elements="low")]


HEAD = sg.Displacement(set="head", value=(0.004, 0.02, 0.03))


def weights(solution):
    return np.random.default_rng(1).standard_normal(solution.displacements.shape)


def compare_parameters(law, method):
    rng = np.random.default_rng(3)
    materials = [sample(law, rng), sample(law, rng)]
    solution = moving(laws_of(law, materials), method, [HEAD])
    assert solution.summary["steps"] == STEPS
    of_u = weights(solution)
    found = solution.gradient(of_u).materials

    def J(each):
        return (of_u * moving(laws_of(law, each), method, [HEAD]).displacements).sum()

    expect_parameters(found, law, materials, J, SHARE, REST)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_with_a_potential(method):
    refused = {
        "tl-adaptive": "changes its elements during a motion",
        "linear-condensed": "has no dynamics",
    }
    if method.startswith("ul-"):
        refused[method] = f"'{method}' has no potential"
    if method not in refused:
        compare_parameters("NeoHookean", method)
        return
    materials = [sample("NeoHookean", np.random.default_rng(3))] * 2
    with pytest.raises(sg.InputError, match=refused[method]):
        moving(laws_of("NeoHookean", materials), method).gradient()


@pytest.mark.parametrize("law", LAWS)
def test_every_elastic_law(law):
    if not law.startswith("Viscoelastic"):
        compare_parameters(law, "tl-perturbation")
        compare_parameters(law, "tl-mean-dilatation")
        return
    materials = [sample(law, np.random.default_rng(3))] * 2
    solution = moving(laws_of(law, materials))
    with pytest.raises(sg.InputError, match="derivatives: law 'viscoelastic-.*' remembers"):
        solution.gradient()


KINDS = {
    "dead forces": [HEAD],
    "springs and dashpots": [
        sg.Support(set="side", stiffness=2e4, damping=300),
        sg.Support(set="head", stiffness=1e4, only_normal=True),
    ],
    "a pressure on an open surface": [sg.Pressure(set="side", value=60)],
    "weight, a mass and a rotation": [
        sg.Gravity(value=(0, -2, 0)),
        sg.Mass(set="side", total=0.2),
        sg.Rotation(set="head", axis="z", angle=20, center=(0.05, 0.05, 0)),
    ],
    "hanging nodes": [sg.Refine(elements="low"), HEAD],
    "a load with a curve": [
        sg.Pressure(set="head", value=50, formula="sin(40*t)"),
        sg.Support(set="side", damping=300),
    ],
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("method", ["tl-perturbation", "tl-full", "t4-anp"])
def test_all_that_a_motion_depends_on(kind, method):
    """A modulus, an element's stiffness, a force, a displacement, a velocity, the damping."""
    materials = [sample("NeoHookean", np.random.default_rng(k)) for k in (1, 2)]

    def answer(modulus=0.0, **change):
        laws = laws_of("NeoHookean", materials)
        laws[0].young_modulus += modulus
        return moving(laws, method, KINDS[kind], **change)

    solution = answer()
    of_u = weights(solution)
    found = solution.gradient(of_u)
    one, base, side = (solution.sets[name] for name in ("one", "base", "side"))
    pairs = {
        "modulus": (found.materials[0]["young_modulus"], 1.0),
        "force": (found.forces[one, 1].mean(), 1e-2),
        "moved": (found.imposed[base, 0].sum(), 1e-3),
        "thrown": (found.velocities[side, 0].sum(), 1e-2),
        "damping": (found.damping, 1e-2),
    }
    for name, (derivative, step) in pairs.items():
        own = difference(lambda x: (of_u * answer(**{name: x}).displacements).sum(), step)
        assert derivative == pytest.approx(own, rel=1e-6), name
    low = np.zeros(len(solution.cells), bool)
    low[solution.element_sets["low"]] = True
    by_modulus = materials[0]["young_modulus"] * found.materials[0]["young_modulus"]
    assert found.stiffness[~low].sum() == pytest.approx(by_modulus, rel=1e-7)
    assert not found.velocities[base].any()
    less = solution.gradient(of_u, materials=False)
    assert less.materials is None and np.array_equal(less.stiffness, found.stiffness)
    assert repr(less) == "<sg.Gradient: materials []>"


@pytest.mark.parametrize("velocity", [0.0, 0.3])
def test_a_linear_oscillator(velocity):
    """One free component, for which the derivative has a closed form.

    A linear element of stiffness k and mass m at its end, under a constant force F, moves as
    u_n = F/k (1 - cos n a) + v h sin(n a) / sin a, where sin(a/2) = h/2 sqrt(k/m).
    """
    E, nu, rho, L, A, F, h = 2e3, 0.3, 1000.0, 0.1, 0.05**2, 0.3, 5e-3
    sets = {"base": {"z": [0, 0]}, "end": {"z": [L, L]}}

    loads = [
        sg.Displacement(set="base", value=(0, 0, 0)),
        sg.Displacement(set="end", value=(0, 0, 0), components="xy"),
        sg.Force(set="end", total=(0, 0, F), times=[0.0], factors=[1.0]),
        sg.Velocity(set="end", value=(0, 0, velocity)),
        sg.Dynamics(duration=40 * h, time_step=h, frames=40),
    ]
    law = sg.NeoHookean(young_modulus=E, poisson_ratio=nu, density=rho)
    body = sg.Body(sg.Box(size=(0.05, 0.05, L), elements=(1, 1, 1)), law, loads, sets=sets)
    solution = body.solve(name="linear")
    k = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * A / L
    m = rho * A * L / 2
    n, a = np.arange(41), 2 * np.arcsin(h / 2 * np.sqrt(k / m))
    u = F / k * (1 - np.cos(n * a)) + velocity * h * np.sin(n * a) / np.sin(a)
    end = solution.sets["end"]
    assert np.allclose(solution.displacements[:, end, 2], u[:, None], rtol=1e-11, atol=1e-15)
    by_a = F / k * n * np.sin(n * a)
    by_a += velocity * h * (n * np.cos(n * a) / np.sin(a) - np.sin(n * a) / np.tan(a) / np.sin(a))
    by_E = (by_a * np.tan(a / 2) - F / k * (1 - np.cos(n * a))) / E
    for frame in (1, 2, 17, 40):
        of_u = np.zeros_like(solution.displacements)
        of_u[frame, end, 2] = 0.25  # of the mean of the four nodes
        found = solution.gradient(of_u)
        own = found.materials[0]["young_modulus"]
        assert own == pytest.approx(by_E[frame], rel=1e-8, abs=1e-9 * np.abs(by_E).max())
        by_v = h * np.sin(frame * a) / np.sin(a)
        assert found.velocities[end, 2].sum() == pytest.approx(by_v, rel=1e-10)


def test_a_motion_in_two_segments():
    """1,200 states of this mesh exceed the memory of one segment; those above are one."""
    law = sg.NeoHookean(young_modulus=2e3, poisson_ratio=0.4, density=1000)
    sets = {"base": {"z": [0, 0]}, "head": {"z": [0.1, 0.1]}}
    mesh = sg.Box(size=(0.1, 0.1, 0.1), elements=(12, 12, 12))

    def answer(change=0.0):
        loads = [
            sg.Displacement(set="base", value=(0, 0, 0)),
            sg.Force(set="head", total=(0.1 + change, 0, 0), on="nodes"),
            sg.Dynamics(duration=1.2, time_step=1e-3, ramp_time=0.2, frames=4),
        ]
        return sg.Body(mesh, law, loads, sets=sets).solve()

    solution = answer()
    of_u = weights(solution)
    found = solution.gradient(of_u)
    own = difference(lambda x: (of_u * answer(x).displacements).sum(), 0.01)
    assert found.forces[solution.sets["head"], 0].mean() == pytest.approx(own, rel=1e-6)


def test_the_readme_identifies_a_modulus_and_a_damping():
    """Exactly those with which the motion was made; the minimum is zero."""
    found = {}
    exec(compile(readme_code("Derivatives of motions"), "README.md", "exec"), found)
    assert found["modulus"] == pytest.approx(30e3, rel=1e-5)
    assert found["damping"] == pytest.approx(4.0, rel=1e-4)


def test_wrong_input_and_motions_without_derivatives():
    materials = [sample("NeoHookean", np.random.default_rng(k)) for k in (1, 2)]
    laws = laws_of("NeoHookean", materials)
    solution = moving(laws)
    frames, n = len(solution), len(solution.points)
    assert frames == FRAMES + 1
    nothing = solution.gradient()
    assert not nothing.forces.any() and nothing.damping == 0 and nothing.points is None
    of_start = np.zeros((frames, n, 3))
    of_start[0] = 1  # the undeformed body does not change
    assert not solution.gradient(of_start).velocities.any()
    for arguments, error, words in [
        ({"displacement": np.zeros((n, 3))}, sg.InputError, rf"the shape \({frames}, {n}, 3\)"),
        ({"displacement": np.zeros((frames, n, 2))}, sg.InputError, rf"the shape \({n}, 3\)"),
        ({"displacement": np.full((frames, n, 3), np.nan)}, sg.InputError, "must be finite"),
        ({"displacement": "up"}, (TypeError, sg.InputError), "displacement must"),
        ({"reactions": {"base": (1, 0, 0)}}, sg.InputError, "reactions: not available for motions"),
        ({"points": True}, sg.InputError, "points: not available for motions"),
    ]:
        with pytest.raises(error, match=words):
            solution.gradient(**arguments)
    with pytest.raises(sg.InputError, match="sensitivity: the answer is a motion"):
        solution.sensitivity(forces=np.zeros((n, 3)))
    wall = sg.Obstacle(name="wall", set="side", shape="plane", point=(0.2, 0, 0), normal=(-1, 0, 0))
    with pytest.raises(sg.InputError, match=r"\[\[obstacle\]\] is not supported"):
        moving(laws, tables=[wall]).gradient()
    for settings, words in [
        ({"precision": "float"}, "precision = 'float' is too coarse"),
        ({"subcycles": 4}, "dynamics.subcycles > 1"),
    ]:
        loads = [
            sg.Displacement(set="base", value=(0, 0, 0)),
            sg.Dynamics(duration=0.1, subcycles=settings.get("subcycles", 1)),
        ]
        method = {key: settings[key] for key in settings if key == "precision"}
        body = sg.Body(BOX, laws[0], loads, sets=SETS)
        with pytest.raises(sg.InputError, match=words):
            body.solve(**method).gradient()
