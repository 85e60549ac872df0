"""The script for NVIDIA cards: its kernels run here as C++, and compile for cards."""

import ctypes
import json
import re
import shutil
import types
from pathlib import Path

import card
import pytest
from common.errors import InputError
from common.program import ROOT, binary, output_of
from cuda import Card, compiled
from host_card import HostCard


def options(folder, **others):
    given = {"folder": folder, "elements": [27], "precision": list(card.REALS), "json": None}
    return types.SimpleNamespace(**given | others)


def test_motion_is_that_of_the_program(card_folder, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(card, "triad_gbs", lambda *_: 100.0)
    file = tmp_path / "card.json"
    assert card.measure(HostCard(tmp_path), options(card_folder, json=file)) == 0
    found = json.loads(file.read_text())
    assert all(apart <= 1.0 for apart in found["difference"].values()), found["difference"]
    assert [row["elements"] for row in found["records"]] == [27, 27]
    for row in found["records"]:
        assert row["status"] == "ok" and len(row["seconds_per_step"]) == card.REPETITIONS
        assert row["ns_per_element_step"] == pytest.approx(1e9 / card.AT_ONCE / 27)
        assert row["share_of_triad"] == pytest.approx(row["gbs"] / 100.0)


def test_another_law_is_another_answer(card_folder, tmp_path, capsys):
    """A tenth of a percent of one constant."""
    spoilt = tmp_path / "spoilt"
    shutil.copytree(card_folder, spoilt)
    text = (spoilt / "double.cu").read_text()
    number = max(re.findall(r"\d\d+\.\d+", text), key=float)
    (spoilt / "double.cu").write_text(text.replace(number, str(1.001 * float(number))))
    assert card.measure(HostCard(tmp_path), options(spoilt, precision=["double"])) == 1
    assert "nothing is timed" in capsys.readouterr().out


def test_a_body_that_does_not_fit_is_left_out(card_folder, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(card, "triad_gbs", lambda *_: 100.0)
    small = HostCard(tmp_path)
    monkeypatch.setattr(card, "answer", lambda *_: ())
    monkeypatch.setattr(card, "difference", lambda *_: 0.5)
    small.free = 1000
    assert card.measure(small, options(card_folder, precision=["float"])) == 0
    assert "left out: " in capsys.readouterr().out


def test_bytes_are_those_that_the_program_counts(card_folder, tmp_path):
    printed = output_of(
        binary(),
        "run",
        card_folder / "card.toml",
        "-p",
        "float",
        "--device",
        "opencl",
        allowed=(0, 2),
    )
    if "state on the device" not in printed:
        pytest.skip("no OpenCL device: ci/setup test installs pocl-opencl-icd")
    counted = float(re.search(r"and (\S+) bytes per element in a step", printed)[1])
    host = HostCard(tmp_path)
    functions = host.functions(card.text_of(card_folder, "float"), card.KERNELS)
    box = card.Box(host, functions, "float", card.SMALL, card.constants_in(card_folder, "float"))
    # The program fills up the elements to a multiple of 64: 2240 instead of 2197.
    assert box.bytes_of_step() / box.elements == pytest.approx(counted, rel=0.02)


@pytest.mark.parametrize("architecture", ["sm_80", "sm_90"])
def test_kernels_compile_for_cards(card_folder, architecture, capsys):
    try:
        compiled("", architecture)
    except InputError as error:
        pytest.skip(str(error))
    assert card.main([str(card_folder), "--compile", architecture]) == 0
    assert capsys.readouterr().out.count(f"bytes for {architecture}") == 2


def test_without_a_card(card_folder, capsys):
    try:
        Card()
    except InputError:
        assert card.main([str(card_folder)]) == 2
        assert "error: no NVIDIA card: " in capsys.readouterr().err
    else:
        pytest.skip("this machine has one")


def test_the_driver_has_every_function():
    """The list of the toolkit, where there is one: names carry versions."""
    stubs = next(iter(Path("/usr/local").glob("cuda*/lib64/stubs/libcuda.so")), None)
    if stubs is None:
        pytest.skip("no CUDA toolkit")
    library = ctypes.CDLL(stubs)
    for name in re.findall(r'"(cu[A-Z]\w+)"', (ROOT / "bench/cuda.py").read_text()):
        assert hasattr(library, name), name


def test_a_folder_without_kernels(tmp_path, capsys):
    assert card.main([str(tmp_path), "--compile", "sm_80"]) == 2
    assert "--write` makes it" in capsys.readouterr().err
