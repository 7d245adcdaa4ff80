"""Ball bearings, gear pairs, and the coupling of machines."""
