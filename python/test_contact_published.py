"""Published values of two deformable bodies in slow motion with friction: half-spheres, a twist."""

import numpy as np
import pytest
from lattice import lattice

import sandglass as sg


def held(name, components="xyz"):
    """A set that stays where it is, in some directions."""
    return sg.Displacement(set=name, value=(0, 0, 0), components=components)


def octant(n, radii):
    """Points (m) and cells of an octant of a hollow sphere, 3 n^2 elements in each layer."""
    angle = np.tan(np.linspace(0, np.pi / 4, n + 1))
    v, u = (a.ravel() for a in np.meshgrid(angle, angle))
    patch = np.stack([np.ones_like(u), u, v], axis=-1)
    patch /= np.linalg.norm(patch, axis=1)[:, None]
    directions = np.concatenate([np.roll(patch, k, axis=1) for k in range(3)])
    _, first, place = np.unique(
        np.round(directions, 9) + 0.0, axis=0, return_index=True, return_inverse=True
    )
    node = place.reshape(3, n + 1, n + 1)
    square = [node[:, b : n + b, a : n + a].ravel() for b, a in ((0, 0), (1, 0), (1, 1), (0, 1))]
    quads, sphere = np.stack(square, axis=-1), directions[first]
    sphere[np.abs(sphere) < 1e-12] = 0
    points = np.concatenate([r * sphere for r in radii])
    layers = [
        np.hstack([quads + k * len(sphere), quads + (k + 1) * len(sphere)])
        for k in range(len(radii) - 1)
    ]
    return points, np.concatenate(layers)


def force_of_plate(friction, depths, duration):
    """The force (N) on a quarter of the plate that presses half-spheres, in mm, at depths (mm)."""
    n, radii = 4, np.array([10.0, 11.0, 12.0])
    (points, cells), (others, _) = octant(n, radii), octant(n, radii + 2)
    first, of_sphere = len(points), len(points) // len(radii)
    points, cells = np.concatenate([points, others]), np.concatenate([cells, cells + first])
    nodes = np.arange(len(points))
    sets = {name: nodes[points[:, axis] == 0] for axis, name in enumerate("xyz")}
    sets |= {
        "inner": nodes[first - of_sphere : first],
        "outer": nodes[first : first + of_sphere],
        "skin": nodes[-of_sphere:],
    }
    loads = [held(name, name) for name in "xyz"] + [
        sg.Obstacle(name="plate", set="skin", shape="plane", point=(0, 0, 14), normal=(0, 0, -1)),
        sg.Contact(name="pair", set="inner", other="outer", friction=friction),
        sg.Dynamics(duration=duration, damping=0.05),
    ]
    law = sg.CompressibleNeoHookean(young_modulus=1.0, poisson_ratio=0.3, density=1.0)
    plate = sg.Body(sg.Mesh(points, cells, sets), law, loads).simulation(method="tl-enhanced")
    forces = []
    for depth in depths:
        plate.move("plate", (0, 0, -depth))
        plate.advance(depth / max(depths) * duration - plate.time)
        forces.append(-plate.reaction("plate")[2])
    return np.array(forces)


def test_half_spheres_slide_on_each_other_between_plates():
    """Puso and Laursen 2004, with friction .5: 1.32, 1.93 and 2.58 N in a quarter at 3, 4, 5 mm.

    FEBio and Abaqus differ by 3.5 %. Found: -1.1, -.7 and -2.0 %. Twice the speed adds 1.8 %.
    Friction adds force (2 to 5 mm), as published.
    """
    depths = np.array([2.0, 3.0, 4.0, 5.0])
    rough = force_of_plate(0.5, depths, 2500.0)
    assert rough[1:] == pytest.approx([1.32, 1.93, 2.58], rel=0.07)
    assert (rough > force_of_plate(0.0, depths, 2500.0)).all()
    fast = force_of_plate(0.5, depths, 1250.0)
    assert rough[1:] == pytest.approx(fast[1:], rel=0.07 / 3)


