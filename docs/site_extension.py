"""What the documentation needs beside Sphinx: paths become links, and tables come from files.

- A link to a file of the tree, or its path between backquotes, leads to the page that shows it,
  so that the same text works on a code host and here. `{include}` in a page makes it show a file.
- {printed} shows what a command of the program prints; {failures} and {machines} are tables made
  from stored measurements. None of this is typed by hand.
"""

import collections
import json
import os
import re
import shutil
import subprocess
import textwrap
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from sphinx import addnodes
from sphinx.transforms import SphinxTransform
from sphinx.util import logging

from common.errors import InputError
from common.program import ROOT, binary

DOCS = ROOT / "docs"
# Published by `ci/site` next to the documentation, and where.
PUBLISHED = {"build/report/index.html": "report/index.html"}
MATHJAX = Path("/usr/share/javascript/mathjax")  # Debian's libjs-mathjax
MATHJAX_PARTS = """
MathJax.js config/TeX-AMS_SVG.js extensions jax/element jax/output/SVG/config.js
jax/output/SVG/jax.js jax/output/SVG/autoload jax/output/SVG/fonts/TeX
""".split()
INCLUDE = re.compile(r"^```\{include\} (\S+)$", re.MULTILINE)
LOGGER = logging.getLogger(__name__)


def pages():
    """Path in the tree -> name of the page that shows it."""
    shown = {}
    for page in sorted(DOCS.rglob("*.md")):
        name = str(page.relative_to(DOCS).with_suffix(""))
        shown[str(page.relative_to(ROOT))] = name
        for included in INCLUDE.findall(page.read_text()):
            shown[os.path.relpath(page.parent / included, ROOT)] = name
    return shown


class PathsToPages(SphinxTransform):
    """Links to files of the tree, and their names between backquotes, lead to pages."""

    default_priority = 210

    def apply(self):
        """Changes the targets of links and wraps names of files that a page shows."""
        shown, here = pages(), self.env.docname
        own = [os.path.dirname(path) for path, page in shown.items() if page == here]
        for link in list(self.document.findall(addnodes.pending_xref)):
            if link.get("reftype") == "myst" and not link["reftarget"].startswith("#"):
                self.lead(link, shown, own)
        for code in list(self.document.findall(nodes.literal)):
            if isinstance(code.parent, (nodes.reference, nodes.title, nodes.inline)):
                continue
            text = code.astext()
            page = find(text, shown, own) if text.endswith(".md") else None
            if text in PUBLISHED:
                uri = "../" * here.count("/") + PUBLISHED[text]
                wrap(code, nodes.reference("", "", refuri=uri, internal=False))
            elif page and page != here:
                wrap(code, reference(page, here))

    def lead(self, link, shown, own):
        """Leads a link to the page that shows its target, or to a copy of a file of the tree."""
        path, _, anchor = link["reftarget"].partition("#")
        page = find(path, shown, own)
        if page:
            target = os.path.relpath(page + ".md", os.path.dirname(self.env.docname))
            link["reftarget"] = target + (f"#{anchor}" if anchor else "")
            return
        files = [ROOT / folder / path for folder in own if (ROOT / folder / path).is_file()]
        if files:
            target = os.path.relpath(files[0], (DOCS / self.env.docname).parent)
            copied = addnodes.download_reference(
                "", *link.children, refdoc=self.env.docname, reftarget=target, reftype="myst"
            )
            link.replace_self(copied)


def find(path, shown, folders):
    """The page that shows a path, taken from one of some folders, or by its end as in texts."""
    for folder in (*folders, ""):
        page = shown.get(os.path.normpath(os.path.join(folder, path)))
        if page:
            return page
    ends = {shown[name] for name in shown if name.endswith("/" + path)}
    return ends.pop() if len(ends) == 1 else None


def reference(page, here):
    """A link to a page, to be resolved when all are known."""
    target = os.path.relpath(page + ".md", os.path.dirname(here))
    link = addnodes.pending_xref(
        "", refdoc=here, reftarget=target, reftype="myst", refexplicit=True, refwarn=True
    )
    link["refdomain"] = None
    return link


def wrap(code, link):
    """Puts a link around a piece of code."""
    code.replace_self(link)
    inner = nodes.inline("", "", code) if isinstance(link, addnodes.pending_xref) else code
    link += inner


class Printed(Directive):
    """The output of a command of the program; the argument is the command's words."""

    required_arguments = 1
    final_argument_whitespace = True

    def run(self):
        """The output as a block; a note if there is no program."""
        words = self.arguments[0]
        try:
            program = binary()
        except InputError as error:
            LOGGER.info("%s", error)
            return [nodes.paragraph("", "This page was made without the program, which prints it.")]
        command = [program, *words.split()]
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
        if done.returncode:
            raise self.error(f"sandglass {words}: {done.stderr}")
        text = "\n".join(map(folded, done.stdout.splitlines()))
        return [nodes.literal_block("", text, language="none")]


