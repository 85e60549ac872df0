"""The touched block: its case, what is printed, and that sleep neglects no more than it may."""

import pytest

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


def test_tells_of_a_failed_run(capsys):
    assert local_touch.main(["--elements", "4", "4", "2", "--method", "tl-nothing"]) == 3
    assert "'tl-nothing'" in capsys.readouterr().err


@pytest.mark.parametrize("option", [["--repetitions", "0"], ["--elements", "0", "4", "4"]])
def test_refuses_bad_usage(option):
    with pytest.raises(SystemExit) as end:
        local_touch.main(option)
    assert end.value.code == 2
