"""The regression level: its fit, its errors, its cost."""
