"""Progress of long work as a line of text, on terminals and in notebooks."""

import contextlib
import sys


@contextlib.contextmanager
def shown(progress, title):
    """The callback for an argument `progress`: None, a callable, or True for a line of text.

    Raises TypeError for anything else.
    """
    if progress is None or progress is False:
        yield None
    elif progress is True:
        line = _Line(title)
        try:
            yield line
        finally:
            line.end()
    elif callable(progress):
        yield progress
    else:
        kind = type(progress).__name__
        raise TypeError(f"progress must be True or callable, but is a {kind}")


class _Line:
    """A bar that is written over itself: a carriage return works in a notebook, too."""

    def __init__(self, title):
        self._title, self._text = title, ""

    def __call__(self, share):
        full = int(30 * min(max(share, 0.0), 1.0))
        self._write(f"{self._title} [{'=' * full:<30}] {100 * share:3.0f} %")

    def end(self):
        if self._text:
            self._write("")
            sys.stderr.write("\r")

    def _write(self, text):
        if text == self._text:
            return
        sys.stderr.write("\r" + text.ljust(len(self._text)))
        sys.stderr.flush()
        self._text = text
