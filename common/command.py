"""Exit codes and arguments of command lines."""

import argparse
import sys
from pathlib import Path

from common.errors import ComputationError, InputError
from common.files import require_writable


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


class _Parser(argparse.ArgumentParser):
    """One whose errors are those of every other input."""

    def error(self, message):
        raise InputError(f"{message}; --help lists what is allowed")


def option(*names, **settings):
    """An option or argument of a command_line(): what argparse's add_argument takes."""
    return names, settings


def command_line(work, text, *options, **settings):
    """The main function of a script: from arguments (None: those of the process) to an exit code.

    work: see exit_code(); takes the parsed options. text: the script's docstring, of which --help
    shows the first line and the exit codes. settings: of argparse's parser.
    """
    codes = " ".join(text[text.find("Exit codes:") :].split()) if "Exit codes:" in text else None
    described = {"description": text.splitlines()[0], "epilog": codes} | settings

    def main(arguments=None):
        """The command line. Returns the exit code."""
        parser = _Parser(**described)
        for names, how in options:
            parser.add_argument(*names, **how)
        return exit_code(lambda: work(parser.parse_args(arguments)))

    return main


def writable(text):
    """A type for argparse: the Path of a file that can be written. Raises InputError."""
    require_writable(text)
    return Path(text)


def whole_number(smallest):
    """A type for argparse: whole numbers of at least `smallest`."""

    def number(text):
        found = int(text)
        if found < smallest:
            raise argparse.ArgumentTypeError(f"{text}: must be {smallest} or more")
        return found

    return number
