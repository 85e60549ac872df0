"""The two kinds of errors, as in solver/base/error.hpp."""

import difflib


class InputError(Exception):
    """Bad usage or input: names file or key, value, rule, what is allowed. Exit code 2."""


class ComputationError(Exception):
    """A computation failed: no equilibrium, or a program that crashed. Exit code 3."""


def suggestion(name, known):
    """The words "did you mean 'x'? known: a, b, c" that end an error about an unknown name."""
    nearest = difflib.get_close_matches(name, known, n=1)
    hint = f"did you mean {nearest[0]!r}? " if nearest else ""
    return f"{hint}known: {', '.join(known)}"
