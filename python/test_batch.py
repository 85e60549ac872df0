"""Bodies in a batch move as an sg.Simulation of each would."""

import threading

import numpy as np
import pytest

import sandglass as sg

BODIES, FRAMES, SECONDS = 11, 4, 0.08  # more bodies than fit into a register, which has 8
STIFFNESS = np.linspace(0.5, 1.5, BODIES)
FACTORS = np.linspace(0.0, 1.0, BODIES)
COURSE = np.linspace(0, 1, FRAMES + 1)[1:]
HEAD = 0.01 * np.arange(1, BODIES + 1)[:, None] / BODIES * [1, 0, -1]  # where each head goes


def body(*more, law=None, stiffness=1.0):
    modulus = 3000.0 * stiffness
    law = law or sg.NeoHookean(young_modulus=modulus, poisson_ratio=0.45, density=1000.0)
    box = sg.Box(size=(0.1, 0.1, 0.2), elements=(2, 2, 4))
    sets = {
        "base": {"z": [0, 0]},
        "head": {"z": [0.2, 0.2]},
        "side": {"x": [0.1, 0.1], "z": [0.05, 0.15]},
    }
    fixed = [sg.Displacement(set=name, value=(0, 0, 0)) for name in ("base", "head")]
    loads = [*fixed, sg.Force(set="side", total=(0.05, 0, 0)), sg.Dynamics(duration=1, damping=3)]
    return sg.Body(box, law, [*loads, *more], sets=sets)


@pytest.mark.parametrize("precision, rounding", [("double", 2.0**-53), ("float", 2.0**-24)])
def test_bodies_move_as_each_would_alone(precision, rounding):
    """Sums have another order, and the batch multiplies by the stiffness afterwards: a force is a
    sum of 24 numbers, its rounding displaces a node by at most that share of the motion, and grows
    with the square of the steps, in float, where such a bound hides mistakes, with their number.
    The steps of one alone are longer where it is softer, so all take those of the stiffest body:
    many `advance`s, each of one step."""
    batch = body().batch(BODIES, precision=precision)
    batch.scale_stiffness(STIFFNESS)
    steps = int(np.ceil(1.2 * SECONDS / FRAMES / batch.step_size)) * FRAMES
    paths = HEAD[:, None, :] * np.linspace(0, 1, steps + 1)[1:][None, :, None]
    factors = FACTORS[:, None] * np.linspace(0, 1, steps + 1)[1:]
    found = batch.run(SECONDS, steps, factors=factors, driven={"head": paths})
    assert found.shape == (BODIES, steps, 45, 3)
    limit = 24 * rounding * (steps**2 if precision == "double" else steps)
    for b in range(BODIES):
        alone = body(stiffness=STIFFNESS[b]).simulation(precision=precision)
        for k in range(steps):
            alone.impose(factors[b, k])
            alone.move("head", paths[b, k])
            alone.advance(SECONDS / steps)
        u = alone.displacements[alone.rows]
        assert np.abs(found[b, -1] - u).max() < limit * 0.02
        force = alone.reaction("head")
        assert np.abs(batch.reaction("head")[b] - force).max() < 10 * limit * np.abs(force).max()
    assert np.array_equal(batch.displacements, found[:, -1])
    assert batch.time == pytest.approx(SECONDS, rel=1e-12)


def test_targets_and_factors_come_in_several_shapes():
    """Bits are the same, however what is the same is given."""
    made = body()
    nodes = len(made.solve().sets["head"])
    paths = HEAD[:, None, :] * COURSE[None, :, None]
    each = np.repeat(paths[:, :, None, :], nodes, axis=2)
    given = [
        {"driven": {"head": paths}, "factors": FACTORS, "stiffness": np.full(BODIES, 2)},
        {"driven": {"head": each}, "factors": FACTORS[:, None] * COURSE, "stiffness": 2},
    ]
    one, other = (made.batch(BODIES).run(SECONDS, FRAMES, **g) for g in given)
    assert np.array_equal(one, other)
    by_hand = made.batch(BODIES)
    by_hand.scale_stiffness(2)
    for k in range(FRAMES):
        by_hand.impose(FACTORS * (k + 1) / FRAMES)
        by_hand.move("head", paths[:, k])
        by_hand.advance(SECONDS / FRAMES)
        assert np.array_equal(by_hand.displacements, one[:, k])
    twisted = each.copy()
    twisted[:, :, 0] *= 0.5  # one node stays behind
    found = made.batch(BODIES, threads=2).run(SECONDS, FRAMES, driven={"head": twisted})
    head = made.batch(1).nodes("head")
    assert np.array_equal(found[:, -1][:, head], twisted[:, -1])


