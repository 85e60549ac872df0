"""The touched block: its case, the output, and the error of sleep within its limit."""

import numpy as np

import local_touch


def test_prints_what_sleep_neglects(tmp_path, capsys):
    case = tmp_path / "block.toml"
    options = ["--elements", "40", "40", "3", "--shares", "5%", "--repetitions", "1"]
    assert local_touch.main([*options, "--case", str(case)]) == 0
    title, head, whole, local = capsys.readouterr().out.splitlines()
    assert title.startswith("40 x 40 x 3") and "neglects %" in head
    assert whole.split()[:2] == ["nothing", "100"] and float(whole.split()[-1]) == 0.0
    assert float(local.split()[1]) < 100.0
    assert 0.0 < float(local.split()[-1]) < 5.0
    seconds, awake, u = local_touch.run(case, "tl-perturbation", tmp_path)
    assert awake == 1.0 and seconds > 0.0
    assert (u[:, 2] == -local_touch.EDGE).sum() == 25, "five nodes along each side of the patch"


def test_a_refused_run_is_reported(capsys):
    assert local_touch.main(["--elements", "4", "4", "2", "--method", "tl-nothing"]) == 2
    assert "'tl-nothing'" in capsys.readouterr().err


def test_survey_prints_the_worst_first(monkeypatch, capsys):
    def ran(case, method, folder, share=None):
        calls.append(share)
        return 1.0, 0.5 if share else 1.0, np.full((3, 3), float(share or 0.0))

    calls = []
    monkeypatch.setattr(local_touch, "run", ran)
    assert local_touch.main(["--survey", "2"]) == 0
    head, *worst = capsys.readouterr().out.splitlines()
    assert calls == [None, "0.1", "0.02", "0.004"] * 2
    assert head.startswith("6 runs") and len(worst) == 5
    ratios = [float(line.split()[0]) for line in worst]
    assert ratios == sorted(ratios, reverse=True)
