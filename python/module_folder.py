"""The folder of the module under test: $SANDGLASS_PYTHON_FOLDER, else build/release/python."""

import os

from common.program import ROOT

FOLDER = os.environ.get("SANDGLASS_PYTHON_FOLDER", str(ROOT / "build" / "release" / "python"))
