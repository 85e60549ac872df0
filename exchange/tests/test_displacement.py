"""Displacements of other programs are assigned to the nodes of the case, or rejected."""

import h5py
import numpy as np
import pytest
from meshes import CELLS, POINTS, Refused, run, write

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


FILES = {
    "result of sandglass": lambda f: write_h5(
        f / "a.h5",
        mesh__points=POINTS[ORDER],
        frames__0000__displacement=0 * U,
        frames__0010__displacement=U[ORDER],
        frames__0009__displacement=3 * U,
    ),
    "golden": lambda f: write_h5(f / "a.h5", points=POINTS[ORDER], displacement=U[ORDER]),
    "by row": lambda f: write_h5(f / "a.hdf5", displacement=U),
    "vtu": lambda f: write(
        f / "a.vtu",
        POINTS[ORDER],
        [[0, 1]],
        "line",
        {"Displacement": U[ORDER], "velocity": U, "u": U[:, 0]},
    ),
    "csv": lambda f: write_csv(
        f / "a.csv",
        "uz,x,ux,y,uy,z",
        *np.stack([U, POINTS], 1)[ORDER].transpose(2, 1, 0)[[2, 0, 0, 1, 1, 2], [0, 1, 0, 1, 0, 1]],
    ),
    "csv of ParaView": lambda f: write_csv(
        f / "a.csv",
        '"displacement:0","displacement:1","displacement:2","Points:0","Points:1","Points:2"',
        U[ORDER],
        POINTS[ORDER],
    ),
    "csv from 0": lambda f: write_csv(f / "a.csv", "id,ux,uy,uz", ORDER, U[ORDER]),
    "csv from 1": lambda f: write_csv(f / "a.csv", "ID, Ux, Uy, Uz", ORDER + 1, U[ORDER]),
}


@pytest.mark.parametrize("kind", FILES)
def test_every_format_gives_the_displacements_to_the_bit(tmp_path, capsys, kind):
    found, warnings = matched(capsys, FILES[kind](tmp_path))
    assert (found == U).all() and not warnings


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


def test_a_run_that_did_not_end_well_is_told(tmp_path, capsys):
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


def points_changed(change):
    points, u = change(POINTS.copy(), U.copy())
    return lambda f: write_h5(f / "a.h5", points=points, displacement=u)


def moved(points, u):
    points[[2, 9]] += [[0.25, 0, 0], [0, 0, 3]]
    return points, u


@pytest.mark.parametrize(
    "make, told",
    [
        (
            points_changed(moved),
            r"2 nodes of the case .*farthest: \(1, 0, 2\) by 0.41, \(1, 1, 0\) by 0.1,?",
        ),
        (
            points_changed(lambda p, u: (p[1:], u[1:])),
            r"11 nodes in the file, 12 in .*\(0, 0, 0\) by",
        ),
        (points_changed(lambda p, u: (1000 * p, u)), r"diagonals 2449.49 and 2.44949 m"),
        (
            points_changed(lambda p, u: (np.vstack([p, p[3:4]]), np.vstack([u, u[3:4]]))),
            r"must occur exactly once \(13 nodes in the file, 12 in the case\).*: \(0, 1, 0\)",
        ),
        (
            points_changed(lambda p, u: (np.vstack([p, [[7, 8, 9]]]), np.vstack([u, u[:1]]))),
            r"repeated nodes of the file: \(7, 8, 9\)",
        ),
        (
            lambda f: write_h5(f / "a.h5", displacement=U[1:]),
            "0 to 10 in 11 rows must be 0 to 11",
        ),
        (lambda f: write_h5(f / "a.h5", displacement=U * np.nan), "displacements must be finite"),
        (
            lambda f: write_h5(f / "a.h5", displacement=U, points=U / 0),
            "coordinates must be finite",
        ),
        (lambda f: write_h5(f / "a.h5", displacement=U[:, :2]), r"shape \(12, 2\)"),
        (
            lambda f: write_h5(f / "a.h5", displacement=U, points=U[1:]),
            "points has 11 rows, displacement 12",
        ),
        (lambda f: write_h5(f / "a.h5", displacement=b"text"), "required|shape"),
        (lambda f: write_h5(f / "a.h5", displacement__u=U), "cannot be read as HDF5|shape"),
        (lambda f: write_h5(f / "a.h5", u=U), "dataset 'displacement' .n, 3. is required"),
        (
            lambda f: write_csv(f / "a.csv", "id,ux,uy", ORDER, U[:, :2]),
            "columns id, ux, uy: columns id",
        ),
        (lambda f: write_csv(f / "a.csv", "x,y,ux,uy,uz", U[:, :2], U), "or x, y, z, and ux"),
        (
            lambda f: write_csv(f / "a.csv", "id,ux,ux,uy,uz", ORDER, U[:, 0], U),
            "'ux' occurs twice",
        ),
        (lambda f: write_csv(f / "a.csv", "id,ux,uy,uz", ORDER + 2, U), "ids 2 to 13 in 12 rows"),
        (lambda f: write_csv(f / "a.csv", "id,ux,uy,uz", ORDER // 2, U), "each once"),
        (lambda f: write_csv(f / "a.csv", "id,ux,uy,uz", ORDER + 0.5, U), "whole numbers"),
        (
            lambda f: write_csv(f / "a.csv", "id,ux,uy,uz", ORDER, U[:, [0, 1]]),
            "a.csv:2: 3 cells; 4 are",
        ),
        (
            lambda f: write_csv(f / "a.csv", "id,ux,uy,uz", [], np.empty((0, 3))),
            "has no rows below",
        ),
        (lambda f: write_frd(f / "a.frd", POINTS[1:], U[1:]), "11 nodes in the file"),
    ],
)
def test_what_is_not_found_once_is_refused(tmp_path, capsys, make, told):
    with np.errstate(divide="ignore"), pytest.raises(Refused, match=told):
        matched(capsys, make(tmp_path))
    assert not (tmp_path / "out.h5").exists()


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
    data, random = path.read_bytes(), np.random.default_rng(11)
    damaged = [data[:length] for length in range(0, len(data), max(1, len(data) // 15))]
    for _ in range(40):
        changed = bytearray(data)
        for at in random.integers(0, len(data), 3):
            changed[at] = random.integers(0, 256)
        damaged.append(bytes(changed))
    for content in damaged:
        path.write_bytes(content)
        try:
            found, _ = matched(capsys, path)
            assert np.isfinite(found).all()
        except Refused as told:
            assert path.name in str(told)
