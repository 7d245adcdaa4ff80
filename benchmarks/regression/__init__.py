"""The regression level: its errors, its cost."""
