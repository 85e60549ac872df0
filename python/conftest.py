"""Makes the module under test importable."""

import sys

import module_folder

sys.path.insert(0, module_folder.FOLDER)
