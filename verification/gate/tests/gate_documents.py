"""Documents as written by the solver's commands, and a folder with which to run the gate."""

import copy
import json
import xml.etree.ElementTree as ElementTree

from gate import __main__ as command
from gate.bench import PACEMAKERS

ORIGIN = {
    "revision": "0123456789ab",
    "processor": "Abacus 3",
    "compiler": "GNU 12.2.0",
    "build_flags": "Release",
}
METHODS = (*PACEMAKERS, "ul-enhanced")
PROCESSES = 12


def verdict(case="column", method="tl-full", **changed):
    """A record of `sandglass verify`."""
    figures = {
        "max_relative_error": 0.01,
        "profile_relative_error": None,
        "rms_relative_error": 2e-3,
    }
    record = {"case": case, "method": method, "kappa": None, "kappa_is_auto": False}
    record |= {"precision": "double", "status": "ok", "golden": figures, "truth": None}
    return copy.deepcopy(record | changed)


def published():
    """A record of a case with a published value."""
    tip = {"set": "tip", "component": "z", "ratio": 0.98}
    return verdict("cook-2", golden=None, values=[tip, tip | {"component": "x", "ratio": None}])


def operations(**changed):
    """A record of `sandglass flops`."""
    counts = {"add": 250, "mul": 179, "div": 0, "special": 1, "total": 430, "bytes": 264}
    names = {"method": "tl-none", "law": "neo-hookean", "form": "kernel", "part": "element"}
    return names | counts | changed


def process(number, slower=None, share=0.0, **changed):
    """A document of `sandglass bench`: times scatter by 0.2 %, differently for each variant."""
    records = []
    for place, method in enumerate(METHODS):
        for kernel, precision in (("pack", "double"), ("pack", "float"), ("scalar", "double")):
            scatter = 1.0 + 0.002 * ((7 * number + 5 * place) % 11 / 5.0 - 1.0)
            time = (20.0 + place) * (4.0 if kernel == "scalar" else 1.0) * scatter
            records.append(
                {
                    "case": "box",
                    "elements": 576,
                    "method": method,
                    "kernel": kernel,
                    "precision": precision,
                    "threads": 1,
                    "status": "ok",
                    "ns_best": time * (1.0 + share * (method == slower or slower == "all")),
                    "bytes_per_element_step": 614.4,
                }
            )
    return (
        ORIGIN
        | {"peak_gflops": {"double": {"1": 50.0}, "float": {"1": 100.0}}}
        | changed
        | {"records": records}
    )


class Folder:
    """Input files for the gate; `call` returns exit code and output."""

    def __init__(self, path, capsys):
        self.path, self.capsys = path, capsys
        self.verdicts = ORIGIN | {"records": [verdict()], "published": [published()]}
        self.flops = {"records": [operations()]}
        self.bits = {"records": [{"name": "column, tl-full", "differs": ""}]}
        self.bench = [process(number) for number in range(PROCESSES)]

    def move_to(self, processor):
        """All later figures are from another processor."""
        for document in (self.verdicts, *self.bench):
            document["processor"] = processor

    def write(self, name, document):
        file = self.path / name
        file.write_text(json.dumps(document))
        return str(file)

    def call(self, *more, sources=()):
        files = [self.write(f"b{n}.json", document) for n, document in enumerate(self.bench)]
        code = command.main(
            [
                *sources,
                *("--baseline", str(self.path / "baseline.json"), "-o", str(self.path / "out")),
                *("--verdicts", self.write("v.json", self.verdicts)),
                *("--flops", self.write("f.json", self.flops)),
                *("--bits", self.write("bits.json", self.bits)),
                *("--bench", *files),
                *more,
            ]
        )
        printed = self.capsys.readouterr()
        return code, printed.out + printed.err

    def accept(self, reason="a test", **options):
        code, text = self.call("--accept", "--reason", reason, **options)
        assert code == 0, text
        return text

    def baseline(self):
        return json.loads((self.path / "baseline.json").read_text())

    def junit(self):
        return ElementTree.parse(self.path / "out" / "gate.xml").getroot()
