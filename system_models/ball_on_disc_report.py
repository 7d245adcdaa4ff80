"""What a run says of the machine; to be written."""

from pathlib import Path

import xarray as xr

from .assembly import Assembly


def lines(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Sentences."""
    return []


def write(assembly: Assembly, dataset: xr.Dataset, folder: Path) -> list[Path]:
    """Pictures."""
    return []
