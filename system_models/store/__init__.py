"""Checkpoints and results on disk.

    checkpoint  the point that a run has reached: a killed run continues from it
    folders     a folder of results, made before a run
    results     a run as an xarray Dataset, as netCDF and as CSV

Both are replaced as a whole, never changed: a kill leaves the old file or the new one.
"""
