"""Checks that includes between the solver's layers point one way only.

A layer may include itself and the layers before it. Exit code 1 names every include that points the
other way.
"""

import pathlib
import re
import sys

LAYERS = [
    "base",
    "math",
    "material",
    "element",
    "mesh",
    "model",
    "stepping",
    "io",
    "sandglass",
    "comparison",
    "stability",
    "benchmark",
    "choice",
    "app",
]


def includes(solver: pathlib.Path):
    """(file, line number, layer, included layer) of every include of a layer, in order."""
    for file in sorted(solver.rglob("*.[ch]pp")):
        layer = file.relative_to(solver).parts[0]
        for number, line in enumerate(file.read_text().splitlines(), start=1):
            match = re.match(r'#include "(\w+)/', line)
            if match:
                yield file, number, layer, match[1]


def wrong_includes(solver: pathlib.Path) -> list[str]:
    """Lines 'file:line: layer may not include layer' for every include that points to the right."""
    return [
        f"{file}:{number}: {layer} may not include {included}"
        for file, number, layer, included in includes(solver)
        if LAYERS.index(included) > LAYERS.index(layer)
    ]


if __name__ == "__main__":
    wrong = wrong_includes(pathlib.Path(__file__).parent.parent / "solver")
    print("\n".join(wrong) or "ci/layers: every include points left")
    sys.exit(1 if wrong else 0)
