"""Checkpoints and results on disk.

    checkpoint  the point that a run has reached: a killed run continues from it
    results     a run as an xarray Dataset, as netCDF and as CSV
    netcdf      any dataset as a netCDF file

Both are replaced as a whole, never changed: a kill leaves the old file or the new one.
"""
