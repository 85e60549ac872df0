"""What is told to the user instead of a traceback."""


class InputError(Exception):
    """A file breaks a rule: one line that names it, the place, the value and what is allowed."""
