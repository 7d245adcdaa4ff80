"""The decorator of all compiled kernels."""

from numba import njit

# Compiled code is kept on disk (`cache`). A division by zero gives inf or nan, as in NumPy, and no exception.
jit = njit(cache=True, nogil=True, error_model="numpy")
