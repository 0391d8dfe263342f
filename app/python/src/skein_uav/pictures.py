"""Draws a learner's observation as a picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .batch import Floats

_SIDE = 200
_REACH_M = 40.0
_OWN, _OPPONENT, _RING = (31, 119, 180), (214, 39, 40), (200, 200, 200)


def picture(seen: Floats) -> NDArray[np.uint8]:
    """Draws an observation from above, with the learner's heading up: 80 m on a side, with rings every 10 m.

    Parameters
    ----------
    seen : ndarray, shape (9,) or (13,)

    Returns
    -------
    ndarray of uint8, shape (200, 200, 3)
    """
    pixels = np.full((_SIDE, _SIDE, 3), 255, dtype=np.uint8)
    row, column = np.mgrid[0:_SIDE, 0:_SIDE]
    ahead = _REACH_M * (1 - (row + 0.5) / (_SIDE / 2))
    right = _REACH_M * ((column + 0.5) / (_SIDE / 2) - 1)
    away = np.hypot(ahead, right)
    pixels[(np.abs(away % 10 - 5) > 4.8) & (away > 5)] = _RING
    pixels[np.hypot(ahead, right) < 1.2] = _OWN
    pixels[(np.abs(right) < 0.3) & (ahead > 0) & (ahead < 4)] = _OWN
    there = np.clip(seen[:2], -_REACH_M + 1, _REACH_M - 1)
    along = (ahead - there[0]) * seen[4] + (right - there[1]) * seen[5]
    across = (right - there[1]) * seen[4] - (ahead - there[0]) * seen[5]
    pixels[np.hypot(along, across) < 1.2] = _OPPONENT
    pixels[(np.abs(across) < 0.3) & (along > 0) & (along < 4)] = _OPPONENT
    return pixels
