"""Displacements of other programs are assigned to the nodes of the case, or rejected."""

import h5py
import numpy as np
import pytest
from generated import mutilated
from meshes import CELLS, POINTS, Refused, run, write

from common.errors import InputError
from exchange import matching

RANDOM = np.random.default_rng(7)
U = RANDOM.normal(size=POINTS.shape)  # the answer, node by node
ORDER = RANDOM.permutation(len(POINTS))  # in which other programs have the nodes
DIAGONAL = np.sqrt(6.0)  # of the cubes


def write_h5(path, **datasets):
    """Datasets by their names; "__" stands for a slash."""
    with h5py.File(path, "w") as file:
        for name, data in datasets.items():
            file[name.replace("__", "/")] = data
    return path


def write_csv(path, header, *columns):
    rows = np.column_stack(columns).tolist()
    lines = [header] + [",".join(map(repr, row)) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def write_frd(path, points, u):
    """As written by CalculiX: six digits, ids with gaps."""

    def block(rows):
        return "".join(
            f" -1{10 * i:10d}" + "".join(f"{x:12.5E}" for x in row) + "\n"
            for i, row in enumerate(rows, 1)
        )

    head = " -4  DISP        4    1\n -5  D1          1    2    1    0\n"
    path.write_text("    2C\n" + block(points) + " -3\n" + head + block(u) + " -3\n 9999\n")
    return path


def matched(capsys, path, *options, tolerance=1e-5):
    """(displacement at the nodes of the cubes, warnings)."""
    folder = path.parent
    mesh = write_h5(folder / "mesh.h5", mesh__points=POINTS, mesh__cells=CELLS)
    words = [path, mesh, folder / "out.h5", "--tolerance", tolerance, *options]
    warnings = run(capsys, "displacement", *words)
    with h5py.File(folder / "out.h5") as file:
        return file["displacement"][...], warnings


def write_text(path, *lines):
    path.write_text("\n".join(lines) + "\n")
    return path


def words(rows):
    return " ".join(map(repr, np.ravel(rows).tolist()))


def write_animation(path, points, u, name=b"Displacement"):
    """As written by OpenRadioss: big-endian, in single precision, with another vector before."""
    n, text = len(points), b"%-81b"
    counts = [n, 2, 1, 1, 1, 2, 0, 1]  # nodes, facets, parts, scalars, of facets, vectors, -, skews
    parts = [
        np.array([0x542C], ">i4"),
        np.array([0.25], ">f4"),
        b"".join(text % word for word in (b"Time=", b"ModAnim", b"Radioss Run=")),
        np.zeros(10, ">i4"),
        np.array(counts, ">i4"),
        np.zeros(6, ">u2"),
        (points + u).astype(">f4"),
        np.zeros(8, ">i4"),
        b"\1\1",
        np.zeros(1, ">i4"),
        b"%-50b" % b"part",
        np.zeros(3 * n, ">u2"),
        text % b"scalar" + text % b"of facets",
        np.zeros(n + 2, ">f4"),
        text % b"Velocity" + (name + b"\0" * 81)[:81],
        np.stack([7 * u, u]).astype(">f4"),
    ]
    path.write_bytes(b"".join(p if isinstance(p, bytes) else p.tobytes() for p in parts))
    return path


def h5(**datasets):
    """A function that writes them into a folder."""
    return lambda folder: write_h5(folder / "a.h5", **datasets)


def csv(header, *columns):
    """A function that writes a table into a folder."""
    return lambda folder: write_csv(folder / "a.csv", header, *columns)


LOG = ["*Step  = 1", "*Data  = ux;uy;uz", *(f"{i} 9 9 9" for i in range(1, 13)), "*Step  = 2"]
LOG += ["*Time  = 1", "*Data  = ux;uy;uz", *(f"{i + 1} {words(U[i])}" for i in ORDER)]
FRAMES = {"0000": 0 * U, "0010": U[ORDER], "0009": 3 * U}
FRAMES = {f"frames__{number}__displacement": u for number, u in FRAMES.items()}
ARRAYS = {"Displacement": U[ORDER], "velocity": U, "u": U[:, 0]}
MIXED = np.stack([U, POINTS], 1)[ORDER].transpose(2, 1, 0)[[2, 0, 0, 1, 1, 2], [0, 1, 0, 1, 0, 1]]
PARAVIEW = ",".join(f'"{name}:{i}"' for name in ("displacement", "Points") for i in range(3))
FILES = {
    "NiftySim": lambda f: write_text(
        f / "U.txt", *(f"{x * 2!r} {x!r} " for x in U.ravel().tolist())
    ),
    "FEBio": lambda f: write_text(f / "a.log", *LOG),
    "result of sandglass": h5(mesh__points=POINTS[ORDER], **FRAMES),
    "golden": h5(points=POINTS[ORDER], displacement=U[ORDER]),
    "by row": lambda f: write_h5(f / "a.hdf5", displacement=U),
    "vtu": lambda f: write(f / "a.vtu", POINTS[ORDER], [[0, 1]], "line", ARRAYS),
    "csv": csv("uz,x,ux,y,uy,z", *MIXED),
    "csv of ParaView": csv(PARAVIEW, U[ORDER], POINTS[ORDER]),
    "csv from 0": csv("id,ux,uy,uz", ORDER, U[ORDER]),
    "csv from 1": csv("ID, Ux, Uy, Uz", ORDER + 1, U[ORDER]),
}


@pytest.mark.parametrize("kind", FILES)
def test_every_format_gives_the_displacements_to_the_bit(tmp_path, capsys, kind):
    found, warnings = matched(capsys, FILES[kind](tmp_path))
    assert (found == U).all() and not warnings


def test_single_precision_of_openradioss(tmp_path, capsys):
    """Positions and displacements are rounded to 24 bits, of numbers up to six."""
    found, _ = matched(capsys, write_animation(tmp_path / "columnA001", POINTS[ORDER], U[ORDER]))
    assert np.abs(found - U).max() <= 2.0**-24 * np.abs(U).max() and found[0, 0] != 0


def test_positions_of_sofa(tmp_path, capsys):
    """It writes positions, up to six: half a unit of the last digit of each is lost."""
    start, end = f"  X0= {words(POINTS)}", f"  X= {words(POINTS + U)}"
    path = write_text(tmp_path / "a.state", "T= 0", start, f"  X= {words(U)}", "T= 1", end)
    assert np.abs(matched(capsys, path)[0] - U).max() <= 2 * 4 * 2.0**-53


DAMAGED = {
    "U.txt": [("1 2\n3 4\n5\n", "rows of equally many numbers"), ("1\n2\nx\n", "'x'")],
    "a.log": [
        ("*Data  = x;y;z\n1 2 3 4\n", "node_data data='ux;uy;uz'"),
        ("*Data  = ux;uy;uz\n1 2 3\n", "an id and three numbers"),
    ],
    "a.state": [("T= 1\n  X= 1 2 3\n", "lines X= and X0="), ("X= 1\nX0= 1\n", "equally many")],
}


@pytest.mark.parametrize(
    "name, text, message", [(n, *case) for n in DAMAGED for case in DAMAGED[n]]
)
def test_damaged_texts_of_other_programs(tmp_path, capsys, name, text, message):
    (tmp_path / name).write_text(text)
    with pytest.raises(Refused, match=f"{name}: .*{message}"):
        matched(capsys, tmp_path / name)


def test_damaged_animations_of_openradioss(tmp_path, capsys):
    path = write_animation(tmp_path / "aA001", POINTS, U, name=b"Rotation")
    with pytest.raises(Refused, match="has no displacements; the engine file needs /ANIM/VECT"):
        matched(capsys, path)
    path.write_bytes(write_animation(path, POINTS, U).read_bytes()[:-1])
    with pytest.raises(Refused, match="aA001: ends too early"):
        matched(capsys, path)
    path.write_bytes(b"no animation")
    with pytest.raises(Refused, match="is not an animation file of OpenRadioss"):
        matched(capsys, path)


def test_six_digits_of_calculix(tmp_path, capsys):
    found, _ = matched(capsys, write_frd(tmp_path / "a.frd", POINTS[ORDER], U[ORDER]))
    assert np.abs(found - U).max() <= 5e-6 * np.abs(U).max()


def test_a_field_by_name(tmp_path, capsys):
    path = write(tmp_path / "a.vtu", POINTS, CELLS, point_data={"U": U, "u": 2 * U, "w": 3 * U})
    for field, factor in (("U", 1), ("w", 3)):
        assert (matched(capsys, path, "--field", field)[0] == factor * U).all()
    for options in ([], ["--field", "v"]):
        with pytest.raises(
            Refused, match="choose one with --field NAME; its arrays .*: 'U', 'u', 'w'"
        ):
            matched(capsys, path, *options)
    path = write_csv(tmp_path / "a.csv", "id,w:0,w:1,w:2,ux,uy,uz", ORDER, U[ORDER], 2 * U[ORDER])
    assert (matched(capsys, path, "--field", "w")[0] == U).all()
    assert (matched(capsys, path)[0] == 2 * U).all()


def test_a_run_that_did_not_end_well_is_reported(tmp_path, capsys):
    path = FILES["golden"](tmp_path)
    with h5py.File(path, "r+") as file:
        file.attrs["status"] = "inverted"
    assert "warning" in matched(capsys, path)[1]


@pytest.mark.parametrize("shift, found", [(0.9e-5, True), (1.1e-5, False)])
def test_the_tolerance_is_a_share_of_the_diagonal(tmp_path, capsys, shift, found):
    points = POINTS.copy()
    points[5, 1] += shift * DIAGONAL
    path = write_h5(tmp_path / "a.h5", points=points, displacement=U)
    if found:
        assert (matched(capsys, path)[0] == U).all()
    else:
        with pytest.raises(Refused, match=r"1 nodes of the case .*: \(1, 0, 1\) by 1.1e-05"):
            matched(capsys, path)
        assert (matched(capsys, path, tolerance=2e-5)[0] == U).all()


MOVED = POINTS.copy()
MOVED[[2, 9]] += [[0.25, 0, 0], [0, 0, 3]]
TWICE = np.vstack([POINTS, POINTS[3:4]])
STRANGE = np.vstack([POINTS, [[7, 8, 9]]])
MORE = np.vstack([U, U[:1]])
WRONG = [
    (
        h5(points=MOVED, displacement=U),
        r"2 nodes of the case .*: \(1, 0, 2\) by 0.41, \(1, 1, 0\) by 0",
    ),
    (h5(points=POINTS[1:], displacement=U[1:]), r"11 nodes in the file, 12 in .*\(0, 0, 0\) by"),
    (h5(points=1000 * POINTS, displacement=U), r"diagonals 2449.49 and 2.44949 m"),
    (h5(points=TWICE, displacement=MORE), r"must occur exactly once \(13 nodes .*: \(0, 1, 0\)"),
    (h5(points=STRANGE, displacement=MORE), r"repeated nodes of the file: \(7, 8, 9\)"),
    (h5(displacement=U[1:]), "0 to 10 in 11 rows must be 0 to 11"),
    (h5(displacement=U * np.nan), "displacements must be finite"),
    (h5(displacement=U, points=U * np.inf), "coordinates must be finite"),
    (h5(displacement=U[:, :2]), r"shape \(12, 2\)"),
    (h5(displacement=U, points=U[1:]), "points has 11 rows, displacement 12"),
    (h5(displacement=b"text"), "required|shape"),
    (h5(displacement__u=U), "cannot be read as HDF5|shape"),
    (h5(u=U), "dataset 'displacement' .n, 3. is required"),
    (csv("id,ux,uy", ORDER, U[:, :2]), "columns id, ux, uy: columns id"),
    (csv("x,y,ux,uy,uz", U[:, :2], U), "or x, y, z, and ux"),
    (csv("id,ux,ux,uy,uz", ORDER, U[:, 0], U), "'ux' occurs twice"),
    (csv("id,ux,uy,uz", ORDER + 2, U), "ids 2 to 13 in 12 rows"),
    (csv("id,ux,uy,uz", ORDER // 2, U), "each once"),
    (csv("id,ux,uy,uz", ORDER + 0.5, U), "whole numbers"),
    (csv("id,ux,uy,uz", ORDER, U[:, [0, 1]]), "a.csv:2: 3 cells; 4 are"),
    (csv("id,ux,uy,uz", [], np.empty((0, 3))), "has no rows below"),
    (lambda folder: write_frd(folder / "a.frd", POINTS[1:], U[1:]), "11 nodes in the file"),
]


@pytest.mark.parametrize("make, message", WRONG)
def test_missing_and_ambiguous_data_are_refused(tmp_path, capsys, make, message):
    with pytest.raises(Refused, match=message):
        matched(capsys, make(tmp_path))
    assert not (tmp_path / "out.h5").exists()


def test_only_the_order_of_the_case_distinguishes_nodes_at_one_place():
    """Those of bodies that touch: in another order nothing says which is which."""
    assert (matching.by_coordinates(TWICE, TWICE, 1e-5, "a") == np.arange(len(TWICE))).all()
    with pytest.raises(InputError, match="must occur exactly once"):
        matching.by_coordinates(TWICE, TWICE[::-1], 1e-5, "a")


@pytest.mark.parametrize("text", ["nan", "inf", "x", ""])
def test_cells_of_a_table_that_are_no_numbers(tmp_path, capsys, text):
    path = FILES["csv from 0"](tmp_path)
    lines = path.read_text().splitlines()
    lines[3] = ",".join([*lines[3].split(",")[:3], text])
    path.write_text("\n".join(lines))
    with pytest.raises(Refused, match="a.csv:4: column 'uz': "):
        matched(capsys, path)


@pytest.mark.parametrize(
    "name", ["none.h5", "none.vtu", "none.csv", "none.frd", "a.txt", "folder.csv"]
)
def test_no_such_file(tmp_path, capsys, name):
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(
        Refused, match=f"{name}: (cannot be read: |ending '.txt'; allowed are .h5, )"
    ):
        matched(capsys, tmp_path / name)


@pytest.mark.parametrize("kind", FILES)
def test_whatever_happens_to_a_file_it_is_read_or_refused(tmp_path, capsys, kind):
    path = FILES[kind](tmp_path)
    data, rng = path.read_bytes(), np.random.default_rng(11)
    for _ in range(60):
        path.write_bytes(mutilated(rng, data))
        try:
            found, _ = matched(capsys, path)
            assert np.isfinite(found).all()
        except Refused as error:
            assert path.name in str(error)
