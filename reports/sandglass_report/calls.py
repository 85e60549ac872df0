"""Who calls whom, read from the sources: enough to notice that a chain of calls is no longer true.

Regular expressions, because the sources are laid out by clang-format and black.
"""

import re
from dataclasses import dataclass

from common.errors import InputError

NO_DEFINITION = ("return", "if", "for", "while", "switch", "else", "using", "throw", "//", "#")


@dataclass(frozen=True)
class Function:
    """A function in a file; `as_called` is how its caller writes it where that is not NAME(."""

    name: str
    file: str  # from the root of the tree
    as_called: str = ""


def bodies(text, name, is_python):
    """The definitions of a function in a source text, of all overloads, with their heads."""
    if is_python:
        pattern = rf"^( *)def {name}\(.*?(?=^\1\S|\Z)"
        return [match[0] for match in re.finditer(pattern, text, re.M | re.S)]
    found = []
    for match in re.finditer(rf"^ *(\S.*?)?\b{name}\(", text, re.MULTILINE):
        end = _end_of_body(text, match.end())
        if end and not (match[1] or "").startswith(NO_DEFINITION):
            found.append(text[match.start() : end])
    return found


def _end_of_body(text, start):
    """The end of the body after a head whose parenthesis opened before `start`; None: no body."""
    parentheses, braces = 1, 0
    for place in range(start, len(text)):
        sign = text[place]
        parentheses += {"(": 1, ")": -1}.get(sign, 0)
        if parentheses < 0 or (parentheses == braces == 0 and sign == ";"):
            return None
        if parentheses == 0 and sign in "{}":
            braces += 1 if sign == "{" else -1
            if braces == 0:
                return place + 1
    return None


def require_chain(root, chain):
    """Raises InputError unless every function is defined and calls the next one of the chain."""
    for caller, called in zip(chain, chain[1:]):
        call = called.as_called or f"{called.name}("
        if not any(call in body for body in _definitions(root, caller)):
            raise InputError(
                f"{caller.file}: {caller.name} does not call {called.name}: no '{call}'"
            )
    _definitions(root, chain[-1])


def _definitions(root, function):
    try:
        text = (root / function.file).read_text()
    except OSError as error:
        raise InputError(f"{function.file}: cannot be read: {error.strerror}") from error
    found = bodies(text, function.name, function.file.endswith(".py"))
    if not found:
        raise InputError(f"{function.file}: defines no function {function.name}")
    # Without its head: a function is not called by being defined.
    return [body[body.index("(") :] for body in found]