LAWS = [n for n, c in sg.tables.CLASSES.items() if c._declared["table"] == "material"]


@pytest.mark.parametrize("name", LAWS)
def test_bodies_have_parameters_of_their_own(name):
    """Of every law that batches take; each parameter differs between bodies. See above for why
    there are many `advance`s, and for the rounding."""
    cls = getattr(sg, name)
    keys = [k for k in cls._keys.values() if k["type"] == "number" and k["count"] == 1]
    keys = [k for k in keys if k["name"] != "density"]
    if name.startswith("Viscoelastic") or "fibre_direction" in cls._keys:
        directions = {"fibre_direction": (1, 0, 1)} if "fibre_direction" in cls._keys else {}
        sample = {k["name"]: 0.3 for k in keys}
        with pytest.raises(sg.InputError, match="a batch takes isotropic elastic laws"):
            body(law=cls(density=1000.0, **directions, **sample)).batch(2)
        return
    parameters = {}
    for n, key in enumerate(keys):
        pressure = 1e4 if "bulk" in key["name"] else 1e3
        value = 0.4 if key["name"] == "poisson_ratio" else pressure if key["unit"] == "Pa" else 3.0
        parameters[key["name"]] = value * (1 + 0.02 * (n + 1) * np.linspace(0, 1, BODIES))
    laws = [cls(density=1000.0, **{k: v[b] for k, v in parameters.items()}) for b in range(BODIES)]
    batch = body(law=laws[0]).batch(BODIES)
    batch.set_parameters(parameters)
    steps = int(np.ceil(1.2 * SECONDS / batch.step_size))
    paths = HEAD[:, None, :] * np.linspace(0, 1, steps + 1)[1:][None, :, None]
    found = batch.run(SECONDS, steps, driven={"head": paths})
    for b in range(BODIES):
        alone = body(law=laws[b]).simulation()
        for k in range(steps):
            alone.move("head", paths[b, k])
            alone.advance(SECONDS / steps)
        u = alone.displacements[alone.rows]
        assert np.abs(found[b, -1] - u).max() < 24 * 2.0**-53 * steps**2 * 0.02
    same = body(law=laws[0]).batch(BODIES).run(SECONDS, steps, driven={"head": paths})
    assert np.abs(same[1:] - found[1:]).max() > 1e-6
    again = body(law=laws[0]).batch(BODIES)
    again = again.run(SECONDS, steps, driven={"head": paths}, materials=[parameters])
    assert np.array_equal(again, found)


def test_a_law_with_numbers_for_elements_takes_numbers_for_bodies_and_elements():
    """(bodies, elements), or (bodies,) for all elements of the law."""
    law = {"poisson_ratio": 0.4, "density": 1000.0}
    moduli = 3000.0 * (1 + np.arange(3 * 16).reshape(3, 16) / 48)
    course = np.linspace(0, 1, 21)[1:, None]  # each frame takes one step

    def run(law, bodies=slice(3), **given):
        batch = body(law=law).batch(len(HEAD[bodies]))
        return batch.run(0.02, 20, driven={"head": HEAD[bodies, None] * course}, **given)

    varying = sg.NeoHookean(young_modulus=moduli[0], **law)
    one = run(sg.NeoHookean(young_modulus=3000.0, **law), materials={"young_modulus": moduli[:, 0]})
    whole = run(varying, materials={"young_modulus": moduli[:, 0]})
    assert np.abs(whole - one).max() < 1e-12
    each = run(varying, materials=[{"young_modulus": moduli}])
    for b in range(3):
        alone = run(sg.NeoHookean(young_modulus=moduli[b], **law), slice(b, b + 1))
        assert np.abs(each[b] - alone[0]).max() < 1e-12
    assert np.abs(each[1] - whole[1]).max() > 1e-5


