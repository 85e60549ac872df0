"""Targets in Markdown texts exist: files, headings, functions, commands and their options."""

import re

import pytest
from command_line import ROOT, sandglass
from readme import inline, parts
from test_readmes import DOCUMENTS, PLACES

PRESENT = [name for name in DOCUMENTS if name != "CHANGELOG.md"]  # names former files too
SOURCE = r"(?:\.\./)*([\w./-]+(?:\.(?:[ch]pp|py|md|cff|toml|cmake)|/))"
LINK = re.compile(r"\]\(((?!\w+:)[^)#\s]*)(?:#([^)\s]+))?\)")
OTHERS = {"std", "snake_case", "SBATCH_CONSTRAINT"}  # names that are not the project's own
PLACED = re.compile(rf"`([A-Za-z]\w*(?:::\w+)*)(?:\(\))?`\s+in\s+`({SOURCE})`")


def anchors(text):
    """The anchors of the headings of a Markdown text, as GitHub and Sphinx make them."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {
        re.sub(r"[^\w -]", "", heading.lower()).strip().replace(" ", "-") for heading in headings
    }


def files_named(document, name):
    """The files that a name in a document may mean: from its folder, or the end of a path."""
    near = (ROOT / document).parent / name
    if near.exists():
        return [near]
    ending = "/" + re.sub(r"^(\.\./)*", "", name).rstrip("/")
    return [place for place in PLACES if str(place).endswith(ending)]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_links_lead_to_files_and_headings(document):
    for target, anchor in LINK.findall(DOCUMENTS[document]):
        file = ((ROOT / document).parent / target).resolve() if target else ROOT / document
        assert file.exists(), target
        if anchor and file.suffix == ".md":
            assert anchor in anchors(file.read_text()), f"{target}#{anchor}"


@pytest.mark.parametrize("document", PRESENT)
def test_files_that_texts_name_are_there(document):
    """Except for files that a step makes."""
    made = {part.path for part in parts(DOCUMENTS[document]) if part.kind == "file"}
    for name in inline(DOCUMENTS[document]):
        source = re.fullmatch(SOURCE, name)
        if source and name not in made and not name.startswith("build/"):
            assert files_named(document, name), name


def defines(text, name):
    """Whether a C++ or Python source declares or defines a name, not only uses it."""
    word = name.split("::")[-1]
    kinds = (
        rf"\b(?:class|struct|using|concept) {word}\b",
        r"^(?! *(?:return|else|throw)\b)[^\n=.(]*[\w>&*\]]\s[&*]?(?:\w+(?:<\w+>)?::)*"
        rf"{word} ?[(={{;]",
        rf"^(?:def {word}\b|{word} =)",
    )
    return re.search("|".join(kinds), text, re.MULTILINE) is not None


@pytest.mark.parametrize("document", PRESENT)
def test_functions_are_in_the_files_that_texts_name(document):
    """`function` in `file`."""
    for name, path, _ in PLACED.findall(DOCUMENTS[document]):
        files = [file for file in files_named(document, path) if file.is_file()]
        assert any(defines(file.read_text(), name) for file in files), f"`{name}` in `{path}`"


@pytest.fixture(scope="module")
def words_of_sources():
    """Every word of the sources."""
    endings = {".hpp", ".cpp", ".py", ".toml", ".cmake", ".txt", ".in", ".js", ".json", ".yaml"}
    files = [place for place in PLACES if place.is_file()]
    scripts = [file for file in files if file.suffix in endings or not file.suffix]
    texts = (file.read_text(errors="ignore") for file in scripts if file.stat().st_size < 1e6)
    return {word for text in texts for word in re.findall(r"\w+", text)}


@pytest.mark.parametrize("document", PRESENT)
def test_functions_that_texts_name_are_there(document, words_of_sources):
    """Names with an underscore, `::` or `()`, except for those that a step adds."""
    own = set(re.findall(r"\w+", "".join(part.text for part in parts(DOCUMENTS[document]))))
    for name in inline(DOCUMENTS[document]):
        if re.fullmatch(r"[A-Za-z]\w*(::\w+)*(\(\))?", name) and re.search(r"_|::|\(", name):
            assert set(re.findall(r"\w+", name)) <= words_of_sources | own | OTHERS, name


@pytest.fixture(scope="module")
def help_of():
    """Subcommand -> its help."""
    names = re.findall(r"^  (\w+)  ", sandglass("--help").stdout, re.MULTILINE)
    return {name: sandglass(name, "--help").stdout for name in names}


@pytest.mark.parametrize("document", PRESENT)
def test_commands_that_texts_name_are_there(document, help_of):
    """Scripts of ci/, and subcommands of the program with their options and canonical cases."""
    cases = {file.stem for file in (ROOT / "cases").glob("*.toml")}
    for code in inline(DOCUMENTS[document]):
        words = code.removeprefix("bash ").removeprefix("build/release/").split()
        if not words:
            continue
        if re.fullmatch(r"ci/[\w-]+", words[0]):
            assert (ROOT / words[0]).stat().st_mode & 0o100, code
        if words[0] != "sandglass" or len(words) == 1:
            continue
        assert words[1] in help_of, code
        for before, word in zip(words[1:], words[2:]):
            if word.startswith("-"):
                assert re.search(rf"(?<![\w-]){word}(?![\w-])", help_of[words[1]]), code
            elif not before.startswith("-") and re.fullmatch(r"[a-z]+(-[a-z]+)*", word):
                assert word in cases, code
