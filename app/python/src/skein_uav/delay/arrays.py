"""Operations that differ between arrays of NumPy, PyTorch and JAX, and trees of arrays: dicts and tuples of them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np

Tree = Any
"""An array whose first axis counts environments, or dicts and tuples of such."""


def namespace(array: Any) -> Any:
    """The module of an array's functions."""
    if hasattr(array, "is_cuda"):
        return sys.modules["torch"]
    return sys.modules["jax.numpy"] if hasattr(array, "at") else np


def on(like: Any, value: Any) -> Any:
    """A value as an array of another one's kind, on its device."""
    if type(like) is np.ndarray:
        return np.asarray(value)
    xp = namespace(like)
    return xp.as_tensor(value, device=like.device) if hasattr(like, "is_cuda") else xp.asarray(value)


def cast(array: Any, dtype: Any) -> Any:
    if array.dtype == dtype:
        return array
    return array.to(dtype) if hasattr(array, "is_cuda") else array.astype(dtype)


def put(array: Any, slot: slice, value: Any) -> Any:
    """The array with a value in this slice of the first axis; changed in place, except for immutable arrays of JAX."""
    if type(array) is not np.ndarray and hasattr(array, "at"):
        return array.at[slot].set(value)
    array[slot] = value
    return array


def apart(array: Any) -> Any:
    """The array, or a copy if assigning it to an overlapping slice requires one, as with PyTorch."""
    return array.clone() if hasattr(array, "is_cuda") else array


def changed(array: Any, mask: Any, value: Any) -> Any:
    """A copy with another array's values in some environments: given by indices with NumPy, else by flags."""
    if type(array) is not np.ndarray:
        return namespace(array).where(beside(mask, array), value, array)
    array = array.copy("K")
    array[mask] = value[mask]
    return array


def beside(flags: Any, array: Any) -> Any:
    """Flags or weights of the environments, with the array's number of axes."""
    return flags if flags.ndim == array.ndim else flags.reshape((-1,) + (1,) * (array.ndim - 1))


def joined(columns: list[Any], width: int) -> Any:
    """Matrices joined by columns to this total width, of the first one's kind; None values are skipped."""
    first = columns[0]
    if type(first) is not np.ndarray:
        return namespace(first).concatenate([cast(one, first.dtype) for one in columns if one is not None], 1)
    all, begin = np.empty((len(first), width), first.dtype), 0
    for one in columns:
        if one is not None:
            end = begin + one.shape[1]
            all[:, begin:end] = one
            begin = end
    return all


def leaf(tree: Tree) -> Any:
    """Any array of a tree."""
    while isinstance(tree, (dict, tuple)):
        tree = next(iter(tree.values())) if isinstance(tree, dict) else tree[0]
    return tree


def each(function: Callable[..., Any], *trees: Tree) -> Tree:
    """Applies a function to the arrays of trees of one form."""
    first = trees[0]
    if type(first) is np.ndarray:
        return function(*trees)
    if isinstance(first, dict):
        return {name: each(function, *(tree[name] for tree in trees)) for name in first}
    if isinstance(first, tuple):
        return tuple(each(function, *parts) for parts in zip(*trees))
    return function(*trees)
