"""Recordings of flights as data frames."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

import duckdb
import pandas as pd

from .errors import SkeinError


class Recording(Mapping[str, pd.DataFrame]):
    """A recording: its tables by name, each read on first access.

    Names of columns end in their unit: ``Ns`` whole nanoseconds, ``Ms`` milliseconds, ``M`` metres, ``Mps``
    metres per second, ``Rad`` radians. ``North``, ``East``, ``Down`` are in the world frame. ``validAtNs``
    (also ``ownValidAtNs`` and the like), ``actsAtNs`` and ``predictedForNs`` are on the simulator's clock, all other
    instants on the controller's. Every table begins with ``row``, the order in which the rows of the flight were
    accepted.

    Parameters
    ----------
    path : path
        A DuckDB file of ``fly``; it is opened read-only.

    Raises
    ------
    SkeinError
        If it is missing, or not a recording.

    Examples
    --------
    >>> recording["decision"].groupby("vehicle").ownTrueAgeMs.mean()        # doctest: +SKIP
    >>> recording.sql("SELECT max(ownTrueAgeMs) FROM decision")             # doctest: +SKIP
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        if not self.path.is_file():
            raise SkeinError(f"expected a recording, got {self.path}, which is no file")
        try:
            self._database = duckdb.connect(str(self.path), read_only=True)
            self._names = [name for (name,) in self._database.execute("SHOW TABLES").fetchall() if name != "format"]
        except duckdb.Error as mistake:
            raise SkeinError(f"expected a recording, got {self.path}: {str(mistake).splitlines()[0]}") from None
        if "decision" not in self._names:
            self.close()
            raise SkeinError(f"expected a recording, got {self.path}, a database without a table 'decision'")

    def __getitem__(self, table: str) -> pd.DataFrame:
        if table not in self._names:
            raise KeyError(f"expected one of {', '.join(self._names)}, got '{table}'")
        return self._database.execute(f'SELECT * FROM "{table}" ORDER BY row').df()

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def sql(self, query: str, parameters: Any = None) -> pd.DataFrame:
        """The result of a query."""
        return self._database.execute(query, parameters).df()

    def close(self) -> None:
        """Closes the file."""
        self._database.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, mistake: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Recording({str(self.path)!r}: {', '.join(self._names)})"


def load(recording: str | os.PathLike[str]) -> Recording:
    """Opens a recording of a flight; see `Recording`."""
    return Recording(recording)
