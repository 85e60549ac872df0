"""The error that the command line shows as one line, with exit code 2."""


class ReportError(Exception):
    """An input is missing, broken, or does not belong to the others. The text says what to do."""
