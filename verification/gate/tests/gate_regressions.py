"""Regressions: changes to the documents of a folder, and the gate's expected answer to each."""

from gate.compare import BROKEN, VANISHED, WORSE
from gate_documents import PROCESSES, process


def change_error(folder):
    folder.verdicts["records"][0]["golden"]["max_relative_error"] = 0.0101


def change_tip(folder):
    folder.verdicts["published"][0]["values"][0]["ratio"] = 0.9798


def change_overshoot(folder):
    folder.verdicts["published"][0]["values"][0]["ratio"] = 1.0202


def fail_to_rest(folder):
    folder.verdicts["records"][0] |= {"status": "failed: not at rest", "golden": None}


def lose_a_case(folder):
    folder.verdicts["records"][0]["case"] = "pillar"


def lose_a_figure(folder):
    folder.verdicts["records"][0]["golden"]["rms_relative_error"] = None


def add_a_multiplication(folder):
    folder.flops["records"][0]["mul"] += 1


def trade_operations(folder):
    folder.flops["records"][0] |= {"mul": 180, "add": 249}


def differ_by_a_bit(folder):
    folder.bits["records"][0]["differs"] = "/frames/0001/displacement differs"


def slow_a_method(folder):
    folder.bench = [process(n, "tl-enhanced", 0.03) for n in range(PROCESSES)]


def slow_a_pacemaker_only_in_tl(folder):
    folder.bench = [process(n, "tl-perturbation", 0.03) for n in range(PROCESSES)]


def slow_everything(folder):
    folder.bench = [process(n, "all", 0.03) for n in range(PROCESSES)]


def move_a_byte(folder):
    for document in folder.bench:
        document["records"][0]["bytes_per_element_step"] += 0.1


def compute_wrong_forces(folder):
    for document in folder.bench:
        document["records"][0] |= {"status": "wrong result: ...", "ns_best": None}


def forget_a_method(folder):
    for document in folder.bench:
        document["records"] = [r for r in document["records"] if r["method"] != "ul-enhanced"]


REGRESSIONS = {
    change_error: ("accuracy", "column, tl-full, double", "golden max", WORSE),
    change_tip: ("accuracy", "cook-2, tl-full, double", "published tip z", WORSE),
    change_overshoot: ("accuracy", "cook-2, tl-full, double", "published tip z", WORSE),
    fail_to_rest: ("accuracy", "column, tl-full, double", "status", WORSE),
    lose_a_case: ("accuracy", "column, tl-full, double", "golden max", VANISHED),
    lose_a_figure: ("accuracy", "column, tl-full, double", "golden rms", VANISHED),
    add_a_multiplication: ("operations", "tl-none, neo-hookean, kernel, element", "mul", WORSE),
    trade_operations: ("operations", "tl-none, neo-hookean, kernel, element", "mul", WORSE),
    differ_by_a_bit: ("bits", "column, tl-full", "differs", BROKEN),
    slow_a_method: ("speed", "box of 576, tl-enhanced, pack double, 1 thread", "over pace", WORSE),
    slow_a_pacemaker_only_in_tl: (
        *("speed", "box of 576, tl-perturbation, pack double, 1 thread", "over pace", WORSE),
    ),
    slow_everything: (
        *("speed", "box of 576, pace, pack double, 1 thread", "ns at peak flops", WORSE),
    ),
    move_a_byte: ("memory", "box of 576, linear, pack double, 1 thread", "bytes", WORSE),
    compute_wrong_forces: (
        "forces",
        "box of 576, linear, pack double, 1 thread",
        "differs",
        BROKEN,
    ),
    forget_a_method: (
        *("speed", "box of 576, ul-enhanced, pack double, 1 thread", "over tl-enhanced", VANISHED),
    ),
}
