"""Memories of policies: floats and bools in dataclasses, tuples, lists and NumPy's arrays."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np

from .formula import like, replaced
from .symbols import Condition, Number
from .untraceable import Untraceable, shown


def leaves(memory: Any, where_: str) -> list[Any]:
    """The numbers and truth values of a memory, in order."""
    if dataclasses.is_dataclass(memory) and not isinstance(memory, type):
        return [leaf for each in dataclasses.fields(memory) for leaf in leaves(getattr(memory, each.name), where_)]
    if isinstance(memory, (np.ndarray, np.generic)):
        flat = memory.ravel().tolist()
        return [leaf for each in flat for leaf in leaves(each, where_)]
    if isinstance(memory, (tuple, list)):
        return [leaf for each in memory for leaf in leaves(each, where_)]
    if isinstance(memory, (int, float, Number, Condition)):
        return [memory]
    raise Untraceable(
        f"{where_}: expected a memory of floats, in dataclasses, tuples, lists or arrays, got {shown(memory)}"
    )


def filled(memory: Any, held: Iterator[Any]) -> Any:
    """A memory of this form with other values."""
    if dataclasses.is_dataclass(memory) and not isinstance(memory, type):
        parts = {each.name: filled(getattr(memory, each.name), held) for each in dataclasses.fields(memory)}
        return replaced(memory, parts)
    if isinstance(memory, np.ndarray):
        made = np.empty(memory.shape, dtype=object)
        for place in np.ndindex(memory.shape):
            made[place] = next(held)
        return made
    if isinstance(memory, (tuple, list)):
        return like(memory, (filled(each, held) for each in memory))
    return next(held)


def form(memory: Any) -> str:
    """The form of a memory, which it keeps: ``Hold(float, array(3) of float)``."""
    if dataclasses.is_dataclass(memory) and not isinstance(memory, type):
        parts = ", ".join(form(getattr(memory, each.name)) for each in dataclasses.fields(memory))
        return f"{type(memory).__name__}({parts})"
    if isinstance(memory, np.ndarray) and memory.ndim:
        kinds = ", ".join(sorted({form(one) for one in memory.ravel().tolist()}))
        return f"array({', '.join(map(str, memory.shape))}) of {kinds}"
    if isinstance(memory, (np.ndarray, np.generic)):
        return form(memory.item())
    if isinstance(memory, (tuple, list)):
        return f"{type(memory).__name__}({', '.join(map(form, memory))})"
    if isinstance(memory, (bool, Condition)):
        return "bool"
    return "float" if isinstance(memory, (int, float, Number)) else shown(memory)
