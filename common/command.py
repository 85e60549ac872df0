"""Command lines: how they end, and numbers out of them."""

import argparse
import sys

from common.errors import ComputationError, InputError


def exit_code(work, *arguments):
    """Does the work of a command line. Returns its exit code.

    That is what work(*arguments) returns, 0 for None; for an InputError 2 and for a
    ComputationError 3, which are told in one line of standard error.
    """
    try:
        return work(*arguments) or 0
    except InputError as error:
        told, code = error, 2
    except ComputationError as error:
        told, code = error, 3
    print(f"error: {told}", file=sys.stderr)
    return code


def whole_number(smallest):
    """A function that takes a whole number >= smallest out of the command line, for argparse."""

    def number(text):
        found = int(text)
        if found < smallest:
            raise argparse.ArgumentTypeError(f"{text}: must be {smallest} or more")
        return found

    return number
