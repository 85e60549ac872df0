"""Every law in UFL gives the same displacements and energy as the solver's law.

The solver's `tl-mean-dilatation` is the golden's element, so on one mesh only the laws differ.
"""

from pathlib import Path

import h5py
import numpy as np
import pytest
import ufl

import newton
from case_file import read_case
from common.errors import InputError
from common.program import binary, output_of
from common.result_file import last_displacement
from laws import LAWS, VISCOELASTIC, VOLUMES, parameters
from mesh_file import case_with_mesh
from problem import MixedProblem

# Values for soft tissue, by parameter; parameters that are not listed are given a default guess.
NUMBERS = {
    "young_modulus": "3000.0",
    "poisson_ratio": "0.45",
    "bulk_modulus": "1e4",
    "c10": "350.0",
    "c01": "150.0",
    "c1": "500.0",
    "c2": "-50.0",
    "c3": "40.0",
    "fibre_modulus": "5000.0",
    "b_fibre": "8.0",
    "b_transverse": "2.0",
    "b_shear": "4.0",
    "relaxation_1": "0.25",
    "time_1": "0.5",
    "relaxation_2": "0.15",
    "time_2": "50.0",
}
# Closer to 0.5 the element that averages the pressure loses its stiffness; see the solver's header.
OF_LAW = {"st-venant-kirchhoff": {"poisson_ratio": "0.1"}}


STIFFNESSES = ("a", "a_f", "a_s", "a_fs", "stiffness")
FIBRES = "fibre_direction = [1.0, -0.5, 2.0]\nsheet_direction = [0.0, 1.0, 0.5]"
HELIX = (
    'fibres = { axis = "z", center = [-0.05, 0.0, 0.0], radii = [0.05, 0.15], angles = [60, -60] }'
)


def _material(law, fibres=FIBRES):
    """The keys of a law's table other than `law` and `density`."""
    numbers = NUMBERS | OF_LAW.get(law.removeprefix(VISCOELASTIC), {})
    guess = {
        name: "1000.0" if name.endswith("modulus") or name in STIFFNESSES else "1.0"
        for name in parameters(law)
    }
    lines = [f"{name} = {numbers.get(name, guess[name])}" for name in guess]
    return "\n".join(lines + [fibres] * _has_fibres(law))


def _has_fibres(law):
    """Whether the energy changes when the undeformed body is turned."""
    numbers = {name: 0.2 + 0.1 * n for n, name in enumerate(parameters(law))}
    numbers |= {name: 0.1 for name in numbers if name.startswith("relaxation")}

    def isochoric(F):
        energy, _ = LAWS[law](ufl.as_tensor(F.tolist()), **numbers)
        return energy(())

    F = np.array([[1.2, 0.1, 0.0], [0.0, 0.9, 0.2], [0.1, 0.0, 1.0]])
    turn = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    return abs(isochoric(F @ turn) - isochoric(F)) > 1e-9


# Stretched by a third, sheared by as much, with free sides: this exercises every term of a law.
CASE = Path(__file__).with_name("law.toml.in").read_text()


def _case(folder, law, **others):
    path = folder / "block.toml"
    path.write_text(CASE.format(law=law, material=_material(law, **others)))
    return path


def _run_solver(path, output):
    """The solver's displacements (n, 3) in m and its strain energy in J."""
    output_of(binary(), "run", path, "--method", "tl-mean-dilatation", "-o", output)
    with h5py.File(output) as file:
        return last_displacement(output), file["history/strain_energy"][-1]


@pytest.mark.parametrize("law", LAWS)
def test_the_solver_has_the_same_law(law, tmp_path):
    _compare(_case(tmp_path, law), tmp_path)


@pytest.mark.parametrize("volumetric", VOLUMES)
def test_the_solver_has_the_same_volumetric_part(volumetric, tmp_path):
    path = _case(tmp_path, "neo-hookean")
    text = path.read_text().replace("0.45", "0.2")  # so that the volume changes
    path.write_text(text.replace("density", f'volumetric = "{volumetric}"\ndensity'))
    _compare(path, tmp_path)


def test_the_solver_has_the_same_fibres_in_every_element(tmp_path):
    _compare(_case(tmp_path, "holzapfel-ogden", fibres=HELIX), tmp_path)


def _compare(path, tmp_path):
    """Asserts that solver and reference find the same answer of a case."""
    computed, energy = _run_solver(path, tmp_path / "result.h5")
    case, mesh, _ = case_with_mesh(path)
    problem = MixedProblem(mesh, case.materials)
    newton.solve(problem, 4, 1e-10)
    # The solver stops at forces of 1e-11 of the reactions, which means 1e-11 in displacements. A
    # c01 of 149 instead of 150 changes them by 1e-4.
    difference = computed - problem.nodal_displacement()
    assert np.abs(difference).max() < 1e-7 * mesh.largest_imposed()
    # A common factor of all moduli does not change displacements, but does change the energy, whose
    # error is of second order in that of the displacements.
    assert abs(energy / problem.energy() - 1) < 1e-9


@pytest.mark.parametrize(
    "old, new, words",
    [
        ("c10 = 350.0", "c01 = 1.0", ["not a TOML file"]),
        ("c10 = 350.0", "", ["material.c10", "missing"]),
        ("c10 = 350.0", "young_modulus = 3000.0", ["material.young_modulus", "unknown key", "c10"]),
        ("c10 = 350.0", "c10 = inf", ["material.c10", "finite"]),
        ("c10 = 350.0", "c10 = [1.0, 2.0]", ["material.c10", "three"]),
    ],
)
def test_wrong_material(tmp_path, old, new, words):
    path = _case(tmp_path, "mooney-rivlin")
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(InputError) as error:
        read_case(path)
    for word in (*words, str(path)):
        assert word in str(error.value)
