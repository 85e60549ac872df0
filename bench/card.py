"""Steps of tl-perturbation on an NVIDIA card, with the kernels that `sandglass kernels` writes.

Usage: /usr/bin/python3 bench/card.py FOLDER --write          kernels and the answer of the program
       python3 bench/card.py FOLDER [--json FILE] [--elements N ...] [--precision P ...]
       python3 bench/card.py FOLDER --compile sm_90           compiles only, which needs no card
The first needs the program and h5py; the others need Python, FOLDER, a card's driver, and NVRTC or
nvcc. A box of cubes, clamped at its foot, is thrown. Displacements and the reaction of a small one
are compared with the program's first. Then boxes of about N cubes are timed: printed are ns per
element and step, and the share of the bandwidth that the card reaches for a = b + s c, from the
bytes that a step moves at least, each array counted once.
Exit codes: 0 done, 1 another answer than the program's, 2 bad usage or input, or no card, 3 an
error of the card or a compiler.
"""

import array
import ctypes
import json
import math
import statistics
import sys
from pathlib import Path

if __package__ in (None, ""):
    sys.path.insert(1, str(Path(__file__).resolve().parent.parent))

from card_box import DENSITY, EDGE, FORCE, REALS, SET_UP, STEP, VELOCITY, Box
from common.command import command_line, option, whole_number, writable
from common.errors import InputError
from cuda import Card, compiled

SMALL, STEPS, RATIO = 13, 200, 0.49  # cubes along an edge
CASE = f"""[case]
name = "card"
requirement = "A clamped box of cubes is thrown."
answer = "dynamic"
[mesh]
generator = "box"
size = [{SMALL * EDGE}, {SMALL * EDGE}, {SMALL * EDGE}]
elements = [{SMALL}, {SMALL}, {SMALL}]
[material]
law = "neo-hookean"
young_modulus = 3000.0
poisson_ratio = {RATIO}
density = {DENSITY}
[sets]
foot = {{ z = [0.0, 0.0] }}
[[displacement]]
set = "foot"
value = [0.0, 0.0, 0.0]
[[velocity]]
value = [{", ".join(map(str, VELOCITY))}]
[dynamics]
duration = {STEP * STEPS}
time_step = {STEP}
frames = 1
"""
METHOD = "tl-perturbation"
ROUNDOFF = {"float": 2.0**-24, "double": 2.0**-53}
AT_ONCE, REPETITIONS = 20, 30  # steps of a graph, and graphs that are timed one by one

KERNELS = [FORCE, "move_nodes", "set_up_elements", "set_up_nodes", "triad"]


def text_of(folder, precision):
    """The kernels of a precision, and those that set up a box."""
    try:
        text = Path(folder, f"{precision}.cu").read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{folder}: {error.strerror}; `bench/card.py {folder} --write` makes it")
    return text + SET_UP.replace("REAL", precision)


def constants_in(folder, precision):
    """The constants of a cube: those of the first of the small box."""
    numbers = array.array(REALS[precision][0])
    numbers.frombytes(Path(folder, f"{precision}.constants").read_bytes())
    return numbers[:: SMALL**3]


def difference(folder, precision, u, reactions):
    """How far displacements and forces of constraints of the small box are from the program's.

    Those of all nodes and the reaction of the foot, both over the largest, and over what two
    motions may differ by: see motion_rounding.hpp; a reaction has some ten times the error.
    """
    expected = json.loads(Path(folder, f"{precision}.json").read_text(encoding="utf-8"))
    reaction = [sum(reactions[i::3]) for i in range(3)]
    bound = 8 * ROUNDOFF[precision] * (2 * RATIO / (1 - 2 * RATIO) + 1) * math.sqrt(STEPS)
    largest = max(map(abs, expected["u"]))
    of_u = max(abs(a - b) for a, b in zip(u, expected["u"])) / largest
    of_reaction = math.dist(reaction, expected["reaction"]) / math.hypot(*expected["reaction"])
    found = max(of_u, of_reaction / 10) / bound
    return found if math.isfinite(sum(u) + sum(reaction)) else math.inf


def answer(card, functions, precision, one):
    """Displacements and forces of constraints of the small box at the end of its motion."""
    box = Box(card, functions, precision, SMALL, one)
    box.start()
    box.steps(STEPS - 1)
    box.end()
    found = box.displacements(), box.values("reaction")
    box.release()
    return found


def timed(card, functions, precision, n, one, repetitions=REPETITIONS):
    """The seconds per step of a box, of many batches."""
    box = Box(card, functions, precision, n, one)
    box.start()
    batch = card.recorded(lambda: box.steps(AT_ONCE))
    batch()
    times = [card.seconds(batch) / AT_ONCE for _ in range(repetitions)]
    healthy = all(map(math.isfinite, box.values("u")))
    moved, elements = box.bytes_of_step(), box.elements
    box.release()
    return {
        "precision": precision,
        "elements": elements,
        "status": "ok" if healthy else "wrong result: displacements are not finite",
        "seconds_per_step": times,
        "ns_per_element_step": 1e9 * statistics.median(times) / elements,
        "bytes_per_element_step": moved / elements,
        "gbs": 1e-9 * moved / statistics.median(times),
    }


