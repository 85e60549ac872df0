"""Error over time: stored records, wrong input."""

import refinement
from test_measuring import measured


def test_uniform_and_refined_meshes_come_nearer_to_the_truth(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(refinement, "ACCURACIES", (0.02, 0.006))
    monkeypatch.setattr(refinement, "ROUNDS", 1)
    code, document = measured(refinement.main, tmp_path, "column", "--most", "2160")
    assert code == 0
    assert document["processor"] and document["versions"]["sandglass"]
    records = document["records"]
    assert [record.get("splits") for record in records] == [0, 0, 1, 1, None, None]
    assert [record["elements"] for record in records[:5]] == [270, 270, 2160, 2160, 270]
    assert 270 < records[5]["elements"] < 2160
    # An error that falls with the square of the element size; .5 allows for the effect of edges.
    assert records[2]["error_max"] < 0.5 * records[0]["error_max"]
    assert records[5]["error_max"] <= 0.006 < records[4]["error_max"] <= 0.02
    assert all(record["seconds"] > 0 and record["error_rms"] > 0 for record in records)
    assert capsys.readouterr().out.count(" s, max ") == len(records)


def test_an_accuracy_that_cannot_be_reached_ends_the_case(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(refinement, "ACCURACIES", (0.02,))
    code, document = measured(refinement.main, tmp_path, "ellipsoid-indentation", "--most", "1")
    assert code == 3
    assert {record["way"] for record in document["records"]} == {"uniform"}
    assert "no answer found on the refined mesh of" in capsys.readouterr().err


def test_wrong_input_is_reported(tmp_path, capsys):
    assert measured(refinement.main, tmp_path, "colum") == (2, None)
    assert "colum" in capsys.readouterr().err