def folded(line, width=102):
    """A line split into parts that fit on a page, later ones below the last column of the first."""
    column = max((gap.end() for gap in re.finditer(r" {2,}", line[:width])), default=0)
    return textwrap.fill(line, width, subsequent_indent=" " * column, break_on_hyphens=False)


class Table(Directive):
    """A table of Markdown texts generated from data: titles and rows, lists of texts."""

    def run(self):
        """The table."""
        titles, rows = self.content_of()
        lines = [titles, ["---"] * len(titles), *rows]
        text = [" | ".join(line) for line in lines]
        made = nodes.Element()
        self.state.nested_parse(StringList(text, ""), self.content_offset, made)
        return made.children


class Failures(Table):
    """The number and kinds of failures of each method on the stored maps."""

    def content_of(self):
        """A row for each method and a column for each case."""
        maps = [
            json.loads(file.read_text()) for file in sorted((ROOT / "reports/maps").glob("*.json"))
        ]
        rows = collections.defaultdict(dict)
        for case in maps:
            cells = [cell for part in case["maps"] for cell in part["cells"]]
            for method in dict.fromkeys(cell["method"] for cell in cells):
                rows[method][case["case"]] = summary_of([c for c in cells if c["method"] == method])
        names = [case["case"] for case in maps]
        titles = ["method", *(f"`{name}`" for name in names)]
        lines = [[f"`{method}`", *(row.get(n, "-") for n in names)] for method, row in rows.items()]
        return titles, lines


def summary_of(cells):
    """The number of good cells of a method, and the findings of the others."""
    asked = [cell for cell in cells if not cell["golden_failed"] and not cell["refused"]]
    kinds = collections.Counter(cell["finding"] for cell in asked)
    bad = [f"{count} {kind}" for kind, count in kinds.most_common() if kind != "good"]
    return f"{kinds['good']} of {len(asked)}" + (f" ({', '.join(bad)})" if bad else "")


class Machines(Table):
    """The machines of measurements, as named in the stored files."""

    def content_of(self):
        """A row for each kind of stored file."""
        return ["files", "machine", "program"], machines()


def machines():
    """(files, machine, build) of every stored measurement."""
    found = collections.defaultdict(set)
    for pattern in ("reports/figures/*.json", "reports/maps/*.json"):
        for file in sorted(ROOT.glob(pattern)):
            data = json.loads(file.read_text())
            if "processor" not in data:  # its figures are no times
                continue
            cores = f", {data['cores']} cores" if "cores" in data else ""
            found[pattern].add((data["processor"] + cores, built(data)))
    for file in sorted(ROOT.glob("results/*.json")):
        data = json.loads(file.read_text())
        if "machine" in data:
            found["results/*.json"].add((data["machine"], "as each entry says"))
    gate = json.loads((ROOT / "verification/gate/baseline.json").read_text())
    for machine in (gate["machine"], *gate["machines"]):
        processor, _, flags = machine.partition("; ")
        found["verification/gate/baseline.json"].add((processor, flags))
    return [(f"`{name}`", *row) for name, rows in found.items() for row in sorted(rows)]


def built(data):
    """The build of the program with which a file was measured."""
    if "build_flags" in data:
        return f"{data['compiler']}; {data['build_flags']}"
    return data.get("build") or f"version {data['versions']['sandglass']}"


def blocks_of_code(_app, _what, _name, _object, _options, lines):
    """Turns indented lines of a docstring into code for reStructuredText, as in Markdown."""
    for k in range(len(lines) - 1, 0, -1):
        opens = lines[k].startswith("    ") and not lines[k - 1].strip()
        if opens and not lines[k - 2].startswith("    "):
            lines[k:k] = [".. code-block:: python", ""]


def take_mathjax_along(app, error):
    """Copies the parts of MathJax that pages need, so that formulas work without a network."""
    if error or app.builder.format != "html":
        return
    target = Path(app.outdir) / "_static/mathjax"
    for part in MATHJAX_PARTS:
        (target / part).parent.mkdir(parents=True, exist_ok=True)
        if (MATHJAX / part).is_dir():
            shutil.copytree(MATHJAX / part, target / part, dirs_exist_ok=True)
        else:
            shutil.copy(MATHJAX / part, target / part)


def setup(app):
    """Called by Sphinx."""
    app.add_transform(PathsToPages)
    app.add_directive("printed", Printed)
    app.add_directive("failures", Failures)
    app.add_directive("machines", Machines)
    app.connect("autodoc-process-docstring", blocks_of_code)
    app.connect("build-finished", take_mathjax_along)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
