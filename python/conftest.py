"""What the tests of the module share lies in verification/."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "verification"))

import module_folder  # noqa: E402

sys.path.insert(0, module_folder.FOLDER)
