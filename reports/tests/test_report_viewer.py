"""Data of the 3D viewer: arrays that decode to the original values."""

import base64
import json

import numpy as np
import pytest
from synthetic import box

from sandglass_report.verdicts import read_verdicts
from sandglass_report.subject import read_subjects
from sandglass_report.viewer import _faces, _levels, viewer_data


def decoded(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=kind)


def test_every_face_knows_its_element():
    _, cells = box(2, 2, 3)
    faces, owners = _faces(cells)
    assert len(faces) == 2 * (4 + 6 + 6)
    assert all(set(face) <= set(cells[owner]) for face, owner in zip(faces, owners))


def data_of(data):
    """The viewer's data of the data set, through JSON."""
    verdicts = read_verdicts(data.folder / "verdicts.json")
    folders = (data.folder / name for name in ("cases", "reference", "results"))
    subjects = read_subjects(verdicts, *folders)
    return json.loads(json.dumps(viewer_data(subjects), allow_nan=False)), subjects[0]


def test_positions_and_errors_of_a_method_are_decoded(data):
    found, subject = data_of(data)
    case = found["cases"]["column"]
    faces = decoded(case["faces"], "<u2").reshape(-1, 4)
    answer = case["answers"]["tl-none"]
    box_of = answer["places"]
    places = decoded(box_of["xyz"], "<u2").reshape(-1, 3) / 65535 * box_of["size"] + box_of["low"]
    at = subject.points + subject.displacement("tl-none")
    nodes = np.unique(_faces(subject.cells)[0])
    # Half a step of the box's largest side.
    assert np.abs(places - at[nodes]).max() < 0.51 * box_of["size"] / 65535
    assert answer["largest"] == pytest.approx(0.2, rel=1e-3)
    low, high = case["limits"]["error"]
    levels = decoded(answer["error"], "u1")
    assert len(levels) == len(faces)
    worst = np.exp(np.log(low) + levels.max() / 255 * np.log(high / low))
    step = (high / low) ** (1 / 255)
    assert 0.2 / step < min(worst, high) * step and worst <= 0.2 * step


def test_the_golden_is_an_answer_without_errors(data):
    case = data_of(data)[0]["cases"]["column"]
    assert next(iter(case["answers"])) == "golden"
    assert decoded(case["answers"]["golden"]["error"], "u1").max() == 0
    assert "hourglass" not in case["answers"]["golden"]


def test_points_of_kappa_curves_are_left_out(data):
    answers = data_of(data)[0]["cases"]["column"]["answers"]
    assert list(answers) == ["golden", "tl-none", "tl-perturbation"]


def test_without_a_golden_there_is_no_error_to_show(data):
    (data.folder / "reference/golden/column.h5").unlink()
    case = data_of(data)[0]["cases"]["column"]
    assert "error" not in case["limits"] and "golden" not in case["answers"]


def test_an_answer_that_is_not_finite_is_left_out(data):
    import h5py

    data.records[0]["golden"] = None
    data.write_verdicts()
    with h5py.File(data.folder / "results/column.tl-none.h5", "a") as file:
        file["frames/0001/displacement"][0, 0] = np.nan
    assert "tl-none" not in data_of(data)[0]["cases"]["column"]["answers"]


def test_levels_end_at_their_limits():
    found = decoded(_levels(np.array([-1.0, 0.0, 0.5, 1.0, 9.0, np.inf]), (0.0, 1.0)), "u1")
    assert found.tolist() == [0, 0, 128, 255, 255, 255]
