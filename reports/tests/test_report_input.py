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


@pytest.mark.parametrize(
    ("file", "text", "words"),
    [
        ("verdicts.json", None, ["verdicts.json", "sandglass verify --json"]),
        ("cases/column.toml", None, ["'column'", "no case file"]),
        ("cases/column.toml", "[case\n", ["column.toml", "TOML"]),
        ("results/column.tl-none.h5", None, ["column.tl-none.h5", "--results"]),
        ("results/column.tl-none.h5", "text", ["column.tl-none.h5", "HDF5"]),
    ],
)
def test_a_file_that_is_missing_or_another(data, capsys, file, text, words):
    (data.folder / file).unlink()
    if text:
        (data.folder / file).write_text(text)
    refused(data, capsys, *words)


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


@pytest.mark.parametrize(
    ("file", "lost"),
    [
        ("results/column.tl-none.h5", "frames"),
        ("results/column.tl-none.h5", "mesh/sets/edge"),
        ("reference/golden/column.h5", "displacement"),
    ],
)
def test_a_result_without_a_part(data, capsys, file, lost):
    with h5py.File(data.folder / file, "a") as opened:
        del opened[lost]
    refused(data, capsys, file.partition("/")[2], lost.rpartition("/")[2])


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
