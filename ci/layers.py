"""Checks that includes point one way only.

The program sees the suite, the suite the library, and in each a layer itself and the layers before
it. Exit code 1 names every include that points the other way.
"""

import pathlib
import re
import sys

TARGETS = {
    "solver": "base math material mesh forces element written assembly device multigrid problem io"
    " solve sandglass",
    "suite": "counting comparison benchmark choice stability commands",
    "app": "app",
}
TARGETS = {target: layers.split() for target, layers in TARGETS.items()}
LAYERS = [layer for layers in TARGETS.values() for layer in layers]


def includes(root: pathlib.Path):
    """(file, line number, layer, included layer) of every include of a layer, in order."""
    for target in TARGETS:
        for file in sorted((root / target).rglob("*.[ch]pp")):
            layer = file.relative_to(root if target == "app" else root / target).parts[0]
            for number, line in enumerate(file.read_text().splitlines(), start=1):
                match = re.match(r'#include "(\w+)/', line)
                if match:
                    yield file, number, layer, match[1]


def wrong_includes(root: pathlib.Path) -> list[str]:
    """Lines 'file:line: layer may not include layer' for every include that points to the right."""
    return [
        f"{file}:{number}: {layer} may not include {included}"
        for file, number, layer, included in includes(root)
        if LAYERS.index(included) > LAYERS.index(layer)
    ]


if __name__ == "__main__":
    wrong = wrong_includes(pathlib.Path(__file__).parent.parent)
    print("\n".join(wrong) or "ci/layers: every include points left")
    sys.exit(1 if wrong else 0)