def bowl_on_block(n, layers, edges):
    """Points (m), cells and sets of a block and of half a hollow sphere on it, dome down.

    The block is a cube of 2 m with edges^3 elements, its top at z = -1; the sphere has the radii 1
    and 2/3 around the origin, in four octants with 3 n^2 elements in each layer.
    """
    sphere, cells = octant(n, np.linspace(2 / 3, 1, layers + 1))
    points, all_cells = [], []
    for quarter in range(4):
        x, y, z = sphere.T
        for _ in range(quarter):
            x, y = -y, x
        points.append(np.stack([x, y, -z], axis=-1))
        all_cells.append(cells[:, [4, 5, 6, 7, 0, 1, 2, 3]] + quarter * len(sphere))
    points, all_cells = np.concatenate(points), np.concatenate(all_cells)
    _, first, place = np.unique(
        np.round(points, 8) + 0.0, axis=0, return_index=True, return_inverse=True
    )
    bowl, bowl_cells = points[first], place.ravel()[all_cells]
    s = np.linspace(-1, 1, edges + 1)
    across = np.sign(s) * (0.55 * np.abs(s) + 0.45 * s**2)
    down = -1 - 2 * np.linspace(1, 0, edges + 1) ** 1.3
    block, block_cells, _ = lattice(across, across, down)
    all_points = np.concatenate([block, bowl])
    nodes, r = np.arange(len(all_points)), np.linalg.norm(all_points, axis=1)
    is_bowl, z = nodes >= len(block), all_points[:, 2]
    sets = {
        "foot": nodes[~is_bowl & (z < -3 + 1e-9)],
        "deck": nodes[~is_bowl & (z > -1 - 1e-9)],
        "dome": nodes[is_bowl & (r > 1 - 1e-6)],
        "rim": nodes[is_bowl & (np.abs(z) < 1e-9)],
    }
    elements = {"block": np.arange(edges**3)}
    cells = np.concatenate([block_cells, bowl_cells + len(block)])
    return all_points, cells, sets, elements


def test_a_stiff_bowl_twists_on_a_block():
    """Sauer and De Lorenzis 2015, Zimmerman and Ateshian 2018 (FEBio): within 3 % of both.

    The rim is pressed down by 1 m, then friction sets in, and it turns, slowly: its nodes are
    driven one by one. Found: force +.6 % at first, torque within 1 % up to 60 degrees and 2 % above
    the band at 100; with 2.7 times the elements -.6, 1 and .5 %.
    """
    pressing, friction_from, turning = 40.0, 50.0, 400.0  # s, the last for 180 degrees
    points, cells, sets, elements = bowl_on_block(n=5, layers=2, edges=12)
    rim = {f"rim {n}": np.array([n]) for n in sets.pop("rim")}
    loads = [held("foot"), *(held(name) for name in rim)]
    loads += [
        sg.Contact(
            name="pair",
            set="deck",
            other="dome",
            friction=0.5,
            times=[friction_from, friction_from + 0.01],
            factors=[0.0, 1.0],
        ),
        sg.Dynamics(duration=friction_from, damping=0.15),
    ]
    laws = [
        sg.CompressibleNeoHookean(young_modulus=E, poisson_ratio=0.3, density=1.0, elements=name)
        for E, name in ((1.0, "block"), (5.0, ""))
    ]
    mesh = sg.Mesh(points, cells, sets | rim)
    body = sg.Body(mesh, laws, loads, element_sets=elements).simulation(method="tl-enhanced")

    def drive(depth, angle, seconds):
        """Moves the rim there; returns the force (N) and the torque (N m) on it."""
        c, s = np.cos(angle), np.sin(angle)
        force = torque = 0.0
        places = {}
        for name, (node,) in rim.items():
            x, y, _ = points[node]
            places[name] = c * x - s * y, s * x + c * y
            body.move(name, (places[name][0] - x, places[name][1] - y, -depth))
        body.advance(seconds)
        for name, (x, y) in places.items():
            fx, fy, fz = body.reaction(name)
            force -= fz
            torque += x * fy - y * fx
        return force, torque

    for depth in np.linspace(0, 1, 41)[1:]:
        drive(depth, 0.0, pressing / 40)
    force, torque = drive(1.0, 0.0, friction_from - pressing)
    assert force == pytest.approx(1.2296, rel=0.03)
    assert abs(torque) < 0.003  # of .4
    bands = {20: (0.1443, 0.1455), 30: (0.2087, 0.2117), 60: (0.3545, 0.3578)}
    plateau = []
    for angle in range(2, 122, 2):
        force, torque = drive(1.0, np.radians(angle), turning / 90)
        assert 0.97 * 1.2296 < force < 1.03 * 1.2820, angle
        if angle in bands:
            low, high = bands[angle]
            assert 0.97 * low < torque < 1.03 * high, angle
        if angle >= 100:
            plateau.append(torque)
    assert 0.97 * 0.4012 < np.mean(plateau) < 1.03 * 0.4098
