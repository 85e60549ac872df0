"""The package sandglass: bodies from arrays, answers as arrays, the same as the program's."""

import os
import re
import subprocess
import sys
import threading

import h5py
import numpy as np
import pytest
from command_line import BARE, ROOT, dynamic, sandglass as program
from module_folder import FOLDER, readme_code

import sandglass as sg

LAW = {"young_modulus": 3000.0, "poisson_ratio": 0.45, "density": 1000.0}
SETS = {"base": {"z": [0, 0]}, "head": {"z": [0.2, 0.2]}}


def near(a, b):
    return np.allclose(a, b, rtol=0, atol=1e-10 * np.abs(b).max(initial=0))


def loads():
    return [
        sg.Displacement(set="base", value=(0, 0, 0)),
        sg.Displacement(set="head", value=np.array([0.02, 0, 0.01])),
    ]


def body(*more, **options):
    box = sg.Box(size=(0.1, 0.1, 0.2), elements=(2, 2, 4))
    return sg.Body(box, sg.NeoHookean(**LAW), [*loads(), *more], sets=SETS, **options)


@pytest.fixture(scope="module")
def solution():
    return body().solve()


@pytest.mark.parametrize("more", [[], [sg.Dynamics(duration=0.05, frames=3)]])
def test_it_is_the_answer_of_the_program(more, tmp_path):
    """Of the case that `save` writes, up to roundings: inline functions are compiled twice."""
    made = body(*more)
    made.save(tmp_path / "made.toml")
    program("run", tmp_path / "made.toml", "-o", tmp_path / "made.h5", code=0)
    found = made.solve()
    with h5py.File(tmp_path / "made.h5") as file:
        frames = [file["frames"][name] for name in sorted(file["frames"])]
        assert len(found) == len(frames)
        for k, frame in enumerate(frames):
            own = found.frame(k)
            for name, other in [("volume_ratio", "jacobian"), ("displacement", "displacement")]:
                assert near(own[name], frame[other][:])
            assert near(own["stress"].reshape(-1), frame["stress"][:].reshape(-1))
            for name, force in own["reactions"].items():
                assert near(force, frame["reaction"][name][:])
        for name in ("strain", "hourglass", "external_work", "kinetic"):
            column = [key for key in file["history"] if key.startswith(name)]
            assert near(found.history[name], file["history"][column[0]][:])
    found.save(tmp_path / "own.h5")
    scored = [
        program("score", tmp_path / f"{name}.h5", "--case", tmp_path / "made.toml").stdout
        for name in (["made", "own"] if not more else [])
    ]
    assert [text.replace("made", "own") for text in scored] == scored[1:] * 2


def test_an_accuracy_is_read_as_on_the_command_line():
    """A share or a text in percent; case files, and thus `sg.Method`, have numbers alone."""
    made = body(sg.Method(name="tl-adaptive"))
    one, other = made.solve(accuracy="2%"), made.solve(accuracy=0.02)
    assert np.array_equal(one.displacement, other.displacement)
    with pytest.raises(sg.InputError, match="accuracy = '200%' must be a share in"):
        made.solve(accuracy="200%")


def test_arrays_have_their_shapes_and_are_read_only(solution):
    n, m = 45, 16
    shapes = {"displacement": (n, 3), "stress": (m, 3, 3), "volume_ratio": (m,)}
    for name, shape in (shapes | {"displacements": (2, n, 3), "points": (n, 3)}).items():
        array = getattr(solution, name)
        assert array.shape == shape
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    assert solution.times[0] == 0.0 and solution.times[1] >= 1.0
    skew = solution.stress - solution.stress.transpose(0, 2, 1)
    assert np.abs(skew).max() < 1e-7 * np.abs(solution.stress).max()  # rows are not mixed up
    head = solution.sets["head"]
    assert np.array_equal(solution.displacement[head], np.tile([0.02, 0, 0.01], (9, 1)))
    assert np.allclose(solution.reactions["head"], -solution.reactions["base"], atol=1e-7)
    assert solution.energies["strain"] > 10 * solution.energies["hourglass"] > 0
    largest, rms = solution.estimate()
    assert 0 < rms < largest < 0.02
    with pytest.raises(IndexError, match=r"frame 2 must be in \[-2, 2\)"):
        solution.frame(2)


