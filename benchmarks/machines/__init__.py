"""Ball bearings, gear pairs and the test rig."""
