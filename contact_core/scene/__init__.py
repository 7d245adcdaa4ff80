"""The complete description of one contact: records, checks and TOML."""

from .scene import *  # noqa