def test_every_table_of_the_solver_is_a_class_with_its_parameters():
    """The classes and `sandglass run --describe` have the same tables, keys and words."""
    described = program("run", "--describe").stdout
    for name, cls in sg.tables.CLASSES.items():
        assert getattr(sg, name) is cls and cls.__doc__
        declared = cls._declared
        table = declared["table"]
        if declared["choice"]:
            head = f'\n{table}.{declared["choice_key"]} = "{declared["choice"]}": '
            assert f"{head}{declared['summary']}\n" in described
        else:
            assert f"[{table}]" in described
        for key in cls._keys:
            assert re.search(rf"\b{key}\b", described) and f"`{key}`" in cls.__doc__
    lines = re.findall(r"^  (\w+)\.(\w+) .*\[.*\]", described, re.MULTILINE)
    known = {(c._declared["table"], key) for c in sg.tables.CLASSES.values() for key in c._keys}
    assert len(lines) > 150 and set(lines) <= known


def test_repr_is_a_case_that_runs_and_is_read_again(tmp_path):
    made = body(sg.Relaxation(levels=2), sg.Method(name="tl-enhanced"), name='a "case"')
    (tmp_path / "made.toml").write_text(repr(made))
    assert "static equilibrium" in program("run", tmp_path / "made.toml", code=0).stdout
    again = sg.Body.read(tmp_path / "made.toml")
    assert repr(again) == repr(made) == repr(sg.Body.of_toml(repr(made)))
    assert np.array_equal(again.solve().displacements, made.solve().displacements)
    law = sg.Yeoh(c1=1e3, c2=-5, c3=0, bulk_modulus=np.float32(5e4), density=1000)
    assert eval(repr(law)) == law and law != sg.NeoHookean(**LAW)


@pytest.mark.parametrize("file", sorted((ROOT / "cases").glob("*.toml")), ids=lambda f: f.stem)
def test_every_case_without_variants_is_read_and_written(file):
    if "[[variants" in file.read_text():
        with pytest.raises(sg.InputError, match=r"\[variants\] make several cases"):
            sg.Body.read(file)
        return
    made = sg.Body.read(file)
    assert repr(sg.Body.of_toml(repr(made))) == repr(made)


def test_arrays_meshio_vtk_and_files_make_the_same_body(solution, tmp_path):
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("vtkmodules")
    sets = {name: solution.sets[name] for name in SETS}
    element_sets = {"low": np.arange(8)}
    mesh = sg.Mesh(solution.points, solution.cells, sets, element_sets)
    flags = {name: np.isin(np.arange(45), nodes) * 1 for name, nodes in sets.items()}
    masks = {name: flag == 1 for name, flag in flags.items()}
    masked = sg.Mesh(solution.points, solution.cells, masks, {"low": np.arange(16) < 8})
    lone = np.vstack([solution.points, [[9, 9, 9]]])  # a node of no cell is left out
    foreign = meshio.Mesh(lone, [("line", [[0, 45]]), ("hexahedron", solution.cells)])
    foreign.point_sets, foreign.cell_sets = sets, {"low": [np.array([], int), np.arange(8)]}
    grid = solution.to_vtk()
    from vtkmodules.util.numpy_support import numpy_to_vtk

    for name, flag in flags.items():
        array = numpy_to_vtk(flag, deep=True)
        array.SetName(name)
        grid.GetPointData().AddArray(array)
    low = numpy_to_vtk(np.isin(np.arange(16), element_sets["low"]) * 1, deep=True)
    low.SetName("low")
    grid.GetCellData().AddArray(low)
    mesh.save(tmp_path / "mesh.h5")
    for source in (mesh, masked, foreign, grid, tmp_path / "mesh.h5"):
        laws = [sg.NeoHookean(**LAW), sg.NeoHookean(**LAW, elements="low")]
        made = sg.Body(source, laws, loads())
        found = (
            made.solve().displacement
        )  # two laws, so other groups of elements: the tolerance of the search
        assert np.allclose(found, solution.displacement, rtol=0, atol=1e-7 * 0.02)
        made.save(tmp_path / "made.toml")
        again = sg.Body.read(tmp_path / "made.toml")
        assert np.array_equal(again.mesh.element_sets["low"], np.arange(8))
        assert np.array_equal(again.solve().displacement, found)


