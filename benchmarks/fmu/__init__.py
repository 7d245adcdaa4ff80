"""The FMU: cost of a step."""
