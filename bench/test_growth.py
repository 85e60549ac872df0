"""Growth of cost: stored records, equal step counts in all rounds, wrong input."""

import pytest

import growth
from test_measuring import measured


def test_every_method_is_timed_at_every_ratio(tmp_path, capsys):
    code, document = measured(growth.main, tmp_path, "--most", "400", "--most-implicit", "0")
    assert code == 0
    assert document["processor"] and document["versions"]["sandglass"]
    records = document["records"]
    found = [(record["poisson_ratio"], record["name"]) for record in records]
    assert found == [(ratio, method) for ratio in growth.RATIOS for method in growth.METHODS]
    assert all(record["elements"] == 320 for record in records)
    assert all(
        record["seconds"] > 0 and (record["evaluations"] or record["iterations"])
        for record in records
    )
    assert capsys.readouterr().out.count("ations\n") == len(records)


def test_other_programs_stand_beside_it(tmp_path, monkeypatch):
    pytest.importorskip("dolfinx")
    monkeypatch.setattr(growth, "RATIOS", (0.3,))
    code, document = measured(growth.main, tmp_path, "--most", "400")
    assert code == 0
    iterations = {record["name"]: record["iterations"] for record in document["records"]}
    assert 2 < iterations["FEniCSx"] < 20  # Newton's method on a mild load
    assert document["versions"]["FEniCSx"]


def test_missing_programs_are_named_and_left_out(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(growth.shutil, "which", lambda name: None)
    monkeypatch.setattr(growth.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(growth, "RATIOS", (0.3,))
    code, document = measured(growth.main, tmp_path, "--most", "400")
    assert code == 0
    assert {record["name"] for record in document["records"]} == set(growth.METHODS)
    errors = capsys.readouterr().err
    assert "install python3-dolfinx" in errors and "install calculix-ccx" in errors


def test_less_than_the_smallest_mesh_is_wrong_input(tmp_path, capsys):
    code, document = measured(growth.main, tmp_path, "--most", "319")
    assert (code, document) == (2, None)
    assert "--most: 319 is less than 320" in capsys.readouterr().err
