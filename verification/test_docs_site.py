"""The documentation builds without warnings and answers a newcomer's questions."""

import importlib.util
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from command_line import BINARY, ran
from readme import commands, copy

from common.program import ROOT

# Published by `ci/site` next to the documentation.
PUBLISHED = "report/index.html"
NEEDED = ("sphinx", "myst_parser", "breathe", "furo")
PUBLIC = ("solver/sandglass/simulation.hpp", "solver/sandglass/batch.hpp", "solver/base/error.hpp")
# A newcomer's questions, and a text on the page that answers.
ANSWERS = {
    "How do I install it?": "makes a Debian package and a wheel",
    "How do I apply pressure?": 'set = "loaded" value = 300.0',
    "Which kappa?": "Leave it at auto",
    "How do I cite it?": "CITATION.cff",
    "Is there a BibTeX entry?": "@software{sandglass,",
    "Can it read tetrahedra, or an STL surface?": "nothing here fills a surface with elements",
    "Was it compared with experiments?": "With one: a cantilever of silicone",
    "My liver at .49 in real time: which element, how many?": "elements times the cost of one",
    "What force does a haptic device get?": "is the force (N) that holds or drives a set of nodes",
    "How do I test my own solver with it?": "score FILE --case CASE --limit max=2%",
    "How do I use my own mesh?": "Physical groups, NSETs and ELSETs become node sets",
    "Is my answer accurate?": "estimates the distance of an answer from the exact one",
    "How do I make a body of several materials?": '[[materials]] elements = "core"',
    "How do I model tissue that relaxes?": 'law = "viscoelastic-neo-hookean"',
    "How long is a time step?": "A step is 0.9 of the longest step that is guaranteed to be stable",
    "How do I use it from Python?": "PYTHONPATH=build/release/python",
    "How do I add a law?": "solver/material/demiray.hpp",
    "Why does my mesh fold?": "Zigzags from node to node are hourglass modes",
    "What are the units?": "SI: m, s, kg, N, Pa",
    "Can it run on many machines?": "mpirun -n 2 build/mpi/sandglass run column",
    "Does it do contact?": "with friction, in static equilibrium and in motion",
}


