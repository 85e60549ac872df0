"""Output of `sandglass run`: what it understood and found, warnings, refusals."""

import os
import pty
import re
import resource
import shutil
import subprocess

import h5py
import meshio
import numpy
import pytest
from command_line import BARE, BINARY, BLOCK, ROOT, dynamic, sandglass

FORCE = r"\((\S+), (\S+), (\S+)\) N"


def lines_of(outcome):
    """The lines that a run printed; it must have finished."""
    assert outcome.returncode == 0, outcome.stderr
    return outcome.stdout.splitlines()


def test_the_first_lines_are_what_was_understood(block):
    size, material, method = lines_of(sandglass("run", block))[:3]
    assert size == "block: 100 mm x 100 mm x 200 mm, 0.002 m^3, 2 kg; 16 elements, 45 nodes"
    # mu = E / (2 (1 + nu)), K = E / (3 (1 - 2 nu)), c^2 = (K + 4 mu / 3) / rho.
    assert material == (
        "neo-hookean: Young's modulus 3 kPa, shear 1.01 kPa, bulk 50 kPa; density 1000 kg/m^3, "
        "waves of 7.17 m/s"
    )
    assert re.fullmatch(
        r"tl-perturbation, kappa 0.00\d+ \(auto\), double, stable step \d\S* ms", method
    )


def test_separate_parts_are_counted_at_the_start_and_at_the_end(block, tmp_path):
    """Two blocks that share no node, in a mesh from a file."""
    corners = [(x, y, z) for z in (0.0, 0.2) for y in (0.0, 0.1) for x in (0.0, 0.1)]
    points = corners + [(x + 0.3, y, z) for x, y, z in corners]
    order = (0, 1, 3, 2, 4, 5, 7, 6)
    cells = [order, [n + 8 for n in order]]
    meshio.Mesh(points, [("hexahedron", cells)]).write(tmp_path / "two.vtu")
    start, end = BLOCK.index("[mesh]"), BLOCK.index("[material]")
    block.write_text(BLOCK[:start] + '[mesh]\nfile = "two.vtu"\n\n' + BLOCK[end:])
    lines = lines_of(sandglass("run", block))
    assert lines[0].endswith("2 elements, 16 nodes; 2 separate parts")
    assert any(re.match("largest displacement .*; 2 separate parts", line) for line in lines)


def test_a_mesh_in_mm_is_warned_of_with_a_way_out(block, tmp_path):
    def outcome_of(factor):
        mesh = tmp_path / "mesh.h5"
        assert sandglass("mesh", block, "-o", mesh).returncode == 0
        with h5py.File(mesh, "a") as file:
            for points in (file["mesh/points"],):
                points[:] = factor * points[:]
        case = tmp_path / "own.toml"
        start, end = BLOCK.index("[mesh]"), BLOCK.index("[material]")
        text = BLOCK[:start] + '[mesh]\nfile = "mesh.h5"\n' + BLOCK[end:]
        case.write_text(text.replace("[0.2, 0.2]", f"[{0.2 * factor}, {0.2 * factor}]"))
        return sandglass("run", case)

    assert "warning: the mesh" not in outcome_of(1.0).stderr
    assert outcome_of(1000.0).stderr.startswith(
        "warning: the mesh is 200 m long, and files are read in m: if it is in mm, multiply its "
        "points by 0.001 (no key does so), or give the whole case in mm, s, t, N and MPa"
    )


def test_a_condensed_method_in_motion_is_refused_before_any_output(block):
    block.write_text(dynamic(BLOCK))
    outcome = sandglass("run", block, "--method", "linear-condensed", code=2)
    assert outcome.stdout == ""


def test_memory_that_a_run_lacks_is_reported_before_it_starts(block):
    # A mesh of 250,000 elements takes 90 MB, the search for equilibrium on it 875 MB.
    block.write_text(BLOCK.replace("[2, 2, 4]", "[50, 50, 100]"))
    limit = (800 << 20, 800 << 20)
    outcome = sandglass(
        "run", block, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit), code=3
    )
    assert outcome.stdout == ""
    assert "2.5e+05 elements need about 0.9 GB, and 0.8 GB are free" in outcome.stderr


def test_the_last_lines_are_those_of_the_result(block):
    result = block.parent / "result.h5"
    lines = lines_of(sandglass("run", block, "-o", result))
    text = "\n".join(lines)
    ending = re.search(
        r"^static equilibrium \(stable\): (\d+) evaluations and \d of its stability, \S+ s; "
        r"residual (\S+), tolerance 1e-08$",
        text,
        re.MULTILINE,
    )
    with h5py.File(result) as file:
        last = file["frames"][sorted(file["frames"])[-1]]
        history = file["history"]
        largest = numpy.linalg.norm(last["displacement"], axis=1).max()
        ratio = history["hourglass_energy"][-1] / history["strain_energy"][-1]
        smallest = last["jacobian"][:].min()
        assert float(ending[2]) == pytest.approx(history["residual"][-1], rel=0.01)
        assert (
            f"largest displacement {1e3 * largest:.3g} mm; smallest det F of an element "
            f"{smallest:.3g}; hourglass energy {100 * ratio:.3g} % of strain energy"
        ) in lines
        for name in ("foot", "head"):
            printed = re.search(f"^reaction at {name} {FORCE}$", text, re.MULTILINE)
            stored = history[f"reaction/{name}"][-1]
            assert [float(f) for f in printed.groups()] == pytest.approx(
                stored, rel=6e-3, abs=2e-4 * abs(stored).max()
            )
            assert (stored == last[f"reaction/{name}"][:]).all()
        # No other set holds the block.
        total = history["reaction/foot"][-1] + history["reaction/head"][-1]
        assert abs(total).max() < 1e-7 * abs(history["reaction/head"][-1]).max()
    assert "nothing stored" not in text


