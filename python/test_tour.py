"""The notebook runs from its first cell to its last, as it is stored: without outputs."""

import json
import os
import subprocess
import sys

import pytest
from command_line import ROOT
from module_folder import FOLDER

NOTEBOOK = json.loads((ROOT / "python/tour.ipynb").read_text())
CODE = ["".join(cell["source"]) for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]

# Runs the cells in one namespace; each ends with its figures, as in a notebook.
RUNNER = """
import json, sys
import matplotlib.pyplot as plt
cells, found = json.load(sys.stdin), {}
for number, cell in enumerate(cells):
    exec(compile(cell, f"cell {number}", "exec"), found)
    for figure in map(plt.figure, plt.get_fignums()):
        figure.savefig(f"{number}.png")
    plt.close("all")
"""


def test_no_outputs_are_stored():
    for cell in NOTEBOOK["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == [] and cell["execution_count"] is None
    assert NOTEBOOK["nbformat"] == 4


def test_all_cells_run(tmp_path):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    environment = os.environ | {"PYTHONPATH": FOLDER, "MPLBACKEND": "Agg"}
    done = subprocess.run(
        [sys.executable, "-c", RUNNER],
        input=json.dumps(CODE),
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "chosen" in done.stdout and "young_modulus" in done.stdout
    pictures = sorted(tmp_path.glob("*.png"))
    assert len(pictures) == 3
    for file in pictures:
        assert pyplot.imread(file)[..., :3].std() > 0.05  # no blank page
