"""Wrong inputs: one clear line, exit code 2, and no page."""

import h5py
import pytest

from make_report import main


def refused(data, capsys, *words):
    """Asserts that the report fails with these words and that nothing is left behind."""
    assert main(data.arguments) == 2
    text = capsys.readouterr().err
    assert text.startswith("error: ") and text.count("\n") == 1
    for word in words:
        assert word in text
    assert not data.page.exists()


def test_missing_verdicts(data, capsys):
    (data.folder / "verdicts.json").unlink()
    refused(data, capsys, "verdicts.json", "sandglass verify --json")


@pytest.mark.parametrize("text", ["{", "[]", "{}", '{"records": [], "limits": []}', "\xff"])
def test_verdicts_that_are_none(data, capsys, text):
    (data.folder / "verdicts.json").write_text(text, encoding="latin-1")
    refused(data, capsys, "verdicts.json")


@pytest.mark.parametrize(
    ("key", "value"),
    [("method", 3), ("kappa", "auto"), ("steps", 1.5), ("residual", True), ("golden", 0.1)],
)
def test_a_record_of_the_wrong_kind(data, capsys, key, value):
    data.records[1][key] = value
    data.write_verdicts()
    refused(data, capsys, f"records[1].{key}", repr(value))


def test_a_number_that_is_none(data, capsys):
    data.records[1]["golden"]["max_relative_error"] = float("nan")
    data.write_verdicts()
    refused(data, capsys, "records[1].golden.max_relative_error", "finite")


def test_a_record_without_a_key(data, capsys):
    del data.records[0]["status"]
    data.write_verdicts()
    refused(data, capsys, "records[0].status", "missing")


def test_a_case_without_a_file(data, capsys):
    (data.folder / "cases/column.toml").unlink()
    refused(data, capsys, "'column'", "no case file")


def test_a_case_from_elsewhere(data, capsys):
    """It takes precedence over the folder's one of the same name; a missing one is an error."""
    own, there = data.folder / "own.toml", data.folder / "cases/column.toml"
    own.write_text(there.read_text().replace("[case]", '[case]\nx = "own"', 1))
    there.unlink()
    refused(data, capsys, "'column'", "no case file")
    there.write_text('[case]\nname = "column"\n')
    assert main([*data.arguments, "--case", str(own)]) == 0
    capsys.readouterr()
    assert main([*data.arguments, "--case", str(data.folder / "none.toml")]) == 2
    assert "none.toml: cannot be read" in capsys.readouterr().err


def test_no_folder_of_cases(data, capsys):
    (data.folder / "cases").rename(data.folder / "elsewhere")
    refused(data, capsys, "cases", "no such folder")


def test_a_case_file_that_is_no_toml(data, capsys):
    (data.folder / "cases/column.toml").write_text("[case\n", encoding="utf-8")
    refused(data, capsys, "column.toml", "TOML")


def test_a_run_without_its_result(data, capsys):
    (data.folder / "results/column.tl-none.h5").unlink()
    refused(data, capsys, "column.tl-none.h5", "--results")


def test_a_result_that_is_no_hdf5(data, capsys):
    (data.folder / "results/column.tl-none.h5").write_text("text", encoding="utf-8")
    refused(data, capsys, "column.tl-none.h5", "HDF5")


def test_a_result_without_frames(data, capsys):
    with h5py.File(data.folder / "results/column.tl-none.h5", "a") as file:
        del file["frames"]
    refused(data, capsys, "column.tl-none.h5", "frames")


def test_a_result_without_the_profile_set(data, capsys):
    with h5py.File(data.folder / "results/column.tl-none.h5", "a") as file:
        del file["mesh/sets/edge"]
    refused(data, capsys, "column.tl-none.h5", "edge")


def test_a_result_of_another_mesh(data, capsys):
    with h5py.File(data.folder / "results/column.tl-perturbation.h5", "a") as file:
        file.attrs["mesh_hash"] = "another"
    refused(data, capsys, "column.tl-perturbation.h5", "another case or mesh")


def test_a_golden_of_another_mesh(data, capsys):
    data.write_reference("golden", data.answer, mesh_hash="another")
    refused(data, capsys, "golden/column.h5", "mesh_hash", "reference/regenerate column")


def test_a_golden_of_another_size(data, capsys):
    data.write_reference("golden", data.answer[1:])
    refused(data, capsys, "golden/column.h5", "(35, 3)")


def test_a_golden_without_displacements(data, capsys):
    with h5py.File(data.folder / "reference/golden/column.h5", "a") as file:
        del file["displacement"]
    refused(data, capsys, "golden/column.h5", "displacement")


def test_results_and_verdicts_of_different_runs(data, capsys):
    data.run("tl-none", 0.3)
    refused(data, capsys, "column.tl-none.h5", "different runs")


def test_a_page_that_cannot_be_written(data, capsys):
    (data.folder / "report").write_text("in the way", encoding="utf-8")
    assert main(data.arguments) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_an_older_page_survives_a_refusal(data):
    assert main(data.arguments) == 0
    before = data.page.read_bytes()
    (data.folder / "verdicts.json").unlink()
    assert main(data.arguments) == 2
    assert data.page.read_bytes() == before