def test_without_output_nothing_is_stored_and_a_note_is_printed(block):
    assert "nothing stored; -o FILE.h5" in lines_of(sandglass("run", block))[-1]
    assert [file.name for file in block.parent.iterdir()] == ["block.toml"]


def test_a_motion_ends_with_its_steps_and_energies(block):
    block.write_text(dynamic(BARE, duration=0.05, frames=5))
    outcome = sandglass("run", block)
    text = "\n".join(lines_of(outcome))
    assert re.search(
        r"^motion: 0.05 s in \d+ steps of at least \S+ ms, complete; \S+ s, ", text, re.M
    )
    assert "kinetic" in text and "reaction at head (" in text
    assert "warning" not in outcome.stderr


def test_a_residual_above_the_tolerance_is_explained(block):
    outcome = sandglass("run", block, "-p", "float")
    ending = next(line for line in lines_of(outcome) if line.startswith("static equilibrium"))
    residual, explained = re.search(r"residual (\S+), tolerance 1e-08(.*)$", ending).groups()
    assert float(residual) > 1e-8 and explained == ": single precision resolves no more"


def test_no_words_twice_and_no_stray_space(block):
    for text in (BARE, dynamic(BARE, duration=0.02)):
        block.write_text(text)
        for method in ("tl-perturbation", "tl-full"):
            for line in lines_of(sandglass("run", block, "-m", method)):
                assert line == line.strip() and "  " not in line and " :" not in line
                assert not re.search(r"\b1 (evaluations|steps|elements|nodes)\b", line)
                assert not re.search(r"(\b\w+ \d+ \w+\b).*\1", line)


NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]\d+)?"


def test_the_readme_shows_what_its_first_case_prints(tmp_path):
    text = (ROOT / "README.md").read_text()
    shown = re.search(r"```text\n(my-beam: .*?)```", text, re.DOTALL)[1].splitlines()
    case = tmp_path / "my-beam.toml"
    case.write_text(re.search(r"```toml\n(.*?)```", text, re.DOTALL)[1])
    printed = lines_of(sandglass("run", case.name, "-o", "my-beam.h5", cwd=tmp_path))
    assert len(shown) == len(printed)
    for ours, theirs in zip(shown, printed):
        assert re.sub(NUMBER, "#", ours) == re.sub(NUMBER, "#", theirs)
        if ours.startswith("static equilibrium"):  # seconds, and the last rounding of the residual
            continue
        numbers = [[float(n) for n in re.findall(NUMBER, line)] for line in (ours, theirs)]
        assert numbers[0] == pytest.approx(numbers[1], rel=0.01)  # one in the last of three digits


# Warnings.


def test_much_hourglass_energy_is_warned_of_and_the_remedy_has_none(block):
    # One element across a bent block: the bending is all hourglass.
    block.write_text(
        BARE.replace("[2, 2, 4]", "[1, 1, 4]").replace("[0.02, 0.0, 0.01]", "[0.05, 0.0, 0.0]")
    )
    outcome = sandglass("run", block)
    found = re.search(r"hourglass energy is (\S+) % of strain energy, above 10 %", outcome.stderr)
    assert float(found[1]) > 5.0
    method = re.search(r"with --method (\S+),", outcome.stderr)[1]
    other = sandglass("run", block, "-m", method, code=0)
    assert not other.stderr
    assert "hourglass energy is" not in sandglass("run", ROOT / "cases" / "column.toml").stderr


def test_damping_that_shortens_steps_is_named(block):
    block.write_text(dynamic(BARE, duration=0.2, damping=1e6))
    message = ["damping allows 1e-06 s", "remedy: damp less"]
    sandglass("run", block, code=3, message=message)
    block.write_text(dynamic(BARE, duration=0.2, damping=1e6, time_step=1e-5))
    sandglass(
        "run", block, code=2, message="above the stable step 1e-06 s, set by damping at step 0"
    )


def test_hourglass_modes_of_a_rigid_motion_are_rounding(tmp_path):
    case = tmp_path / "falling.toml"
    text = BARE[: BARE.index("[[displacement]]")] + "[[gravity]]\nvalue = [0.0, 0.0, -9.81]\n"
    case.write_text(dynamic(text, duration=0.1))
    outcome = sandglass("run", case, code=0)
    assert "hourglass energy" not in outcome.stdout + outcome.stderr


