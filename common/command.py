"""Exit codes and arguments of command lines."""

import argparse
import sys

from common.errors import ComputationError, InputError


def exit_code(work, *arguments):
    """Runs work(*arguments) and returns the exit code of the command line.

    This is the value that work returns (0 for None), 2 for an InputError or 3 for a
    ComputationError; an error is reported in one line on standard error.
    """
    try:
        return work(*arguments) or 0
    except InputError as error:
        message, code = error, 2
    except ComputationError as error:
        message, code = error, 3
    print(f"error: {message}", file=sys.stderr)
    return code


def whole_number(smallest):
    """A type for argparse: whole numbers of at least `smallest`."""

    def number(text):
        found = int(text)
        if found < smallest:
            raise argparse.ArgumentTypeError(f"{text}: must be {smallest} or more")
        return found

    return number
