"""`sandglass stability`: maps in JSON, stored cells, and rejected input."""

import json
import signal
import subprocess
import time

from command_line import BINARY, sandglass

MAP = ("--map", "load,nu", "--values", "load=0.5,1", "--values", "nu=0.3,0.49")
FEW = (*MAP, "--methods", "tl-none", "tl-perturbation", "tl-full")


def cells_of(folder):
    return {file: file.stat().st_mtime_ns for file in folder.rglob("*.json")}


def maps_of(file):
    return json.loads(file.read_text())["maps"]


def test_writes_every_cell_of_a_map(block, tmp_path):
    file = tmp_path / "maps.json"
    sandglass("stability", block, *FEW, "--folder", tmp_path / "cells", "--json", file, code=0)
    document = json.loads(file.read_text())
    for key in ("revision", "build_flags", "processor"):
        assert document[key]
    (only,) = document["maps"]
    assert only["x"]["values"] == [0.5, 1.0] and only["y"]["values"] == [0.3, 0.49]
    places = [(c["method"], c["y"], c["x"]) for c in only["cells"]]
    methods = ("tl-none", "tl-perturbation", "tl-full")
    assert places == [(m, y, x) for m in methods for y in (0.3, 0.49) for x in (0.5, 1.0)]
    for cell in only["cells"]:
        assert cell["finding"] and cell["symptoms"]["error"] >= 0.0 and cell["steps"] > 0
    assert len(cells_of(tmp_path / "cells")) == len(only["cells"])


def test_finished_cells_are_not_computed_again(block, tmp_path):
    """A cell with an impossible value stays as it is: it was read, not computed."""
    cells, file = tmp_path / "cells", tmp_path / "maps.json"
    assert sandglass("stability", block, *FEW, "--folder", cells).returncode == 0
    before = cells_of(cells)
    marked = next(iter(before))
    record = json.loads(marked.read_text())
    marked.write_text(json.dumps(record | {"steps": 123456}))
    before = cells_of(cells)
    assert sandglass("stability", block, *FEW, "--folder", cells, "--json", file).returncode == 0
    assert cells_of(cells) == before
    assert [c for c in maps_of(file)[0]["cells"] if c["steps"] == 123456]


def test_resumes_after_a_kill_and_gives_the_same_maps(block, tmp_path):
    whole, rest = tmp_path / "whole.json", tmp_path / "rest.json"
    kept = tmp_path / "kept"
    assert sandglass("stability", block, *MAP, "--folder", tmp_path / "a", "--json", whole, "-j", 2)
    command = [BINARY, "stability", block, *MAP, "--folder", kept, "-j", "1"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and len(cells_of(kept)) < 5:
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = cells_of(kept)
    assert len(before) >= 5
    sandglass("stability", block, *MAP, "--folder", kept, "--json", rest, code=0)
    after = cells_of(kept)
    assert {file: after[file] for file in before} == before
    assert maps_of(rest) == maps_of(whole)


def test_axes_are_described():
    text = sandglass("stability", "--describe").stdout
    for name in ("kappa", "nu", "load", "aspect", "skew", "elements", "cycles", "step", "noise"):
        assert any(line.startswith(name + " ") for line in text.splitlines())
