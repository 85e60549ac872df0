"""`--device opencl` of run, verify and bench; device_test.cpp compares its forces and motions."""

import json
import re

import pytest
from command_line import sandglass

NONE = sandglass("run", "column", "--device", "none", code=2).stderr
pytestmark = pytest.mark.skipif(
    "opencl:1" not in NONE, reason="no OpenCL device: ci/setup test installs pocl-opencl-icd"
)


def test_limits_of_dynamic_cases_hold_on_a_device():
    cases = "loaded-block", "plucked-beam", "pushed-ellipsoid"
    printed = sandglass("verify", *cases, "--device", "opencl", code=0).stdout
    assert printed.count("holds ") >= 9
    assert "tl-adaptive" not in printed  # a device cannot compute it, which breaks no limit


def test_a_run_says_where_its_state_is():
    printed = sandglass("run", "pushed-ellipsoid", "--device", "opencl", code=0).stdout
    assert "state on the device: 2 kernels and " in printed
    printed = sandglass("run", "tool-press", "--device", "opencl", code=0).stdout
    assert "state copied to the device in every step: [[obstacle]] acts on it" in printed


def test_a_static_answer_is_found_with_the_forces_of_a_device():
    printed = sandglass("run", "column", "-m", "tl-mean-dilatation", "--device", "opencl", code=0)
    assert "against the golden: max" in printed.stdout


def test_bench_times_the_device_beside_this_processor(tmp_path):
    options = "-m tl-perturbation -m tl-adaptive -t 1 -r 1 -p float --device opencl --json".split()
    sandglass("bench", "pushed-ellipsoid", *options, tmp_path / "bench.json", code=0)
    document = json.loads((tmp_path / "bench.json").read_text())
    assert document["device"] and f"({document['device']})" in NONE
    found = {(row["method"], row["kernel"]): row for row in document["records"]}
    here, there = (found["tl-perturbation", kernel] for kernel in ("pack", "device"))
    assert here["status"] == there["status"] == "ok"
    assert found["tl-adaptive", "device"]["status"].startswith("left out: method 'tl-adaptive'")
    as_run = "-m tl-perturbation -p float --device opencl".split()
    printed = sandglass("run", "pushed-ellipsoid", *as_run, code=0).stdout
    bytes_of_step = re.search(r"and (\S+) bytes per element in a step", printed)[1]
    assert f"{there['bytes_per_element_step']:.4g}" == bytes_of_step  # those of the state there


def test_bench_leaves_out_scenes_whose_state_cannot_stay_there():
    options = "-m tl-perturbation -t 1 -r 1 -p float --device opencl".split()
    printed = sandglass("bench", "tool-press", *options, code=0).stdout
    assert "left out: the state cannot stay on the device: [[obstacle]] acts on it" in printed


@pytest.mark.parametrize(
    "arguments, reason",
    [
        (
            ("run", "column", "--device", "cuda"),
            "'cuda' is no processor of this machine; allowed: cpu",
        ),
        (("run", "column", "--device", "opencl:99"), "is no processor of this machine"),
        (("run", "brain-hold", "-m", "tl-perturbation", "--device", "opencl"), "viscoelastic"),
        (("run", "pushed-ellipsoid", "-m", "t4-anp", "--device", "opencl"), "averages over nodes"),
        (("run", "pushed-ellipsoid", "-m", "ul-viscous", "--device", "opencl"), "on velocities"),
        (("bench", "column", "--rest", "--device", "opencl"), "--device"),
    ],
)
def test_what_a_device_cannot_do_is_refused(arguments, reason):
    assert reason in sandglass(*arguments, code=2).stderr
