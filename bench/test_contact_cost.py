"""The cost of contact: the study gives what is stored, and errors fall with mesh and penalty."""

import tempfile

import contact_cost as study
import pytest

from common.files import read_json
from common.program import ROOT

RECORDS = read_json(ROOT / "reports" / "figures" / "contact_cost.json")["records"]


def stored(method, across, penalty=None):
    """The stored record of a run."""
    known = {"method": method, "across": across, "penalty": penalty}
    (found,) = (record for record in RECORDS if known.items() <= record.items())
    return found


@pytest.mark.parametrize(
    ("method", "penalty"), [("tl-mean-dilatation", None), ("tl-perturbation", 1)]
)
def test_stored_records_are_found_again(method, penalty):
    with tempfile.TemporaryDirectory() as folder:
        evaluations, elements, error = study.solved(folder, method, 4, penalty)
        known = stored(method, 4, penalty)
        # Errors of answers at a residual of 1e-8; evaluations may differ between machines.
        assert error == pytest.approx(known["error"], rel=1e-4)
        assert elements == known["elements"]
        work = evaluations * elements * study.operations(folder)[method]
        assert work == pytest.approx(known["operations"], rel=0.2)


def test_errors_fall_with_the_mesh_and_with_the_penalty():
    errors = [stored("tl-mean-dilatation", across)["error"] for across in study.MESHES]
    assert errors == sorted(errors, reverse=True)
    # Nodes sink in by a share of the pressure over the penalty, which the augmented step reduces.
    soft, usual = (stored(study.OF_PENALTIES, 4, penalty)["error"] for penalty in (0.1, 30))
    assert soft > 10 * usual
