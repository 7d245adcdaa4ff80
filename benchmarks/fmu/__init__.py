"""The FMU: cost of a step, memory, lost processes."""
