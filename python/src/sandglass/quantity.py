"""Arguments as the texts that the program takes."""

import os


def quantity_text(name, value):
    """A number, or a text such as "1%" or "2ms", as a text. Raises TypeError that names it."""
    if isinstance(value, str):
        return value
    if not isinstance(value, bool) and hasattr(value, "__float__"):
        try:
            return repr(float(value))
        except (TypeError, ValueError, OverflowError):
            pass
    kind = type(value).__name__
    raise TypeError(f'{name} must be a number or a text such as "1%", but is a {kind}')


def path_text(name, value):
    """A path as a text. Raises TypeError that names it."""
    if isinstance(value, (str, os.PathLike)):
        path = os.fspath(value)
        if isinstance(path, str):
            return path
    raise TypeError(f"{name} must be a path, but is a {type(value).__name__}")
