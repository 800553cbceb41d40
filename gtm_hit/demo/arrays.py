"""Names for the arrays that the renderer passes around."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.floating[Any]]  # single precision wherever there is a value per pixel
Bytes = NDArray[np.uint8]
Flags = NDArray[np.bool_]
Indices = NDArray[np.integer[Any]]
