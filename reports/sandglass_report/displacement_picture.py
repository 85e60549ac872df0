"""The way of a displacement, from the case file to the page: the functions that `ci/verify` runs.

Every chain of calls is looked up in the sources before it is drawn.
"""

from dataclasses import dataclass
from pathlib import Path

from sandglass_report.calls import Function, require_chain
from common.errors import InputError
from sandglass_report.svg import MUTED, Drawing

ROOT = Path(__file__).resolve().parents[2]

WIDTH, TOP, ROW, BOX = 1000, 64, 100, 78
FILES, STEPS = 20, 330  # left edges of the two columns

VERIFY = Function("verify", "app/command_verify.cpp")
SCENES = Function("read_static_scenes", "app/workspace.cpp")
SUBJECTS = Function("read_subjects", VERIFY.file)
JUDGE = Function("judge", "suite/comparison/verdict.cpp")
RELAXED = Function("fill_relaxed", JUDGE.file)
STEP = Function("step", "solver/solve/equilibrium.cpp", "equilibrium_.step(")
PAGE = Function("make", "reports/make_report.py")


@dataclass(frozen=True)
class Step:
    """One box: what happens, in the last function of a chain; files that it reads and writes."""

    title: str
    chain: tuple  # Functions, from the caller on
    reads: tuple = ()
    writes: str = ""


CASE, GOLDEN = "cases/column.toml", "reference/golden/column.h5"
RESULT, VERDICTS = "build/verify/column.METHOD.h5", "build/verdicts.json"
HTML = "build/report/index.html"

WAY = (
    Step(
        "Read the case",
        (
            VERIFY,
            SUBJECTS,
            SCENES,
            Function("read_cases", "solver/io/case_file.cpp"),
            Function("read_case", "solver/io/case_file.cpp"),
        ),
        reads=(CASE,),
    ),
    Step(
        "Make the mesh and its node sets",
        (
            SCENES,
            Function("read_scene", "solver/io/case_file.cpp"),
            Function("make_scene", "solver/problem/model.cpp"),
        ),
    ),
    Step(
        "Compute each element's constants",
        (
            RELAXED,
            Function("Model", "solver/problem/model.cpp", "Model model("),
            Function("make_internal_force", "solver/assembly/internal_force.cpp"),
            Function("assemble", "solver/assembly/assemble.hpp", "method.assemble_packed_double("),
            Function("ElementAssembly", "solver/assembly/element_assembly.hpp", "<AssemblyOf<"),
            Function("element_block", "solver/assembly/element_block.hpp", "element_block<"),
        ),
    ),
    Step(
        "Step towards rest",
        (
            VERIFY,
            Function("run_all", VERIFY.file),
            JUDGE,
            RELAXED,
            Function("relax", "solver/solve/relaxation.cpp"),
            Function("run", "solver/solve/relaxation.cpp", "Search<Real>(model, *elements, obs"),
            Function("solve", "solver/solve/relaxation.cpp"),
            STEP,
        ),
    ),
    Step(
        "Sum the elements' forces",
        (
            STEP,
            Function("evaluate", "solver/solve/equilibrium.cpp"),
            Function("evaluate_forces", "solver/solve/body.cpp"),
            Function("evaluate", "solver/assembly/element_assembly.hpp", "elements_.evaluate("),
            Function("add_chunk", "solver/assembly/element_assembly.hpp"),
            Function("force", "solver/element/formulation.hpp", "Kernel::force("),
        ),
    ),
    Step(
        "Compare with the golden",
        (
            JUDGE,
            Function("accuracy_of", JUDGE.file),
            Function("accuracy", "suite/comparison/accuracy.cpp"),
        ),
        reads=(GOLDEN,),
    ),
    Step(
        "Write the verdicts",
        (VERIFY, Function("to_json", "suite/comparison/verdict_json.cpp")),
        writes=VERDICTS,
    ),
    Step(
        "Write the displacements",
        (
            VERIFY,
            Function("write_result", VERIFY.file),
            Function("frame", "solver/io/result_file.cpp", "writer.frame("),
        ),
        writes=RESULT,
    ),
    Step(
        "Make the page",
        (PAGE, Function("write_report", "reports/sandglass_report/page.py")),
        writes=HTML,
    ),
)

