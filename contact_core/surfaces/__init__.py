"""Rough surfaces of both bodies: generation, patches, track means, profiles."""
