"""The arrays that pass between functions: numbers, and places of rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers, in SI; for a single pose a field without an axis of its own is a numpy.float64."""
Index = NDArray[np.int64]
"""Places: of a row's window, of its record, of its channel."""
