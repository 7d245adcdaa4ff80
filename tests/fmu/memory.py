"""Memory that this process has allocated."""

import ctypes
import gc
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


class _Mallinfo(ctypes.Structure):
    _fields_ = [(f"before_{k}", ctypes.c_size_t) for k in range(4)]
    _fields_ += [("in_maps", ctypes.c_size_t), ("unused_1", ctypes.c_size_t), ("unused_2", ctypes.c_size_t)]
    _fields_ += [("in_heap", ctypes.c_size_t), ("free", ctypes.c_size_t), ("at_top", ctypes.c_size_t)]


@contextmanager
def new_objects_only() -> Iterator[None]:
    """Leave what is there already to itself: collecting garbage then looks at what is made from now on."""
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


def allocated() -> int:
    """Return the bytes that this process has from malloc and has not freed, in memory or not."""
    mallinfo = getattr(ctypes.CDLL(None), "mallinfo2", None)
    if mallinfo is None:
        pytest.skip("this C library does not count what it has given")
    mallinfo.restype = _Mallinfo
    found = mallinfo()
    return found.in_heap + found.in_maps
