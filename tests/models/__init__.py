"""FMUs on which a co-simulation master is tested."""

from .build import build
from .catalogue import MODELS

__all__ = ["MODELS", "build"]
