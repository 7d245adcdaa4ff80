"""Mixed films of rough bodies: fluid and solid pressure on one grid."""
