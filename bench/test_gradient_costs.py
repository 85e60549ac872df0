"""The script that times gradients runs, on a few elements."""

import sys

from common.program import ROOT

sys.path.insert(0, str(ROOT / "python"))

import module_folder  # noqa: E402

sys.path.insert(0, module_folder.FOLDER)

import gradient_costs  # noqa: E402


def test_every_case_has_a_row(capsys):
    assert gradient_costs.main(["--elements", "2", "--repetitions", "1"]) == 0
    _, *rows = capsys.readouterr().out.splitlines()
    assert len(rows) == len(gradient_costs.AT_REST) + len(gradient_costs.IN_MOTION)
    for row in rows:
        every, few = map(float, row.split()[-2:])
        assert every > 0 and few > 0
