"""What an element and its hourglass control do to an identified stiffness.

Usage: /usr/bin/python3 bench/identified_stiffness.py [--json FILE]
Two measurements are made up with tl-mean-dilatation, the golden's element, on a fine mesh: how far
the silicone beam of cases/silicone-beam.toml bends under 102 g, and the force with which a plate
indents a block by a tenth. Young's modulus is then identified with every method, on coarser
meshes, and for some kappas. Everything else is known, and nothing is noisy: what differs from the
modulus of the measurement is the bias of the element. Needs the Python module.
Exit codes: 0 done, 2 bad usage or input.
"""

import sys
from pathlib import Path

if __name__ == "__main__":
    TREE = Path(__file__).resolve().parent.parent
    sys.path[1:1] = [
        str(TREE),
        str(TREE / "examples" / "python"),
        str(TREE / "build" / "release" / "python"),
    ]

import sandglass as sg
from common.command import command_line, option
from common.files import write_json
from silicone_beam import beam, sinking

GOLDEN = "tl-mean-dilatation"
NO_CONTROL = ("tl-none", "ul-viscous")  # hourglass modes are not resisted at rest
KAPPAS = (0.0002, 0.001, 0.005, 0.02, 0.1)
MODULUS = 276e3  # Pa; the bias does not depend on it: forces and moduli scale alike in `indented`
MASS = 0.1021  # kg
DEPTH = 0.1  # of the indentation, over the height
STEPS, AGREEMENT = 30, 1e-6


def bent(elements, modulus, method):
    """The mean sinking (m) of the markers of the silicone beam."""
    solution = beam(modulus, MASS, elements).solve(**method)
    return sinking(solution, solution.displacement).mean()


def indented(elements, modulus, method):
    """The force (N) with which a plate on the middle of a block's upper side indents it.

    A quarter of the block, 0.1 m wide and high as a whole; the plate is half as wide, and sticks.
    """
    sets = {"x": {"x": [0, 0]}, "y": {"y": [0, 0]}, "bottom": {"z": [0, 0]}}
    sets["plate"] = {"x": [-1e-9, 0.025], "y": [-1e-9, 0.025], "z": [0.1, 0.1]}
    tables = [
        sg.Displacement(set="x", value=(0, 0, 0), components="x"),
        sg.Displacement(set="y", value=(0, 0, 0), components="y"),
        sg.Displacement(set="bottom", value=(0, 0, 0)),
        sg.Displacement(set="plate", value=(0, 0, -0.1 * DEPTH)),
    ]
    law = sg.NeoHookean(young_modulus=modulus, poisson_ratio=0.49, density=1000)
    mesh = sg.Box(size=(0.05, 0.05, 0.1), elements=elements)
    return sg.Body(mesh, law, tables, sets=sets).solve(**method).reactions["plate"][2]


# The experiment -> (what is measured, its sign of growth with the modulus, fine mesh, coarse ones)
SCENES = {
    "bent beam": (bent, -1, (40, 12, 12), ((5, 2, 2), (10, 3, 3), (20, 6, 6))),
    "indented block": (indented, 1, (24, 24, 48), ((2, 2, 4), (4, 4, 8), (8, 8, 16))),
}


def identified(measure, sign, elements, method, measured):
    """The modulus (Pa) with which a method on a mesh gives the measured value.

    Displacements fall and forces rise almost in proportion to the modulus, so that the ratio of
    values corrects it; each step leaves a tenth of the error or less.
    """
    modulus = MODULUS
    for _ in range(STEPS):
        ratio = measured / measure(elements, modulus, method)
        modulus *= ratio**sign
        if abs(ratio - 1) < AGREEMENT:
            return modulus
    raise sg.ComputationError(f"no modulus after {STEPS} steps")


def study():
    """Yields records: scene, elements, method, kappa (None: the default), bias (None: failed)."""
    names = sg.Method._keys["name"]["allowed"].split(", ")
    methods = [{"name": name} for name in names if name not in NO_CONTROL]
    methods += [{"name": "tl-perturbation", "kappa": kappa} for kappa in KAPPAS]
    for scene, (measure, sign, fine, coarse) in SCENES.items():
        measured = measure(fine, MODULUS, {"name": GOLDEN})
        for elements in coarse:
            for method in methods:
                try:
                    modulus = identified(measure, sign, elements, method, measured)
                    bias = modulus / MODULUS - 1
                except (sg.ComputationError, sg.InputError) as error:
                    print(f"{scene}: {method}: {error}", file=sys.stderr)
                    bias = None
                yield {
                    "scene": scene,
                    "elements": list(elements),
                    "method": method["name"],
                    "kappa": method.get("kappa"),
                    "bias": bias,
                }


def run(options):
    """Prints a line for each record, and writes them."""
    records = []
    for found in study():
        records.append(found)
        kappa = "" if found["kappa"] is None else f" kappa {found['kappa']:g}"
        bias = "failed" if found["bias"] is None else f"{100 * found['bias']:+.2f} %"
        mesh = " x ".join(map(str, found["elements"]))
        print(f"{found['scene']}, {mesh}, {found['method']}{kappa}: {bias}", flush=True)
    if options.json:
        write_json(options.json, {"reference": f"{GOLDEN} on a fine mesh", "records": records})


main = command_line(
    run,
    __doc__,
    option("--json", metavar="FILE", type=Path, help="where to store the records"),
)

if __name__ == "__main__":
    sys.exit(main())