# What is drawn without a chain of its own: who makes the mesh, and who reads files.
BESIDE = (
    (
        Function("read_scene", "solver/io/case_file.cpp"),
        Function("generate_mesh", "solver/problem/model.cpp"),
    ),
    (
        SUBJECTS,
        Function("read_references", JUDGE.file),
        Function("read_if_present", JUDGE.file),
        Function("read_reference", "solver/io/reference_file.cpp"),
    ),
    (PAGE, Function("read_verdicts", "reports/sandglass_report/verdicts.py")),
    (PAGE, Function("read_subjects", "reports/sandglass_report/subject.py")),
)


def require_true(root=ROOT):
    """Raises InputError when a call or a file of the picture is not in the tree."""
    for chain in (*(step.chain for step in WAY), *BESIDE):
        require_chain(root, chain)
    for file in (CASE, GOLDEN):
        if not (root / file).exists():
            raise InputError(f"{file}: is not there")
    for script, places in (
        ("ci/verify", (VERDICTS, str(Path(RESULT).parent), "reports/make_report.py", HTML)),
        (PAGE.file, (VERDICTS, str(Path(RESULT).parent), HTML)),
    ):
        text = (root / script).read_text()
        for place in places:
            if place not in text:
                raise InputError(f"{script}: does not name {place}")


def displacement_picture(root=ROOT):
    """The picture as SVG text. Raises InputError when it would not be true."""
    require_true(root)
    drawing = Drawing(
        WIDTH,
        TOP + len(WAY) * ROW,
        "The way of a displacement, from the case file to the page",
        "; ".join(f"{step.title}: {_calls(step.chain)}" for step in WAY),
    )
    drawing.words(FILES, 38, "Files", 20, MUTED, bold=True)
    drawing.words(
        STEPS, 38, "Functions in the order of their work, and who calls them", 20, MUTED, bold=True
    )
    middle = STEPS + (WIDTH - 20 - STEPS) // 2
    for k, step in enumerate(WAY):
        y = TOP + k * ROW
        if k:
            drawing.line(middle, y - ROW + BOX, middle, y, arrow=True)
        drawing.box(STEPS, y, WIDTH - 20 - STEPS, BOX)
        last = step.chain[-1]
        drawing.words(STEPS + 16, y + 27, f"{k + 1}. {step.title}", 20, bold=True)
        drawing.words(STEPS + 16, y + 49, f"{last.name}()", 16, mono=True)
        drawing.words(WIDTH - 36, y + 49, last.file, 15, MUTED, anchor="end")
        drawing.words(STEPS + 16, y + 68, f"{_calls(step.chain[:-1])} >", 13, MUTED, mono=True)
        for file in (*step.reads, step.writes):
            if file:
                _draw_file(drawing, y, file, written=file == step.writes)
    _draw_return(drawing)
    return drawing.text()


def _calls(chain):
    return " > ".join(function.name for function in chain)


def _draw_file(drawing, y, file, written):
    """A file beside its step; the arrow tells who gives."""
    width = STEPS - 60 - FILES
    folder, _, name = file.rpartition("/")
    drawing.box(FILES, y + 8, width, BOX - 16, "#fdf6e3", dashed=True)
    drawing.words(FILES + 14, y + 33, name, 17, bold=True)
    drawing.words(FILES + 14, y + 55, folder + "/", 15, MUTED)
    ends = (FILES + width, STEPS)
    start, end = reversed(ends) if written else ends
    drawing.line(start, y + BOX // 2, end, y + BOX // 2, arrow=True)


def _draw_return(drawing):
    """The page is made of what the two steps before it wrote."""
    x, page = STEPS - 30, TOP + (len(WAY) - 1) * ROW + 20
    stubs = [TOP + k * ROW + BOX - 18 for k, step in enumerate(WAY) if step.writes][:-1]
    for y in stubs:
        drawing.line(x - 30, y, x, y)
    drawing.line(x, stubs[0], x, page)
    drawing.line(x, page, STEPS, page, arrow=True)
