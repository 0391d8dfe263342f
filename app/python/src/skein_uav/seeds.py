"""Seeds of any size, as Gymnasium and numpy's SeedSequence make them."""

from __future__ import annotations

import operator
from typing import SupportsIndex

_BITS = 63


def folded(seed: SupportsIndex) -> int:
    """Folds a seed to Java's 64 bits.

    A seed below 2**63 stays unchanged; of a larger one, the groups of 63 bits are combined by exclusive or.

    Parameters
    ----------
    seed : int
        An integer from 0, of any size.

    Returns
    -------
    int
        An integer from 0 to 2**63 - 1.

    Raises
    ------
    ValueError
        If it is below 0.
    TypeError
        If it is no integer.
    """
    try:
        rest = operator.index(seed)
    except TypeError:
        raise TypeError(f"seed: expected a whole number from 0, got {seed!r}") from None
    if rest < 0:
        raise ValueError(f"seed: expected a whole number from 0, got {rest}")
    one = 0
    while rest:
        one ^= rest & ((1 << _BITS) - 1)
        rest >>= _BITS
    return one
