"""Types of the arrays that the numerics of the master work on, which know nothing of contacts."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
