"""The stubs are those of the package, and type checkers find mistakes with them."""

import os
import subprocess
import sys

import pytest
from command_line import ROOT
from module_folder import FOLDER, readme_code

pytest.importorskip("mypy")

# What stubs cannot say: the signatures of classes made at run time, which their __init__ has, and
# the metaclass of compiled classes.
NOT_IN_STUBS = r"""
sandglass\..*\.__signature__
sandglass\.Simulation
"""


def mypy(module, *arguments, cwd):
    (cwd / "mypy.ini").write_text("[mypy]\nignore_missing_imports = True\n")
    return subprocess.run(
        [sys.executable, "-m", module, *map(str, arguments)],
        cwd=cwd,
        env=os.environ | {"MYPYPATH": FOLDER, "PYTHONPATH": FOLDER},
        capture_output=True,
        text=True,
    )


def test_stubs_and_package_agree(tmp_path):
    """Every public name, its parameters and their defaults, in both directions."""
    allowed = tmp_path / "allowed"
    allowed.write_text(NOT_IN_STUBS)
    settings = ["--mypy-config-file", "mypy.ini", "--allowlist", allowed, "--concise"]
    done = mypy("mypy.stubtest", *settings, "sandglass", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_right_programs_are_accepted(tmp_path):
    files = [ROOT / "python/example.py"]
    for title in ("Sandglass in Python", "Commands", "Derivatives"):
        files.append(tmp_path / f"{title.split()[0]}.py")
        files[-1].write_text(readme_code(title))
    done = mypy("mypy", *files, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


# Lines, and what is said about them: nothing, if the solver must check.
WRONG = {
    'body.solve(threads="two")': 'Argument "threads" to "solve" of "Body"',
    "body.solve(thread=2)": "",  # other keywords are those of sg.Method
    "sg.NeoHookean(young_modulus=1.0, density=1.0)": 'Missing named argument "poisson_ratio"',
    "sg.Simulation(3)": 'Argument 1 to "Simulation"',
    'sg.choose(body, against="silver")': 'Argument "against" to "choose"',
    "sg.verify(body, costs=1.5)": 'Argument "costs" to "verify"',
    "sg.chose(body)": "Module has no attribute",
    "body.solve().displacment": '"Solution" has no attribute "displacment"',
    "body.batch(2).run(1.0, 2, poisson_ratio=[0.3, 0.4])": "Unexpected keyword",
}


def test_wrong_programs_are_rejected(tmp_path):
    lines = ["import sandglass as sg", "body: sg.Body", *WRONG]
    (tmp_path / "wrong.py").write_text("\n".join(lines) + "\n")
    said = mypy("mypy", "wrong.py", cwd=tmp_path).stdout
    for number, line in enumerate(lines[2:], start=3):
        found = [error for error in said.splitlines() if f"wrong.py:{number}: error" in error]
        assert len(found) == bool(WRONG[line]) and all(WRONG[line] in each for each in found), said
