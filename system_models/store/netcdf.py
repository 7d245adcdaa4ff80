"""Datasets as netCDF-4 files, by h5py alone: xarray takes ten times as long, and longer with thousands of variables.

The files are those that xarray writes, and open in it: netCDF-4 is HDF5 with dimension scales.
"""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr

_STORAGE = ("shuffle", "zlib", "chunksizes")  # of the encoding
_HIDDEN = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Coordinates", "_Netcdf4Dimid", "_NCProperties"}
_NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable."  # begin of the scale's name, by the standard


def save(dataset: xr.Dataset, path: Path) -> None:
    """Write a dataset; variables may have `zlib`, `shuffle` and `chunksizes` in their encoding."""
    variables, attributes = xr.conventions.encode_dataset_coordinates(dataset)
    encoded = {str(name): xr.conventions.encode_cf_variable(each, name=name) for name, each in variables.items()}
    with h5py.File(path, "w", track_order=True) as file:
        _describe(file, attributes)
        scales = {}
        for number, (dimension, size) in enumerate(dataset.sizes.items()):
            name = str(dimension)
            if name in encoded:
                scales[name] = _created(file, name, encoded.pop(name))
                scales[name].make_scale(name)
            else:
                scales[name] = file.create_dataset(name, (size,), ">f4", track_order=True)
                scales[name].make_scale(_NO_VARIABLE + b"%10d" % size)
            scales[name].attrs["_Netcdf4Dimid"] = np.int32(number)
        for name, variable in encoded.items():
            node = _created(file, name, variable)
            for axis, dimension in enumerate(variable.dims):
                node.dims[axis].attach_scale(scales[str(dimension)])


def _created(file: h5py.File, name: str, variable: xr.Variable) -> h5py.Dataset:
    text = variable.dtype.kind in "OU"
    storage: dict[str, Any] = {key: variable.encoding[key] for key in _STORAGE if key in variable.encoding}
    if storage.pop("zlib", False):
        storage["compression"] = "gzip"
    node = file.create_dataset(
        name,
        data=variable.values.astype(object) if text else variable.values,
        dtype=h5py.string_dtype() if text else None,
        fillvalue=variable.attrs.get("_FillValue"),
        chunks=storage.pop("chunksizes", None),
        track_order=True,
        **storage,
    )
    _describe(node, variable.attrs)
    return node


def _describe(node: h5py.HLObject, attributes: Any) -> None:
    for name, value in attributes.items():
        number = np.isscalar(value) and not isinstance(value, str)
        node.attrs[name] = np.atleast_1d(value) if number else value


def load(path: Path) -> xr.Dataset:
    """Return a dataset that `save` or xarray has written. Raises OSError or ValueError if it cannot be read."""
    with h5py.File(path, "r") as file:
        nodes = dict(file.items())
        scales = {_address(node): name for name, node in nodes.items() if h5py.h5ds.is_scale(node.id)}
        variables = {
            name: xr.Variable(_dimensions(file, name, node, scales), _values(node), _attributes(node))
            for name, node in nodes.items()
            if not node.attrs.get("NAME", b"").startswith(_NO_VARIABLE)
        }
        whole = xr.Dataset(variables, attrs=_attributes(file))
    return xr.decode_cf(whole, decode_times=False).load()


def attributes(path: Path) -> dict[str, Any]:
    """Return the attributes of the whole dataset alone; raises as `load`."""
    with h5py.File(path, "r") as file:
        return _attributes(file)


def _address(node: h5py.Dataset) -> int:
    return int(h5py.h5o.get_info(node.id).addr)


def _dimensions(file: h5py.File, name: str, node: h5py.Dataset, scales: dict[int, str]) -> list[str]:
    """Return the names of a variable's dimensions: of their addresses, as HDF5 searches the file for a name."""
    if "DIMENSION_LIST" not in node.attrs:
        return [name] * node.ndim  # of a dimension, its own
    return [scales[_address(file[last])] for *_, last in node.attrs["DIMENSION_LIST"]]


def _values(node: h5py.Dataset) -> Any:
    return node.asstr()[()].astype(str) if h5py.check_string_dtype(node.dtype) else node[()]


def _attributes(node: h5py.HLObject) -> dict[str, Any]:
    found = {name: value for name, value in node.attrs.items() if name not in _HIDDEN}
    return {name: value[0] if np.shape(value) == (1,) else value for name, value in found.items()}
