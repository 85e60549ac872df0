"""Predictions beside simulations: the same motion, the ratio, and what is off."""

import itertools
import sys
from types import SimpleNamespace

import pytest

import real_time

RUNG = {"method": "tl-perturbation", "accuracy": None, "precision": "double"}


def test_the_simulation_follows_the_motion_to_its_end(monkeypatch):
    moved = []

    class Simulation:
        time, step_size = 0.0, 0.004

        def __init__(self, path, **settings):
            assert settings == {"precision": "double", "damping": 3.0}
            moved.clear()

        def impose(self, factor):
            moved.append(factor)

        def advance(self, seconds):
            assert seconds == pytest.approx(real_time.STEPS * self.step_size)
            self.time += seconds

    motion = {"duration": 1.0, "damping": 3.0}
    seconds = itertools.count(step=0.2)  # before and after each of three simulations
    monkeypatch.setattr(real_time.time, "process_time", lambda: next(seconds))
    module = SimpleNamespace(Simulation=Simulation)
    assert real_time.simulated(module, "case.toml", "double", motion) == pytest.approx(0.2)
    assert moved == sorted(moved) and len(moved) == 25
    assert 0.0 < moved[0] < 0.01 and moved[-1] == pytest.approx(1.0)


@pytest.mark.parametrize(("seconds", "code"), [(0.129, 0), (0.131, 1), (0.078, 0), (0.076, 1)])
def test_what_differs_by_more_than_30_percent_is_off(monkeypatch, capsys, seconds, code):
    rungs = [RUNG | {"seconds_per_simulated_second": 0.1}]
    monkeypatch.setattr(real_time, "predictions", lambda *_: ({"duration": 1.0}, rungs))
    monkeypatch.setattr(real_time, "simulated", lambda *_: seconds)
    monkeypatch.setitem(sys.modules, "sandglass", SimpleNamespace())
    assert real_time.main(["column"]) == code
    assert ("  off" in capsys.readouterr().out) == bool(code)


@pytest.mark.parametrize(("again", "code"), [((0.1, 0.12), 0), ((0.1, 0.2), 1), ((0.2, 0.2), 1)])
def test_what_is_off_is_measured_twice_more_and_medians_count(monkeypatch, again, code):
    rungs = [RUNG | {"seconds_per_simulated_second": 0.1}]
    seconds = iter((0.2, *again))
    monkeypatch.setattr(real_time, "predictions", lambda *_: ({"duration": 1.0}, rungs))
    monkeypatch.setattr(real_time, "simulated", lambda *_: next(seconds))
    monkeypatch.setitem(sys.modules, "sandglass", SimpleNamespace())
    assert real_time.main(["column"]) == code


def test_the_case_names_its_method(tmp_path):
    path = real_time.case_with_method("column", RUNG | {"accuracy": 0.02}, tmp_path)
    assert path.read_text().endswith('[method]\nname = "tl-perturbation"\naccuracy = 0.02\n')
