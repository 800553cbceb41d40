"""Products and solutions that stay in one thread and give the same bytes however many cores there are.

The systems here are small and solved a hundred times over: threads would spend their time waiting for each
other, and the last bits of a sum would depend on how it was shared out among them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MULTIPLICATIONS = 200_000  # at a time; the library below numpy shares out from 262,144 on


def product(left: Floats, right: Floats) -> Floats:
    """left (M, K) times right (K, N), piece by piece of a long K."""
    rows, length = left.shape
    columns = right.shape[1]
    total = np.zeros((rows, columns))
    together = max(1, MULTIPLICATIONS // max(1, rows * columns))
    for start in range(0, length, together):
        part = slice(start, start + together)
        total += left[:, part] @ right[part]
    return total


def solution(matrix: Floats, right: Floats) -> Floats:
    """X (N, M) with matrix (N, N) · X = right, the matrix being symmetric and positive, by elimination.

    numpy.linalg.LinAlgError where it is not positive.
    """
    left, found = matrix.copy(), right.copy()
    for row in range(len(left)):
        if not left[row, row] > 0:
            raise np.linalg.LinAlgError("not positive")
        below = left[row + 1 :, row] / left[row, row]
        left[row + 1 :, row + 1 :] -= below[:, None] * left[row, row + 1 :]
        found[row + 1 :] -= below[:, None] * found[row]
    for row in range(len(left) - 1, -1, -1):
        found[row] -= (left[row, row + 1 :, None] * found[row + 1 :]).sum(axis=0)
        found[row] /= left[row, row]
    return found
