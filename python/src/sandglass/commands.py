"""What the commands of the program compute, as functions.

A case is the name of a canonical case, the path of a case file, or an `sg.Body`. Named cases have
stored references; a body has those that its tables name. All functions work in the library itself,
release the GIL, end on Ctrl-C and, with `progress=True`, show how far they are; a callable gets
the completed share of the work instead. They raise InputError and ComputationError with the
messages of the program, and TypeError for arguments of another type.
"""

import contextlib
import os
import pathlib
import tempfile

import _sandglass
from sandglass.arguments import path_text, quantity_text
from sandglass.body import Body
from sandglass.progress import shown
from sandglass.record import Record, record_of
from sandglass.solution import Solution


def cases():
    """The canonical cases: a list of records of name, answer, cases, requirement and file.

    `cases` are the names of the variants, or the one name.
    """
    return _called("cases")


def methods():
    """The methods: a list of records of name, takes_kappa and summary."""
    return _called("methods")


def axes():
    """The axes of failure maps: a list of records of name, range, meaning and usual values."""
    return _called("axes")


def choose(
    case,
    *,
    tolerance="1%",
    against=None,
    realtime=False,
    budget=None,
    methods=(),
    threads=1,
    all=False,
    progress=None,
):
    """The cheapest method, precision and mesh that are accurate enough for a case on this machine.

    `tolerance`: the largest error at any node as a share of the largest imposed displacement, 0.01
    or "1%". `against`: errors are those against the stored "golden" or "truth"; None: against
    tl-mean-dilatation on the same mesh, computed here. `realtime`: a simulated second must take at
    most a second. `budget`: the time a step or a condensed answer may take, in s or as "1ms".
    `methods`: only these. `all`: try the costlier ones, too.

    Returns a record: `rungs`, the candidates from the cheapest to the costliest, `chosen`, an
    index into them or None, `remarks`, and `body`, the `sg.Body` with the chosen mesh and
    settings, or None if nothing suffices.
    """
    with _files(case) as (file,), tempfile.TemporaryDirectory() as folder:
        output = os.path.join(folder, "chosen.toml")
        choice = _called(
            "choose",
            progress,
            case=file,
            tolerance=quantity_text("tolerance", tolerance),
            against=against,
            realtime=realtime,
            budget=None if budget is None else quantity_text("budget", budget),
            methods=methods,
            threads=threads,
            all=all,
            output=output,
        )
        choice.body = None
        if choice.chosen is not None:
            choice.body = Body.read(output)
            if isinstance(case, Body) and case.mesh._table is None:
                choice.body.mesh._table = None  # its file is gone with the folder
    return choice


def verify(
    *cases,
    precision="double",
    device="cpu",
    costs=True,
    threads=0,
    results=None,
    progress=None,
):
    """Compares all methods with the references of cases; without arguments, of all canonical ones.

    `precision`: "double" or "float"; limits are checked in double only. `device`: the processor
    that computes the forces of elements, such as "opencl"; what it cannot compute is left out.
    `costs`: whether to measure the cost of steps on this processor. `threads`: runs at the same
    time, 0 for one per processor. `results`: a folder for the final state of every run.

    Returns a record: `records`, one for each case, method and kappa, with errors against `golden`
    and `truth` as fractions; `published`, those of cases with published values; `limits` of the
    cases, each with `holds`.
    """
    with _files(*cases) as files:
        folder = None if results is None else path_text("results", results)
        given = dict(cases=files, precision=precision, costs=costs, threads=threads, results=folder)
        return _called("verify", progress, device=device, **given)


def score(displacement, case, *, name=None, field="", tolerance=1e-5, progress=None):
    """The errors of displacements that any program computed, against the references of a case.

    `displacement`: an array (n, 3) in m, in the numbering of the case's mesh; an `sg.Solution`; or
    the path of a file of Sandglass or another program, with displacements in `field`, whose nodes
    may be in another order: those closer than `tolerance` times the diagonal are the same. `name`
    is that of the method. A case without a golden is compared with tl-mean-dilatation, as `twin`.

    Returns a record with `golden`, `truth` and `twin`, each with `max_relative_error`,
    `profile_relative_error` and `rms_relative_error` as fractions, or None; and `finding`.
    """
    if isinstance(displacement, Solution):
        displacement = displacement.displacement
    if isinstance(displacement, (str, os.PathLike)):
        displacement = path_text("displacement", displacement)
        name = pathlib.Path(displacement).stem if name is None else name
    name = "displacements" if name is None else name
    with _files(case) as (file,):
        given = dict(displacement=displacement, case=file, name=name, field=field)
        found = _called("score", progress, tolerance=tolerance, **given)
    return found.records[0]


def estimate(answer, *, against="golden"):
    """The largest and the rms distance, m, of a static answer from a better one.

    `answer`: an `sg.Solution`, or an `sg.Body`, which is solved first. `against`: "golden", the
    mean-dilatation element on the same mesh, or "truth", ever finer meshes.
    """
    if isinstance(answer, Body):
        answer = answer.solve()
    if not isinstance(answer, Solution):
        kind = type(answer).__name__
        raise TypeError(f"answer must be an sg.Solution or an sg.Body, but is a {kind}")
    return answer.estimate(against)