class Page(HTMLParser):
    """The anchors and links of a page, its text without scripts, and its blocks of code."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.text, self.code, self.inside = set(), [], "", "", ""
        self.feed(path.read_text())
        self.text, self.code = (" ".join(text.split()) for text in (self.text, self.code))

    def handle_starttag(self, tag, attributes):
        """Keeps the id and the link of a tag."""
        named = dict(attributes)
        self.anchors |= {named[key] for key in ("id", "name") if named.get(key)}
        self.links += [named[key] for key in ("href", "src") if named.get(key)]
        if tag in ("script", "style", "pre"):
            self.inside = tag

    def handle_endtag(self, tag):
        """Leaves a script or a block of code."""
        self.inside = "" if tag == self.inside else self.inside

    def handle_data(self, data):
        """Keeps text."""
        self.text += "" if self.inside in ("script", "style") else data
        self.code += data if self.inside == "pre" else ""


def target(page, link):
    """(path in the folder, anchor) of a link on a page; none for links to other sites."""
    parts = urlsplit(link)
    if parts.scheme or parts.netloc:
        return None
    path = unquote(parts.path)
    place = page if not path else str((Path("/") / page).parent.joinpath(path).resolve())[1:]
    return place, unquote(parts.fragment)


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    """A copy of the project with its documentation, built by `ci/docs-site` with the program."""
    absent = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if absent or not shutil.which("doxygen"):
        pytest.skip("needs Sphinx and Doxygen: bash ci/setup docs")
    tree = Path(copy(tmp_path_factory.mktemp("docs") / "sandglass"))
    (tree / "build").mkdir()
    (tree / "build/release").symlink_to(Path(BINARY).resolve().parent)
    done = docs_site(tree)
    assert done.returncode == 0, done.stdout + done.stderr
    return tree


@pytest.fixture(scope="module")
def pages(tree):
    """Path -> Page of the documentation."""
    folder = tree / "build/docs"
    return {str(path.relative_to(folder)): Page(path) for path in folder.rglob("*.html")}


def docs_site(tree, *words):
    """Runs ci/docs-site."""
    command = ["bash", str(tree / "ci/docs-site"), *words]
    return ran(*command)


def clicks(pages):
    """Page -> number of clicks from the first page."""
    away, last = {"index.html": 0}, ["index.html"]
    while last:
        found = [target(name, link) for name in last for link in pages[name].links]
        new = {one[0] for one in found if one and one[0] in pages} - set(away)
        away |= {name: away[last[0]] + 1 for name in new}
        last = sorted(new)
    return away


@pytest.mark.parametrize("question", ANSWERS)
def test_a_question_is_answered_in_two_clicks(pages, question):
    away = clicks(pages)
    answering = [name for name, page in pages.items() if ANSWERS[question] in page.text]
    assert answering and min(away[name] for name in answering) <= 2, answering


def test_every_page_is_there_and_no_link_leads_nowhere(tree, pages):
    for name, page in pages.items():
        for place, anchor in filter(None, (target(name, link) for link in page.links)):
            assert place == PUBLISHED or (tree / "build/docs" / place).is_file(), (name, place)
            if anchor and place in pages:
                assert anchor in pages[place].anchors, (name, place, anchor)
    made = {name for name in clicks(pages) if name not in ("genindex.html", "search.html")}
    sources = {str(path.relative_to(tree / "docs")) for path in (tree / "docs").rglob("*.md")}
    assert {re.sub(r"\.md$", ".html", name) for name in sources} <= made
    assert {path.name for path in (tree / "build").iterdir()} == {"docs", "release"}  # nothing else


def test_commands_of_the_readmes_are_shown_as_code(tree, pages):
    code = " ".join(page.code for page in pages.values()).replace("\\ ", "")
    texts = [text.read_text() for text in tree.rglob("*.md")]
    found = [" ".join(command.split()) for text in texts for command in commands(text)]
    assert found and [command for command in found if command not in code] == []


def test_pages_show_what_the_program_prints_and_the_module_says(pages):
    assert "material.poisson_ratio" in pages["keys.html"].text
    assert "ellipsoid-indentation" in pages["cases.html"].text
    if importlib.util.find_spec("pybind11"):
        text = pages["api/python.html"].text
        assert "step_fraction" in text and "an independent copy" in text.lower()


def test_declarations_of_public_headers_are_described(pages):
    text = pages["api/cpp.html"].text
    for header in PUBLIC:
        code = (ROOT / header).read_text()
        public = re.sub(r"^ private:.*?^\};", "", code, flags=re.MULTILINE | re.DOTALL)
        names = re.findall(r"^(?:class|struct|enum class) (\w+)[^;]*\{", public, re.MULTILINE)
        names += re.findall(
            r"^  [^/(]*?\b(\w+)\(.*\) ?(?:const)?(?: noexcept)?;", public, re.MULTILINE
        )
        assert names
        assert [name for name in names if not re.search(rf"\b{name}\b", text)] == [], header


@pytest.mark.parametrize(
    "path, old, new, rule",
    [
        ("docs/questions.md", "methods.md#which-kappa", "methods.md#kappa", "reference target not"),
        ("docs/glossary.md", "# Glossary", "# Glossary\n\n```{nothing}\n```", "Unknown directive"),
        ("solver/sandglass/batch.hpp", "  ///< s, the longest", "  // s, the longest", "step_size"),
    ],
)
def test_a_fault_is_reported_and_leaves_the_last_documentation(tree, path, old, new, rule):
    text = (tree / path).read_text()
    assert old in text
    (tree / path).write_text(text.replace(old, new))
    done = docs_site(tree)
    (tree / path).write_text(text)
    assert done.returncode == 1 and rule in done.stderr and Path(path).name in done.stderr
    assert (tree / "build/docs/index.html").is_file()
    assert not (tree / "build/docs.new").exists()


def test_unknown_arguments_of_ci_docs_site_are_refused(tree):
    done = docs_site(tree, "--link")
    assert done.returncode == 2 and "allowed: nothing, or --links" in done.stderr
