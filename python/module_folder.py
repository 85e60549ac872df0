"""Where the module under test stands: $SANDGLASS_PYTHON_FOLDER, else build/release/python."""

import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = os.environ.get("SANDGLASS_PYTHON_FOLDER", str(ROOT / "build" / "release" / "python"))
