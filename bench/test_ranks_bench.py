"""Ranks against threads: the model, what is stored, wrong input."""

import json
import shutil

import pytest

import ranks


def test_the_model_costs_a_chunk_and_the_messages(monkeypatch):
    """100 layers of 4,096 elements: chunks of a layer, so 50 ranks at most."""
    monkeypatch.setattr(ranks, "LATENCY", 0.0)
    monkeypatch.setattr(ranks, "BANDWIDTH", float("inf"))
    assert ranks.modelled_efficiency(10, 4096, 100, 20.0) == pytest.approx(10 / 11)
    assert ranks.modelled_efficiency(50, 4096, 100, 20.0) == pytest.approx(2 / 3)
    assert ranks.modelled_efficiency(51, 4096, 100, 20.0) is None


def test_the_model_waits_for_what_the_interior_does_not_hide(monkeypatch):
    """Two messages of 1 ms beside an interior of six chunks: 6 x 4,096 x 20 ns, about half."""
    monkeypatch.setattr(ranks, "LATENCY", 1e-3)
    monkeypatch.setattr(ranks, "BANDWIDTH", float("inf"))
    chunk = 4096 * 20e-9
    expected = 10 * chunk / (11 * chunk + 2e-3 - 6 * chunk)
    assert ranks.modelled_efficiency(10, 4096, 100, 20.0) == pytest.approx(expected)


def test_without_the_program_it_says_how_to_build_it(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("SANDGLASS_BINARY", str(tmp_path / "none"))
    assert ranks.main([]) == 2
    assert "ci/build mpi" in capsys.readouterr().err


@pytest.mark.skipif(
    not (ranks.ROOT / "build/mpi/sandglass").exists() or not shutil.which("mpirun"),
    reason="the program is not built with MPI",
)
def test_a_small_beam_is_measured(tmp_path, monkeypatch, capsys):
    """8 x 8 x 40 elements are four chunks of ten layers, 81 nodes each; a rank sends one."""
    monkeypatch.delenv("SANDGLASS_BINARY", raising=False)
    output = tmp_path / "ranks.json"
    assert ranks.main(["--width", "8", "--rounds", "1", "--json", str(output)]) == 0
    document = json.loads(output.read_text())
    found = {(record["kind"], record["name"]): record for record in document["records"]}
    assert len(found) == 10 and len(document["model"]) == 8
    motion = found["motion", "2 ranks"]
    assert motion["messages"] == 1
    assert motion["bytes"] == 32 * 81 * 10
    assert motion["least_bytes"] == 24 * 81
    for kind in ("motion", "rest"):
        steps = {found[kind, name]["steps"] for name in ("1 rank", "2 threads", "2 ranks")}
        assert len(steps) == 1
    assert capsys.readouterr().out.count("model, not measured") == 1
