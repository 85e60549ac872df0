"""Arguments of other types than the program takes, and their checks, which name them."""

import os

import numpy as np

import _sandglass


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
    """A path as a text. Raises TypeError, and InputError for what no file's name can be."""
    path = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    if not isinstance(path, str):
        raise TypeError(f"{name} must be a path, but is a {type(value).__name__}")
    if "\0" in path or not _encodable(path):
        raise _sandglass.InputError(f"{name} = {path!r} must be a path that a file can have")
    return path


def _encodable(text):
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def integer(name, value):
    """An integer of Python or NumPy as an int. Raises TypeError that names it."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"{name} must be an integer, but is a {type(value).__name__}")
    try:
        return value.__index__()
    except TypeError:
        raise TypeError(f"{name} must be an integer, but is an array") from None


def number(name, value):
    """A finite number as a float. Raises TypeError and InputError that name it."""
    array = real_array(name, value)
    if array.shape != ():
        raise TypeError(f"{name} must be a number, but is an array of shape {array.shape}")
    return float(array)


def real_array(name, given):
    """An array of numbers, which are finite. Raises TypeError and InputError that name it."""
    try:
        array = np.asarray(given)
    except (ValueError, OverflowError):
        array = np.asarray(None)
    if array.dtype.kind not in "iuf":
        kind = type(given).__name__
        raise TypeError(f"{name} must be an array of numbers, but is a {kind} of {array.dtype}")
    array = np.ascontiguousarray(array, dtype=float).reshape(array.shape)
    if not np.isfinite(array).all():
        raise _sandglass.InputError(f"{name} must be finite")
    return array


def text(name, value):
    """A text. Raises TypeError that names it."""
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a text, but is a {type(value).__name__}")
    if not _encodable(value):
        raise TypeError(f"{name} must be a text that UTF-8 can hold")
    return value
