"""Compares the solver's current figures with its accepted baseline."""
