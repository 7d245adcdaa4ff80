"""Smooth films by full multigrid."""
