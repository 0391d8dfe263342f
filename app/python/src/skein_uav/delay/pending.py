"""The last decisions of a batch of environments, as a policy's input contains them."""

from __future__ import annotations

from typing import Any

import numpy as np

from .arrays import changed, namespace, on

_ROOM = 16
"""Decisions that fit after the pending ones before these are moved."""


class Pending:
    """The last decisions, the oldest first, in an array of NumPy.

    The numbers of a decision are rows, and environments are columns, so that the last decisions are contiguous.

    Parameters
    ----------
    idle : array
        The decision of each environment before the first one of an episode.
    number : int
        Number of decisions.
    """

    def __init__(self, idle: Any, number: int) -> None:
        self._shape = idle.shape[1:]
        one = np.ascontiguousarray(idle.reshape(len(idle), -1).T)
        self._each, self._length, self._end = len(one), len(one) * number, len(one) * number
        self._rows = np.tile(one, (number + _ROOM, 1))
        # Of equal columns, one is enough.
        self._idle = np.tile(one[:, :1] if (one == one[:, :1]).all() else one, (number, 1))

    def add(self, newest: Any) -> None:
        self._next()[:] = newest if newest.ndim == 1 else newest.reshape(len(newest), -1).T

    def void(self, which: Any) -> None:
        """Replaces the decisions of these environments, given by indices, by idle ones."""
        idle = self._idle
        self.columns()[:, which] = idle if idle.shape[1] == 1 else idle[:, which]

    def columns(self) -> Any:
        """Views the decisions, shape (numbers, environments)."""
        return self._rows[self._end - self._length : self._end]

    def by_environment(self) -> Any:
        """The decisions, shape (environments, decisions, …)."""
        return self.columns().T.reshape(-1, self._length // self._each, *self._shape).copy()

    def _next(self) -> Any:
        if self._end == len(self._rows):
            self._rows[: self._length] = self.columns()
            self._end = self._length
        begin, self._end = self._end, self._end + self._each
        return self._rows[begin : self._end]


class OneHot:
    """Encodes decisions, of these numbers, by a one among zeros, shape (environments, numbers)."""

    def __init__(self, numbers: np.ndarray) -> None:
        self.numbers = numbers[:, None]

    def __call__(self, decisions: Any) -> Any:
        return (on(decisions, self.numbers) == decisions).T


class PendingOneHot(Pending):
    """Encodes the decisions itself, where it keeps them."""

    def __init__(self, idle: Any, number: int, encode: OneHot) -> None:
        super().__init__(encode(idle), number)
        self._numbers = encode.numbers

    def add(self, newest: Any) -> None:
        np.equal(self._numbers, newest, out=self._next())


class PendingElsewhere:
    """Like `Pending`, in an array of PyTorch or JAX; the environments in `void` are given by flags."""

    def __init__(self, idle: Any, number: int) -> None:
        self._idle = self._decisions = namespace(idle).stack([idle] * number, 1)

    def add(self, newest: Any) -> None:
        self._decisions = namespace(newest).concatenate([self._decisions[:, 1:], newest[:, None]], 1)

    def void(self, which: Any) -> None:
        self._decisions = changed(self._decisions, which, self._idle)

    def by_environment(self) -> Any:
        return self._decisions
