"""What was observed or decided in the last rows of a batch of environments."""

from __future__ import annotations

from typing import Any

import numpy as np

from .arrays import Tree, beside, cast, each, leaf, namespace, put


class History:
    """Rows of a tree of arrays in the order of time.

    A *place* is an environment's entry in a row: `count` of them are a row, and those of a newer row are larger. Rows are
    counted from the first after the last `forget`; those that were kept have numbers below 0.

    Parameters
    ----------
    value : Tree
        Fills all rows; arrays of ``count`` entries.
    kept, room : int
        Rows that `forget` keeps, and rows that fit behind them.
    count : int
        Environments.
    """

    def __init__(self, value: Tree, kept: int, room: int, count: int) -> None:
        self._xp, self._kept, self._count, self._length = namespace(leaf(value)), kept, count, kept + room
        self._rows: Tree = each(lambda one: _repeated(self._xp, one, kept + room), value)

    def put(self, row: int, value: Tree) -> None:
        slot, rows = self._slot(row, row + 1), self._rows
        if type(rows) is np.ndarray and rows.dtype == value.dtype:
            rows[slot] = value
        else:
            self._rows = each(lambda rows, one: put(_wide(rows, one), slot, one), rows, value)

    def put_where(self, mask: Any, first: int, end: int, value: Tree) -> None:
        """Puts the value in all rows from the first to the end, in some environments."""
        slot, rows = self._slot(first, end), self._rows
        if type(rows) is np.ndarray and end - first == 1:
            np.copyto(rows[slot], value, where=beside(mask, value))
            return
        self._rows = each(lambda rows, one: _put_where(self._xp, rows, slot, mask, one), rows, value)

    def take(self, places: Any) -> Tree:
        rows = self._rows
        return rows.take(places, 0) if type(rows) is np.ndarray else each(lambda one: _taken(one, places), rows)

    def row(self, row: int) -> Tree:
        """A whole row, of the episode or not; not to be changed."""
        slot = self._slot(row, row + 1)
        return each(lambda rows: rows[slot], self._rows)

    def before(self, row: int, number: int) -> Tree:
        """So many rows before this one, shape (environments, number, …)."""
        slot = self._slot(row - number, row)

        def copied(rows: Any) -> Any:
            last = rows[slot].reshape((number, self._count) + tuple(rows.shape[1:])).swapaxes(0, 1)
            return last.clone() if hasattr(last, "is_cuda") else last.copy()

        return each(copied, self._rows)

    def forget(self, number: int) -> None:
        """Makes room: row ``number`` becomes row 0."""
        if number:
            old = self._slot(number - self._kept, min(number + 1, self._length - self._kept))
            new = slice(0, old.stop - old.start)
            self._rows = each(lambda rows: put(rows, new, rows[old] + 0), self._rows)  # a copy, since they overlap

    def _slot(self, first: int, end: int) -> slice:
        return slice((first + self._kept) * self._count, (end + self._kept) * self._count)


def _repeated(xp: Any, one: Any, number: int) -> Any:
    rows = xp.concatenate([one] * number)
    return np.ascontiguousarray(rows) if xp is np else rows  # as ``take`` wants it, whatever the environment has


def _taken(rows: Any, places: Any) -> Any:
    return rows.take(places, 0) if type(rows) is np.ndarray else rows[places]


def _put_where(xp: Any, rows: Any, slot: slice, mask: Any, value: Any) -> Any:
    if xp is np:
        np.copyto(rows[slot].reshape((-1,) + value.shape), value, where=beside(mask, value))
        return rows
    old = rows[slot].reshape((-1,) + tuple(value.shape))
    return put(rows, slot, xp.where(beside(mask, value), value, old).reshape((-1,) + tuple(value.shape[1:])))


def _wide(rows: Any, one: Any) -> Any:
    """The rows, so that they hold a value as it is."""
    return rows if rows.dtype == one.dtype else cast(rows, namespace(rows).promote_types(rows.dtype, one.dtype))
