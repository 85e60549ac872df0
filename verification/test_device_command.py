"""`--device opencl` of run, verify and bench; device_test.cpp compares its forces and motions."""

import json
import os
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
    left_out = printed.partition("left out, with their limits\n")[2]
    assert "pushed-ellipsoid tl-adaptive: method 'tl-adaptive' runs on this processor" in left_out


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


def test_a_device_with_small_work_groups_is_refused():
    small = os.environ | {"POCL_MAX_WORK_GROUP_SIZE": "32"}
    found = sandglass("run", "column", "--device", "opencl", env=small)
    if found.returncode == 0:
        pytest.skip("the device is not that of pocl")
    assert found.returncode == 2 and "runs groups of at most 32 work items" in found.stderr


VISCOELASTIC = """[case]
name = "own"
requirement = "A device does not compute it."
answer = "dynamic"
[mesh]
generator = "box"
size = [0.02, 0.02, 0.04]
elements = [2, 2, 4]
[material]
law = "viscoelastic-neo-hookean"
relaxation_1 = 0.5
time_1 = 0.1
young_modulus = 3000.0
poisson_ratio = 0.45
density = 1000.0
[sets]
foot = { z = [0.0, 0.0] }
head = { z = [0.04, 0.04] }
[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]
[dynamics]
duration = 0.01
[[published]]
set = "head"
component = "x"
value = 5.0
source = "a test"
"""


def test_verify_refuses_a_case_of_which_a_device_computes_nothing(tmp_path):
    """Rather than checking no limit and ending well."""
    case = tmp_path / "own.toml"
    case.write_text(VISCOELASTIC)
    found = sandglass("verify", case, "--device", "opencl", code=2)
    law = "law 'viscoelastic-neo-hookean' runs on this processor alone"
    assert f"{case}: nothing can be computed on this device: {law}" in found.stderr
