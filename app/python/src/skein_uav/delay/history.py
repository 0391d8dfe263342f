"""The observations or decisions in the last rows of a batch of environments."""

from __future__ import annotations

from typing import Any

import numpy as np

from .arrays import Tree, apart, cast, changed, each, leaf, namespace, put


class History:
    """Rows of a tree of arrays, in the order of time.

    A *place* is the index of an environment's entry: a row has `count` of them, and those of a newer row are larger. Rows
    are counted from the first after the last `forget`; rows that were kept have negative indices.

    Parameters
    ----------
    value : Tree
        Fills all rows; arrays of ``count`` entries.
    kept, room : int
        Number of rows that `forget` keeps, and of rows that fit after them.
    count : int
        Number of environments.
    by_columns : bool
        Whether each column is contiguous, so that one loop copies it; the value then is a NumPy matrix.

    Attributes
    ----------
    rows : Tree
        The entries of all places; those of NumPy may be changed.
    """

    def __init__(self, value: Tree, kept: int, room: int, count: int, by_columns: bool = False) -> None:
        self._xp, self._kept, self._count, self._length = namespace(leaf(value)), kept, count, kept + room
        self._by_columns = by_columns
        self._hold(each(lambda one: _repeated(self._xp, one, kept + room), value))

    def _hold(self, rows: Tree) -> None:
        self.rows = np.asfortranarray(rows) if self._by_columns else rows
        self._dtype = rows.dtype if type(rows) is np.ndarray else None

    def put(self, row: int, value: Tree) -> None:
        begin = (row + self._kept) * self._count
        slot = slice(begin, begin + self._count)
        if self._dtype is not None and (value.dtype is self._dtype or value.dtype == self._dtype):
            self.rows[slot] = value
        else:
            self._hold(each(lambda rows, one: put(_wide(rows, one), slot, one), self.rows, value))

    def put_where(self, which: Any, row: int, value: Tree) -> None:
        """Stores the value in a row for some environments: given by indices with NumPy, else by flags."""
        slot = self._slot(row, row + 1)
        self._hold(each(lambda rows, one: put(rows, slot, changed(rows[slot], which, one)), self.rows, value))

    def take(self, places: Any) -> Tree:
        return self.rows.take(places, 0) if self._dtype is not None else each(lambda one: _taken(one, places), self.rows)

    def row(self, row: int) -> Tree:
        """A whole row, of any episode; must not be changed."""
        slot = self._slot(row, row + 1)
        return each(lambda rows: rows[slot], self.rows)

    def forget(self, number: int) -> None:
        """Makes room: row ``number`` becomes row 0."""
        if number:
            old = self._slot(number - self._kept, min(number + 1, self._length - self._kept))
            new = slice(0, old.stop - old.start)
            self._hold(each(lambda rows: put(rows, new, apart(rows[old])), self.rows))

    def _slot(self, first: int, end: int) -> slice:
        return slice((first + self._kept) * self._count, (end + self._kept) * self._count)


def _repeated(xp: Any, one: Any, number: int) -> Any:
    rows = xp.concatenate([one] * number)
    return np.ascontiguousarray(rows) if xp is np else rows  # as ``take`` requires, whatever the environment's layout is


def _taken(rows: Any, places: Any) -> Any:
    return rows.take(places, 0) if type(rows) is np.ndarray else rows[places]


def _wide(rows: Any, one: Any) -> Any:
    """The rows, widened to a type that represents the value exactly."""
    return rows if rows.dtype == one.dtype else cast(rows, namespace(rows).promote_types(rows.dtype, one.dtype))
