"""Functions that keep the values which their closures have when they are made."""

from __future__ import annotations

from types import CellType, FunctionType
from typing import Any


def bound(function: Any) -> Any:
    """A copy of a function with the present values of its closure.

    Python looks them up when the function is called, so functions made in a loop would all have the last value.
    """
    if not isinstance(function, FunctionType) or not function.__closure__:
        return function
    cells = tuple(_copied(one) for one in function.__closure__)
    made = FunctionType(function.__code__, function.__globals__, function.__name__, function.__defaults__, cells)
    made.__kwdefaults__ = function.__kwdefaults__
    return made


def _copied(cell: CellType) -> CellType:
    try:
        return CellType(cell.cell_contents)
    except ValueError:  # it has no value yet
        return cell
