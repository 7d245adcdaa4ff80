"""Friction of full films."""
