"""The folder of the module under test: $SANDGLASS_PYTHON_FOLDER, else build/release/python.

And the code of its README.
"""

import os
import re

from common.program import ROOT

FOLDER = os.environ.get("SANDGLASS_PYTHON_FOLDER", str(ROOT / "build" / "release" / "python"))


def readme_code(title):
    """The Python code of a section of the README."""
    text = (ROOT / "python/README.md").read_text()
    return re.search(rf"^#+ {title}\n.*?```python\n(.*?)```", text, re.DOTALL | re.MULTILINE)[1]
