"""The co-simulation master and other masters and importers."""