def flops():
    """The operations per element and step of every method and law, counted by running the kernels.

    Returns a record with `records` of method, law, form, part, add, mul, div, special, total and
    bytes, and `programs`, the force of each method's element as straight-line code: operations,
    those fused, instructions, the longest chain, values alive, and the share of the peak that the
    mix of operations allows.
    """
    return _called("flops")


def kernels(
    method, case, *, dialect="c", precision=None, material=None, step=False, constants=None
):
    """The force of a method's elements with a case's law as source code for other processors.

    `dialect`: the language; the message about a wrong one lists all. `precision`: "double" or
    "float"; None: double where the dialect has it. `material`: its number in the case, from 1.
    `step`: add the kernels of nodes, which take time steps; the force then reads nodes by place.
    `constants`: a file for the array of this name for the elements of the case's mesh, in the
    numbers of the kernel. Returns the text.
    """
    with _files(case) as (file,):
        given = dict(case=file, dialect=dialect, precision=precision, material=material, step=step)
        given["constants"] = "" if constants is None else path_text("constants", constants)
        return _called("kernels", method=method, **given)


def write_mesh(case, output, *, format="", deck="", element="", hourglass=None):
    """Writes the mesh and node sets of a case to a file for other programs.

    `output`: .h5, .vtu, .xdmf or .inp, or a file in `format`. With `deck`, "calculix", "febio",
    "niftysim" or "openradioss", it is a complete input of that program, with its `element` and
    `hourglass` coefficient.

    Returns a record of the number of nodes and elements and the quality of the elements: scaled
    Jacobians, `counts` at or below zero and in each tenth of (0, 1], and the `worst` elements.
    """
    output = path_text("output", output)
    with _files(case) as (file,):
        given = dict(format=format, deck=deck, element=element, hourglass=hourglass)
        return _called("write_mesh", case=file, output=output, **given)


def stability(case, *, maps=(), values=(), methods=(), folder=None, threads=0, progress=None):
    """Where each method fails on a quasi-static case, over kappa, load, step and other axes.

    `maps`: "X,Y" or "X" of the names in `axes()`; none: all usual ones. `values`: other values of
    an axis, "AXIS=V1,V2". `methods`: only these. `folder`: of finished cells, which are not
    computed again; None: they are not kept. `threads`: runs at the same time, 0 for one per
    processor. Returns a record: `maps`, each with `x`, `y` and `cells` with their `finding`.
    """
    with _files(case) as (file,), tempfile.TemporaryDirectory() as own:
        place = own if folder is None else path_text("folder", folder)
        given = dict(maps=maps, values=values, methods=methods, folder=place, threads=threads)
        return _called("stability", progress, case=file, **given)


def bench(
    *cases,
    rest=False,
    bodies=None,
    elements=(),
    cubes=(),
    threads=(),
    methods=(),
    precision=("double", "float"),
    device="cpu",
    repetitions=None,
    progress=None,
):
    """Times every method per element and step, and compares it with the speed of the machine.

    `elements`, `cubes`: also boxes of about these numbers of elements, or of cubes. `threads`,
    `methods`, `precision`: lists of those to time. `repetitions`: batches of about 0.5 ms for each
    variant. `device`: also time another processor, such as "opencl". `rest`: times quasi-static
    cases until static equilibrium instead. `bodies`: times this many bodies of each case side by
    side and one by one instead. A variant with a wrong result is not timed. Returns a record with
    `records`.
    """
    if type(rest) is not bool:
        raise TypeError(f"rest must be True or False, but is a {type(rest).__name__}")
    if sum([rest, bodies is not None, bool(elements or cubes)]) > 1:
        raise _sandglass.InputError("rest, bodies, and elements or cubes exclude each other")
    if device != "cpu" and (rest or bodies is not None):
        raise _sandglass.InputError(f"device = {device!r} must be 'cpu' with rest and bodies")
    kind = "bench_rest" if rest else "bench" if bodies is None else "bench_bodies"
    with _files(*cases) as files:
        return _called(
            kind,
            progress,
            cases=files or (["column"] if kind == "bench_bodies" else []),
            bodies=bodies,
            elements=elements,
            cubes=cubes,
            threads=threads,
            methods=methods,
            precision=precision,
            device=device,
            repetitions=_REPETITIONS if repetitions is None else repetitions,
        )


_REPETITIONS = _sandglass.bench_repetitions


def _called(command, progress=None, **arguments):
    with shown(progress, command) as callback:
        return record_of(getattr(_sandglass, command)(arguments, callback))


@contextlib.contextmanager
def _files(*cases):
    """The names or paths of cases; bodies are saved in a folder that lives as long."""
    with tempfile.TemporaryDirectory() as folder:
        names = []
        for case in cases:
            if isinstance(case, Body):
                names.append(os.path.join(folder, f"{len(names)}.toml"))
                case.save(names[-1])
            elif isinstance(case, (str, os.PathLike)):
                names.append(path_text("case", case))
            else:
                raise TypeError(
                    "case must be an sg.Body, a path, or the name of a case, but is a "
                    f"{type(case).__name__}"
                )
        yield names


__all__ = [
    "Record",
    "axes",
    "bench",
    "cases",
    "choose",
    "estimate",
    "flops",
    "kernels",
    "methods",
    "score",
    "stability",
    "verify",
    "write_mesh",
]
