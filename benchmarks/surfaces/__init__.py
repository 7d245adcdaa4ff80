"""Surfaces over hours."""
