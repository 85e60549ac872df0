"""Converts between the files of other programs and Sandglass's own; the solver calls it.

Usage: convert.py mesh FOREIGN MESH.h5 [--spacing X Y Z]      read a mesh
       convert.py write MESH.h5 FILE --format vtu|xdmf|inp
       convert.py deck PROBLEM.h5 FILE PROGRAM [--element E] [--hourglass H]
       convert.py displacement FOREIGN MESH.h5 OUT.h5 --tolerance T [--field NAME]
Exit codes: 0 done, 2 bad input, reported in one line on standard output, 3 the disk or the memory
is full. Warnings go to standard error.
"""

import argparse
import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path[0] = str(Path(__file__).resolve().parent.parent)

PACKAGES = (
    "python3-numpy, python3-h5py, python3-scipy and python3-meshio (ci/setup build), for NIfTI "
    "python3-nibabel (ci/setup images)"
)
try:
    import numpy as np

    from common.errors import InputError
    from common.files import write_whole
    from exchange import abaqus_file, abaqus_writer, csv_file, decks, frd_file, gmsh_file, hdf5_file
    from exchange import image_file, radioss_file, text_results, vtu_file
    from exchange.foreign_mesh import to_hexahedra
except ImportError as error:
    print(f"{error.name} is not installed; files of other programs need packages {PACKAGES}")
    sys.exit(2)

MESHES = {".msh": gmsh_file.read, ".inp": abaqus_file.read}
MESHES |= {".vtu": vtu_file.read, ".vtk": vtu_file.read}
# A segmentation: each voxel with a label is an element.
IMAGES = {
    ".npy": image_file.read_npy,
    ".nii": image_file.read_nifti,
    ".gz": image_file.read_nifti,
}
# Answers: ending -> function of path, field and warn that returns points (n, 3) or None, ids (n,)
# or None, and displacement (n, 3).
DISPLACEMENTS = {
    ".csv": lambda path, field, warn: csv_file.read(path, field),
    ".frd": lambda path, field, warn: _at_points(frd_file.read(path)),
    ".h5": lambda path, field, warn: _at_points(hdf5_file.read_displacement(path, warn)),
    ".hdf5": lambda path, field, warn: _at_points(hdf5_file.read_displacement(path, warn)),
    ".log": lambda path, field, warn: (None, *text_results.read_febio(path)),
    ".state": lambda path, field, warn: (None, None, text_results.read_sofa(path)),
    ".txt": lambda path, field, warn: (None, None, text_results.read_niftysim(path)),
    ".vtk": lambda path, field, warn: _at_points(vtu_file.read_displacement(path, field)),
    ".vtu": lambda path, field, warn: _at_points(vtu_file.read_displacement(path, field)),
}


def read_mesh(source, output, spacing):
    """Reads a mesh of another program, or a labelled image, and writes it as HDF5.

    spacing: size (3,) of an image's voxels, m, or None. Raises InputError.
    """
    ending = _ending(source, MESHES | IMAGES)
    if ending in IMAGES:
        found = IMAGES[ending](source, spacing)
    elif spacing is None:
        found = MESHES[ending](source)
    else:
        raise InputError(f"{source}: mesh.spacing was given; it applies only to images")
    mesh = to_hexahedra(found, source, lambda text: _warn(source, text))
    hdf5_file.write_mesh(output, mesh)


def _at_points(found):
    """(points, displacement) with no ids between them."""
    points, displacement = found
    return points, None, displacement


def write_mesh(source, output, name):
    """Writes a mesh in a format by its name. Raises InputError."""
    mesh = hdf5_file.read_mesh(source)
    if name != "inp":
        vtu_file.write(output, mesh, name)
        return
    lines = ["*HEADING", "sandglass", *abaqus_writer.mesh_lines(mesh)]
    output.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_deck(source, output, program, element, hourglass):
    """Writes the files of a deck. Raises InputError."""
    problem = hdf5_file.read_problem(source)
    for path, text in decks.files(program, problem, output, element, hourglass).items():
        write_whole(path, text)


# Of the diagonal: the distance at which two nodes are one, as `sandglass score` takes it.
USUAL_TOLERANCE = 1e-5


def match_displacement(source, mesh_path, output, tolerance=USUAL_TOLERANCE, field=None):
    """Writes the displacements of a file in the node order of a mesh. Raises InputError.

    source, mesh_path, output: Paths. tolerance: as for matching.by_coordinates. field: name of the
    displacements in the file, or None for the usual ones.
    """
    from exchange import matching  # its library takes long to load

    if radioss_file.is_animation(source):
        points, ids, displacement = _at_points(radioss_file.read_displacement(source))
    else:
        read = DISPLACEMENTS[_ending(source, DISPLACEMENTS)]
        points, ids, displacement = read(source, field, lambda t: _warn(source, t))
    nodes = hdf5_file.read_mesh(mesh_path).points
    for name, values in (("coordinates", points), ("displacements", displacement)):
        if values is not None and not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
            raise InputError(
                f"{source}: {name} must be finite; the values of node {row} (from 0) are not"
            )
    if not len(displacement):
        raise InputError(f"{source}: has no nodes")
    if points is not None:
        rows = matching.by_coordinates(nodes, points, tolerance, source)
    else:
        rows = matching.by_ids(
            np.arange(len(displacement)) if ids is None else ids, len(nodes), source
        )
    hdf5_file.write_displacement(output, displacement[rows])


def _ending(path, allowed):
    """The suffix of an existing file, in lower case. Raises InputError."""
    if path.suffix.lower() not in allowed:
        raise InputError(f"{path}: ending '{path.suffix}'; allowed are {', '.join(allowed)}")
    if path.suffix.lower() == ".gz" and path.stem[-4:].lower() != ".nii":
        raise InputError(f"{path}: is packed; unpack it with gunzip; only .nii.gz is read as it is")
    try:
        with open(path, "rb"):
            pass
    except OSError as error:
        geometry = path.with_suffix(".geo")
        hint = ""
        if path.suffix.lower() == ".msh" and geometry.exists() and not path.exists():
            hint = f"; `gmsh -3 {geometry} -o {path}` makes it"
        raise InputError(f"{path}: cannot be read: {error.strerror}{hint}") from error
    return path.suffix.lower()


def _warn(path, text):
    print(f"warning: {path}: {text}", file=sys.stderr)


def main(arguments=None):
    """The command line. Returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def command(name, work, *paths):
        """A command whose arguments are those of `work`, paths first."""
        added = commands.add_parser(name)
        added.set_defaults(work=work)
        for path in paths:
            added.add_argument(path, type=Path)
        return added.add_argument

    command("mesh", read_mesh, "source", "output")("--spacing", type=float, nargs=3)
    add = command("write", write_mesh, "source", "output")
    add("--format", choices=("vtu", "xdmf", "inp"), required=True, dest="name")
    add = command("deck", write_deck, "source", "output")
    add("program")
    add("--element", default="")
    add("--hourglass", type=float)
    add = command("displacement", match_displacement, "source", "mesh_path", "output")
    add("--tolerance", type=float, required=True)
    add("--field")
    options = vars(parser.parse_args(arguments))
    work = options.pop("work")
    try:
        work(**options)
    except InputError as error:
        print(" ".join(str(error).splitlines()))
        return 2
    except ImportError as error:
        print(f"{error.name} is not installed; files of other programs need packages {PACKAGES}")
        return 2
    except MemoryError:
        print("not enough memory")
        return 3
    except OSError as error:
        print(error.strerror or error)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
