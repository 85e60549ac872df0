"""Identified stiffnesses: what the script finds, what is stored, what is written about it."""

import re
import sys

import pytest

from common.program import ROOT

sys.path[:0] = [str(ROOT / "python"), str(ROOT / "examples" / "python")]

import module_folder  # noqa: E402

sys.path.insert(0, module_folder.FOLDER)

import identified_stiffness as study  # noqa: E402
from common.files import read_json  # noqa: E402

RECORDS = read_json(ROOT / "reports" / "figures" / "identified_stiffness.json")["records"]


@pytest.mark.parametrize("scene", study.SCENES)
@pytest.mark.parametrize("method", [{"name": "tl-full"}, {"name": "tl-perturbation", "kappa": 0.1}])
def test_an_element_finds_the_modulus_of_its_own_measurement(scene, method):
    """On the mesh and with the method of the measurement there is no bias."""
    measure, sign, _, (mesh, *_) = study.SCENES[scene]
    measured = measure(mesh, 2 * study.MODULUS, method)
    found = study.identified(measure, sign, mesh, method, measured)
    assert abs(found / (2 * study.MODULUS) - 1) < 3 * study.AGREEMENT


def test_a_stored_bias_is_found_again():
    measure, sign, fine, (mesh, *_) = study.SCENES["bent beam"]
    measured = measure(fine, study.MODULUS, {"name": study.GOLDEN})
    found = study.identified(measure, sign, mesh, {"name": "tl-perturbation"}, measured)
    stored = bias("bent beam", mesh, "tl-perturbation", None)
    assert abs(found / study.MODULUS - 1 - stored) < 1e-4


def bias(scene, mesh, method, kappa):
    (found,) = [
        one["bias"]
        for one in RECORDS
        if (one["scene"], tuple(one["elements"]), one["method"], one["kappa"])
        == (scene, tuple(mesh), method, kappa)
    ]
    return found


def test_the_table_of_the_readme_is_what_is_stored():
    text = (ROOT / "examples" / "python" / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([\w-]+)`(?:, kappa (\S+))? \|(.*)\|$", text, re.MULTILINE)
    assert len(rows) == 8
    columns = [(scene, mesh) for scene, (*_, meshes) in study.SCENES.items() for mesh in meshes]
    for method, kappa, numbers in rows:
        kappa = None if kappa in ("", "auto") else float(kappa)
        for (scene, mesh), written in zip(columns, numbers.split("|"), strict=True):
            stored = 100 * bias(scene, mesh, method, kappa)
            digits = 0.5 if abs(stored) >= 9.5 else 0.05
            assert abs(float(written.strip(" %")) - stored) <= digits + 1e-9, (method, mesh)