def triad_gbs(card, functions, precision, count=2**27):
    """The bandwidth of a = b + s c over arrays of so many numbers or as many as fit, GB/s."""
    real = ctypes.sizeof(REALS[precision][1])
    count = min(count, card.free_bytes() // (4 * real))
    size = count * real
    arrays = [card.zeros(size) for _ in range(3)]

    def queue():
        card.launch(functions["triad"], count, ctypes.c_longlong(count), *arrays)

    queue()
    seconds = min(card.seconds(queue) for _ in range(10))
    for each in arrays:
        card.release(each)
    return 3e-9 * size / seconds


def write(folder):
    """Writes kernels, constants and the program's answer."""
    import h5py
    from common.program import binary, output_of

    folder.mkdir(exist_ok=True)
    case = folder / "card.toml"
    case.write_text(CASE, encoding="utf-8")
    for precision in REALS:
        chosen = "--precision", precision
        texts = ["--dialect", "cuda", "--step", *chosen, "-o", folder / f"{precision}.cu"]
        texts += ["--constants", folder / f"{precision}.constants"]
        output_of(binary(), "kernels", METHOD, case, *texts)
        answer = folder / f"{precision}.h5"
        output_of(binary(), "run", case, "--method", METHOD, *chosen, "-o", answer)
        with h5py.File(answer, "r") as file:
            points, frame = file["mesh/points"][()], file["frames/0001"]
            order = [tuple(round(x / EDGE) for x in reversed(point)) for point in points]
            rows = frame["displacement"][()]
            u = [float(x) for _, row in sorted(zip(order, rows.tolist())) for x in row]
            found = {"u": u, "reaction": frame["reaction/foot"][()].tolist()}
        (folder / f"{precision}.json").write_text(json.dumps(found), encoding="utf-8")


def measure(card, options):
    """Compares, then times. Returns the exit code."""
    document = {"card": card.name, "driver": card.driver, "architecture": card.architecture}
    document |= {"method": METHOD, "steps_at_once": AT_ONCE, "triad_gbs": {}, "records": []}
    print(f"{card.name}, {card.architecture}, driver for CUDA {card.driver}", flush=True)
    for precision in options.precision:
        text = text_of(options.folder, precision)
        document["kernels"] = text.splitlines()[1].removeprefix("// ")
        functions = card.functions(text, KERNELS)
        one = constants_in(options.folder, precision)
        found = answer(card, functions, precision, one)
        apart = difference(options.folder, precision, *found)
        print(
            f"{precision}: {apart:.2g} of what rounding may differ by from the program", flush=True
        )
        document.setdefault("difference", {})[precision] = apart
        if not apart <= 1.0:
            print("wrong result: nothing is timed", flush=True)
            continue
        triad = document["triad_gbs"][precision] = triad_gbs(card, functions, precision)
        print(f"{'elements':>10} {'ns/el/step':>11} {'bytes':>6} {'GB/s':>6} {'of triad, %':>11}")
        for elements in options.elements:
            try:
                row = timed(card, functions, precision, max(1, round(elements ** (1 / 3))), one)
            except InputError as error:
                print(f"{elements:>10}  left out: {error}", flush=True)
                continue
            document["records"].append(row | {"share_of_triad": row["gbs"] / triad})
            print(
                f"{row['elements']:>10} {row['ns_per_element_step']:>11.3f} "
                f"{row['bytes_per_element_step']:>6.0f} {row['gbs']:>6.0f} "
                f"{100 * row['gbs'] / triad:>11.0f}  {row['status']}",
                flush=True,
            )
    if options.json:
        options.json.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    wrong = any(not apart <= 1.0 for apart in document["difference"].values())
    return int(wrong or any(row["status"] != "ok" for row in document["records"]))


def run(options):
    """Writes, compiles or measures. Returns the exit code."""
    if options.write:
        return write(options.folder)
    if options.compile:
        for precision in options.precision:
            code = compiled(text_of(options.folder, precision), options.compile)
            print(f"{precision}: {len(code)} bytes for {options.compile}")
        return 0
    return measure(Card(), options)


SIZES = [2_000, 10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000]
main = command_line(
    run,
    __doc__,
    option("folder", type=Path, metavar="FOLDER", help="of kernels and answers"),
    option("--write", action="store_true", help="make the folder"),
    option("--compile", metavar="ARCHITECTURE", help="only compile, for example for sm_90"),
    option("--elements", type=whole_number(1), nargs="+", default=SIZES, metavar="N", help="about"),
    option("--precision", choices=REALS, nargs="+", default=list(REALS), help="default: both"),
    option("--json", type=writable, metavar="FILE", help="write every time to this file"),
)

if __name__ == "__main__":
    sys.exit(main())
