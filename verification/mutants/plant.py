"""Plants mistakes at random in the C++ lines that a change adds."""

import difflib
import fnmatch
import random
import re
import subprocess
from dataclasses import dataclass

from common.errors import InputError

FOLDERS = ("solver", "suite", "app")
# With spaces around, as clang-format writes binary operators and nothing similar.
OPERATOR = re.compile(r"(?<= )(?:[-+*/]=?|[<>=!]=|[<>]|&&|\|\|)(?= |$)")
OTHER = {"+": "-", "*": "/", "<": "<=", ">": ">=", "==": "!=", "&&": "||", "+=": "-=", "*=": "/="}
OTHER |= {there: here for here, there in OTHER.items()}
NUMBER = re.compile(r"(?<![\w.'])\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.'])")
INDEX = re.compile(r"(?<=\[)[a-z]\w*(?=\])")
TWO_INDICES = re.compile(r"\[([^][]+)\]\[([^][]+)\]")
ARGUMENTS = re.compile(r"(?<=[({ ])(?<![^({,] )([\w.\[\]]+), ([\w.\[\]]+)(?=[,)}])")
VALUE = re.compile(r"(?:(?<=\breturn )|(?<= [-+*/]= )|(?<= = ))(?!-)[^=;{}]+(?=;$)")
MINUS = re.compile(r"(?:(?<=[(\[{])|(?<=[,=] )|(?<=return ))-(?=[\w(])")
NO_CODE = re.compile(r"\s*(#|//|static_assert|template|using|namespace|case |enum|class|struct)")
STATEMENT = re.compile(r"(\s*)(?!return|break|continue|using|}|//)\S.*;$")
NAME = re.compile(r"[A-Za-z_]\w*")
ASSIGNMENT = re.compile(r" [-+*/]?= ")
DECLARED = re.compile(r"\s*[\w:<>, ]+[&*]* (\w+)")


@dataclass(frozen=True)
class Mistake:
    """Lines of a file, from number `line` on, before and after a mistake of some kind."""

    file: str
    line: int
    kind: str
    before: tuple
    after: tuple

    def patch(self, text):
        """As a patch of the file's text, with a head like the patches of this folder."""
        lines = text.splitlines(keepends=True)
        changed = lines[: self.line - 1] + [line + "\n" for line in self.after]
        changed += lines[self.line - 1 + len(self.before) :]
        names = f"a/{self.file}", f"b/{self.file}"
        head = f"{self.file}:{self.line}: another {self.kind}.\n\n"
        return head + "".join(difflib.unified_diff(lines, changed, *names))


def mistakes_of(line):
    """(kind, changed line) of every possible mistake in a line of C++, each once."""
    if NO_CODE.match(line):
        return []
    code = re.sub(r'"(?:\\.|[^"\\])*"|//.*|\'[^\']\'', lambda text: "~" * len(text[0]), line)

    def changed(pattern, *makers):
        for found in pattern.finditer(code):
            original = pattern.match(line, found.start())  # including strings
            if not original or original.end() != found.end():
                continue
            for make in makers:
                if (text := make(original)) is not None:
                    yield line[: found.start()] + text + line[found.end() :]

    kinds = {
        "operator": changed(OPERATOR, lambda m: OTHER.get(m[0])),
        "number": changed(
            NUMBER,
            lambda m: repr(2 * _number(m[0])),
            lambda m: repr(_number(m[0]) + 1),
            lambda m: f"-{m[0]}" if _number(m[0]) else None,
        ),
        "index": changed(INDEX, lambda m: "0"),
        "sign": (*changed(VALUE, lambda m: f"-({m[0]})"), *changed(MINUS, lambda m: "")),
        "order": (
            *changed(ARGUMENTS, lambda m: f"{m[2]}, {m[1]}"),
            *changed(TWO_INDICES, lambda m: f"[{m[2]}][{m[1]}]"),
        ),
    }
    pairs = ((text, kind) for kind, texts in kinds.items() for text in texts)
    return [(kind, text) for text, kind in dict(pairs).items() if text != line]


def _number(text):
    return int(text) if text.isdigit() else float(text)


def mistakes_at(file, lines, number, added):
    """All Mistakes in a line of a file, given by its number from 1."""
    line = lines[number - 1]
    found = [Mistake(file, number, kind, (line,), (text,)) for kind, text in mistakes_of(line)]
    below = lines[number] if number + 1 in added else ""
    here, there = STATEMENT.fullmatch(line), STATEMENT.fullmatch(below)
    if here and there and here[1] == there[1] and line != below and depend(line, below):
        found.append(Mistake(file, number, "order", (line, below), (below, line)))
    return found


def depend(*statements):
    """Whether one of two statements may change a name that the other has: their order matters."""
    names = [set(NAME.findall(statement)) for statement in statements]
    left = [ASSIGNMENT.split(statement)[0] for statement in statements]
    changed = [set(NAME.findall(DECLARED.sub(r"\1", text))) for text in left]
    return not (changed[0].isdisjoint(names[1]) and changed[1].isdisjoint(names[0]))


def git(root, *words):
    """The output of a git command in a checkout. Raises InputError."""
    done = subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True)
    if done.returncode:
        raise InputError(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout


def added_lines(root, since):
    """{file: numbers of its lines} of the C++ lines in HEAD that a revision does not have."""
    places = [f"{folder}/*.{ending}" for folder in FOLDERS for ending in ("hpp", "cpp")]
    found, numbers = {}, set()
    for line in git(root, "diff", "-U0", "--no-renames", since, "HEAD", "--", *places).splitlines():
        if line.startswith("+++ b/"):
            numbers = found.setdefault(line[6:], set())
        elif hunk := re.match(r"@@ \S+ \+(\d+)(?:,(\d+))? @@", line):
            first, count = int(hunk[1]), int(hunk[2] or 1)
            numbers.update(range(first, first + count))
    return found


def plant(root, since, count, seed, globs=("*",)):
    """{Mistake: text of its file} of `count` mistakes, or fewer if there are no more.

    Only in files that match one of the patterns, in which * includes subfolders. Lines are drawn at
    random, then one of each line's mistakes; lines are drawn again only when every line has one.
    The same tree, revision and seed give the same mistakes.
    """
    texts, places = {}, []
    for file, added in sorted(added_lines(root, since).items()):
        if not any(fnmatch.fnmatch(file, glob) for glob in globs):
            continue
        texts[file] = git(root, "show", f"HEAD:{file}")
        lines = texts[file].splitlines()
        places += [mistakes_at(file, lines, number, added) for number in sorted(added)]
    draw, found = random.Random(seed), []
    while len(found) < count and any(places):
        places = [place for place in places if place]
        draw.shuffle(places)
        for place in places[: count - len(found)]:
            found.append(place.pop(draw.randrange(len(place))))
    return {mistake: texts[mistake.file] for mistake in found}
