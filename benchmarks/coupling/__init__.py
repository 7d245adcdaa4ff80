"""The co-simulation master, and importers of its machines."""