def test_what_a_batch_cannot_is_refused_by_name():
    for made, words in [
        (body(sg.Pressure(set="side", value=1.0)), r"remove \[\[pressure\]\]"),
        (body(sg.Method(name="tl-adaptive")), "'tl-adaptive' does not run in a batch; choose one"),
    ]:
        with pytest.raises(sg.InputError, match=words):
            made.batch(3)
    with pytest.raises(TypeError, match="poisson_ratio"):
        body().batch(3).run(0.1, 1, poisson_ratio=[0.3, 0.4, 0.45])


@pytest.mark.parametrize(
    "use, words",
    [
        (lambda b: b.run(0.1, 2, stiffness=[1, 2]), r"stiffness must have the shape \(3,\)"),
        (lambda b: b.run(0.1, 2, stiffness=[1, -2, 1]), "stiffness must be positive, but has -2"),
        (
            lambda b: b.run(0.1, 2, factors=np.ones((2, 3))),
            r"factors must have the shape \(3,\) or",
        ),
        (lambda b: b.run(0.1, 0), "frames = 0 must be in"),
        (lambda b: b.run(0.1, 2.5), "frames must be an integer"),
        (lambda b: b.run(-0.1, 2), "seconds = -0.05"),
        (
            lambda b: b.run(0.1, 2, driven={"head": np.ones((3, 1, 3))}),
            r"'head' must have the shape",
        ),
        (lambda b: b.run(0.1, 2, driven={"haed": np.ones((3, 2, 3))}), "did you mean 'head'"),
        (lambda b: b.move("side", (0, 0, 1)), "set 'side' has no driven node"),
        (lambda b: b.move("head", (0, 0, np.nan)), "displacements must be finite"),
        (lambda b: b.move("head", "far"), "displacements must be an array of numbers"),
        (lambda b: b.move("head", np.ones((4, 3))), r"\(3,\) or \(3, 3\) or \(3, 9, 3\)"),
        (lambda b: b.impose([[1], [2, 3]]), "factors must be an array of numbers"),
        (lambda b: b.reaction(1), "set must be a text, but is a int"),
        (
            lambda b: b.advance("long"),
            "seconds must be an array of numbers|seconds must be a number",
        ),
        (lambda b: b.set_parameters(3), "materials must be a list of dicts, but is a int"),
        (lambda b: b.set_parameters([3]), r"materials\[0\] must be a dict, but is a int"),
        (
            lambda b: b.set_parameters({"young_modulus": [1, 2]}),
            r"materials\[0\]: young_modulus must have the shape \(3,\), but has \(2,\)",
        ),
        (
            lambda b: b.set_parameters([{}, {}]),
            "materials: 2 were given; it must be one for each of the 1 of the body",
        ),
        (
            lambda b: b.set_parameters({"poisson_ratio": [0.4, 0.5, 0.4]}),
            r"material 0, body 1: poisson_ratio = 0.5 must be in \(-1, 0.5\)",
        ),
        (
            lambda b: b.set_parameters({"mu": 1}),
            "'mu' is not a parameter of 'neo-hookean'; allowed: young_modulus, poisson_ratio",
        ),
        (lambda b: body().batch(0), r"bodies = 0 must be in \[1, 1000000\]"),
        (lambda b: body().batch(2.0), "bodies must be an integer"),
        (lambda b: body().batch(2, precision="half"), "'half' must be 'double' or 'float'"),
    ],
)
def test_wrong_arguments_are_named(use, words):
    with pytest.raises((TypeError, sg.InputError), match=words):
        use(body().batch(3))


def test_an_inverted_body_is_named_and_others_may_not_use_a_busy_batch():
    batch = body().batch(3)
    refused, done = [], threading.Event()

    def look():
        while not done.is_set():
            try:
                batch.time
            except RuntimeError as error:
                refused.append(str(error))
                return

    thread = threading.Thread(target=look)
    thread.start()
    try:
        batch.advance(2000.0)  # hundreds of thousands of steps
    finally:
        done.set()
        thread.join()
    assert refused == ["the batch is busy in another thread"]
    with pytest.raises(sg.ComputationError, match="body 1"):
        batch.move("head", [(0, 0, 0), (0, 0, -1), (0, 0, 0)])
        batch.advance(1.0)
