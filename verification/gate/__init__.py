"""Compares the solver's present figures with its accepted baseline."""
