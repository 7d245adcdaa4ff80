"""Surfaces over hours: tribofilm, wear, roughness, Stribeck curves."""
