"""The two ways in which the reference solver refuses to answer."""


class InputError(Exception):
    """Bad usage or bad input: the command line ends with exit code 2."""


class DivergenceError(Exception):
    """Newton's method found no equilibrium: the command line ends with exit code 3."""