def test_results_are_written_for_others(solution, tmp_path):
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("vtkmodules")
    solution.save(tmp_path / "a.vtu")
    read = meshio.read(tmp_path / "a.vtu")
    assert np.array_equal(read.point_data["displacement"], solution.displacement)
    assert np.array_equal(read.cell_data["stress"][0].ravel(), solution.stress.ravel())
    solution.save(tmp_path / "a.npz")
    assert np.array_equal(np.load(tmp_path / "a.npz")["stress"], solution.stress)
    with pytest.raises(sg.InputError, match="must end in .h5, .vtu or .npz"):
        solution.save(tmp_path / "a.txt")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.npz", "a.vtu"]


def test_a_method_may_be_given_where_it_is_solved(solution):
    other = body().solve(name="tl-mean-dilatation", threads=2)
    largest = np.linalg.norm(other.displacement - solution.displacement, axis=1).max()
    assert largest == pytest.approx(
        solution.estimate()[0], rel=0.05
    )  # its last hundredth, and more
    set_so = body(sg.Method(name="tl-mean-dilatation")).solve()
    assert np.array_equal(set_so.displacement, other.displacement)


def test_parameters_may_be_set(solution):
    """Loads are displacements, so twice the modulus is twice the stress, up to the tolerance."""
    stiff = body()
    stiff.material.young_modulus = 6000
    stress = stiff.solve().stress
    assert np.allclose(stress, 2 * solution.stress, rtol=0, atol=1e-6 * np.abs(stress).max())


def test_a_simulation_of_a_body_is_that_of_its_case(tmp_path):
    (tmp_path / "block.toml").write_text(dynamic(BARE, duration=0.2))
    by_file = sg.Simulation(tmp_path / "block.toml")
    made = sg.Body.read(tmp_path / "block.toml").simulation()
    for each in (by_file, made):
        each.move("head", (0.01, 0, 0))
        each.advance(0.02)
    assert np.array_equal(by_file.displacements, made.displacements)


def test_progress_interrupts_and_other_threads():
    """The motion would take minutes; a callback that raises ends it, while another thread runs."""
    shares, counted, done = [], [], threading.Event()

    def progress(share):
        shares.append(share)
        if len(shares) == 3:
            raise KeyboardInterrupt

    def count():
        while not done.is_set():
            counted.append(1)
            done.wait(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            body(sg.Dynamics(duration=1e5)).solve(progress=progress)
    finally:
        done.set()
        thread.join()
    assert shares == sorted(shares) and len(counted) > 3


def test_the_readme_leads_from_arrays_to_a_picture(tmp_path):
    """A column that bends: its picture has the colours of stresses, and is no blank page."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    code = readme_code("Sandglass in Python")
    assert len([line for line in code.splitlines() if line]) <= 11  # with the imports
    environment = os.environ | {"PYTHONPATH": FOLDER, "MPLBACKEND": "Agg", "HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    picture = pyplot.imread(tmp_path / "column.png")[..., :3]
    coloured = np.ptp(picture, axis=2) > 0.2
    assert 0.05 < coloured.mean() < 0.9  # the column is slender
    assert len(np.unique((picture[coloured] * 8).astype(int), axis=0)) > 20


def test_stubs_are_written_for_type_checkers():
    import ast

    folder = os.path.join(FOLDER, "sandglass")
    assert os.path.exists(os.path.join(folder, "py.typed"))
    with open(os.path.join(folder, "tables.pyi")) as file:
        classes = {c.name: c for c in ast.parse(file.read()).body if isinstance(c, ast.ClassDef)}
    assert set(classes) == {"Table", *sg.tables.CLASSES}
    for name, cls in sg.tables.CLASSES.items():
        (init,) = [node for node in classes[name].body if isinstance(node, ast.FunctionDef)]
        assert [argument.arg for argument in init.args.kwonlyargs] == list(cls._keys)


def test_everything_public_is_documented():
    for name in sg.__all__:
        thing = getattr(sg, name)
        assert thing.__doc__, name
        if isinstance(thing, type) and thing not in sg.tables.CLASSES.values():
            for member, value in vars(thing).items():
                if not member.startswith("_") and callable(value):
                    assert value.__doc__, f"{name}.{member}"
