"""Compares what the solver does now with what it did when its baseline was accepted."""
