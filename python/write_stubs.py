"""Writes tables.pyi of the built package: python3 write_stubs.py FOLDER-OF-THE-MODULE."""

import pathlib
import runpy
import sys

folder = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(folder))
sys.dont_write_bytecode = True
tables = runpy.run_path(str(folder / "sandglass/tables.py"))
(folder / "sandglass/tables.pyi").write_text(tables["stub_text"]())
