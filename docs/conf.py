"""How Sphinx builds the documentation; `ci/docs-site` calls it.

SANDGLASS_DOXYGEN names the folder with Doxygen's XML of the public headers.
"""

import importlib.util
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "docs"), str(ROOT / "python")]

import module_folder  # noqa: E402

sys.path.insert(0, module_folder.FOLDER)

project = "Sandglass"
author = "the Sandglass authors"
copyright = "the Sandglass authors; BSD-3-Clause"
release = re.search(r"^version: (.*)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)[1]

extensions = [
    "myst_parser",
    "breathe",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "site_extension",
]
exclude_patterns = ["**/__pycache__"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_url_schemes = ("http", "https", "mailto")
highlight_language = "sh"  # of text that is indented by four: commands

breathe_projects = {"sandglass": os.environ.get("SANDGLASS_DOXYGEN", str(ROOT / "build/doxygen"))}
breathe_default_project = "sandglass"
autodoc_member_order = "bysource"
default_role = "code"  # docstrings have their code between single backquotes

# Every name must resolve, except those of other libraries and of template parameters.
nitpick_ignore_regex = [
    (r"cpp:.*", r"(sandglass|std|std::.*|size_t|Real|Parts)"),
    (r"py:.*", r"(os\.PathLike|object|numpy.*|handle|int\d+|float\d+|_sandglass\..*)"),
]

html_theme = "furo"
html_title = "Sandglass"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
# Formulas need no network: site_extension.py adds Debian's copy of MathJax.
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"
mathjax2_config = {
    "showMathMenu": False,
    "messageStyle": "none",
    "tex2jax": {"ignoreClass": "mathjax_ignore", "processClass": "math"},
}
linkcheck_timeout = 20
linkcheck_ignore = [r"(\.\./)*report/index\.html"]  # put there by `ci/site`


def setup(app):
    """Without the module, replaces the page of the Python interface by a note."""

    def without_module(_app, name, source):
        if name == "api/python" and importlib.util.find_spec("sandglass") is None:
            block = re.compile(r"```\{eval-rst\}.*?```", re.DOTALL)
            note = "This page was made without the module: `bash ci/build release` builds it."
            source[0] = block.sub(note, source[0])

    app.connect("source-read", without_module)