@pytest.mark.parametrize(("kappa", "warned"), [("0.12", False), ("0.14", True)])
def test_a_kappa_far_above_the_automatic_one_is_warned_of(block, kappa, warned):
    """That is 0.00649 at Poisson's ratio .49, and 20 times as much 0.1298."""
    outcome = sandglass("run", block, "--method", "tl-perturbation", "--kappa", kappa, code=0)
    assert (f"kappa {kappa} is 22 times the automatic one" in outcome.stderr) == warned


def test_a_method_without_control_is_warned_of(block):
    outcome = sandglass("run", block, "-m", "tl-none")
    assert "warning: method tl-none does not resist hourglass modes" in outcome.stderr


def test_energy_from_nowhere_is_warned_of(block):
    # Moved within 0.1 s and free afterwards. Hourglass forces integrated from rates while the
    # elements turn are no derivative of an energy.
    coarse = BARE.replace("[2, 2, 4]", "[1, 1, 4]")
    block.write_text(dynamic(coarse, duration=10.0, ramp_time=0.1))
    outcome = sandglass("run", block, "-m", "ul-assumed-strain")
    found = re.search(r"energy drifts: (\S+) % of the largest was gained", outcome.stderr)
    assert float(found[1]) > 5.0
    for damping in (0.0, 3.0):  # damping is accounted for
        block.write_text(dynamic(coarse, duration=10.0, ramp_time=0.1, damping=damping))
        assert "drifts" not in sandglass("run", block).stderr


# Places that are refused.


@pytest.mark.parametrize("option", ["-o", "--checkpoint"])
def test_the_case_is_no_place_for_results(block, option):
    before = block.read_bytes()
    case = block.parent / "case.h5"  # a case may have any name
    shutil.copy(block, case)
    sandglass("run", case, option, case, code=2, message=f"{case}: is an input of this command")
    assert case.read_bytes() == before


def test_no_command_overwrites_what_it_reads(block):
    folder = block.parent
    assert sandglass("mesh", block, "-o", folder / "mesh.h5").returncode == 0
    assert sandglass("run", block, "-o", folder / "answer.h5").returncode == 0
    generated = 'generator = "box"\nsize = [0.1, 0.1, 0.2]\nelements = [2, 2, 4]'
    own = folder / "own.toml"
    own.write_text(BARE.replace(generated, 'file = "mesh.h5"'))
    os.link(own, folder / "alias.h5")
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    for words in (
        ("run", own, "-o", "mesh.h5"),
        ("run", own, "-o", "alias.h5"),
        ("run", own, "--checkpoint", "mesh.h5"),
        ("mesh", own, "-o", "mesh.h5"),
        ("mesh", own, "--format", "h5", "-o", "own.toml"),
        ("score", "answer.h5", "--case", own, "--json", "answer.h5"),
        ("score", "answer.h5", "--case", own, "--json", "own.toml"),
        ("choose", own, "-o", "own.toml"),
        ("choose", own, "--json", "mesh.h5"),
        ("verify", own, "--json", "own.toml"),
        ("stability", own, "--json", "own.toml"),
        ("bench", own, "--json", "own.toml"),
    ):
        sandglass(*words, cwd=folder, code=2, message="is an input of this command")
        assert {file.name: file.read_bytes() for file in folder.iterdir()} == before, words


def test_the_depth_of_a_static_answer_is_that_of_its_end(block, tmp_path):
    """A ball is pressed in and half drawn back."""
    held = BARE[: BARE.rindex("[[displacement]]")]
    block.write_text(
        held
        + """
[[obstacle]]
name = "ball"
set = "head"
shape = "sphere"
point = [0.05, 0.05, 0.45]
radius = 0.25
displacement = [0.0, 0.0, -0.01]
times = [0.0, 0.5, 1.0]
factors = [0.0, 1.0, 0.5]

[relaxation]
levels = 4
"""
    )
    output = tmp_path / "a.h5"
    text = sandglass("run", block, "-o", output, code=0).stdout
    with h5py.File(output) as file:
        depths = file["history/depth"][:]
    assert depths.max() > 1.1 * depths[-1] > 0.0
    number, prefix = re.search(r"largest depth of contact (\S+) (u?m*m)", text).groups()
    scale = {"m": 1.0, "mm": 1e-3, "um": 1e-6}[prefix]
    assert scale * float(number) == pytest.approx(depths[-1], rel=5e-3)  # three digits


# Progress.


def test_a_terminal_shows_load_and_residual_from_the_start(block):
    block.write_text(BARE.replace("[2, 2, 4]", "[6, 6, 12]"))
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [BINARY, "run", block], stdout=subprocess.PIPE, stderr=theirs, text=True
    ) as process:
        os.close(theirs)
        shown = b""
        try:
            while part := os.read(ours, 4096):
                shown += part
        except OSError:  # Linux: the other end is closed
            pass
        text = process.communicate()[0]
    os.close(ours)
    assert process.returncode == 0
    first = shown.decode().split("\r\x1b[K")[1]
    assert re.search(r"^block \[.*\] +\d+ % load \S+, evaluation 1, residual \S+$", first)
    assert shown.endswith(b"\r\x1b[K")  # nothing is left of it
    assert "static equilibrium (stable): " in text
