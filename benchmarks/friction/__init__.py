"""Friction and the cost of the laws."""
