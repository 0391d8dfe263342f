"""Shows a command's progress: as a bar if tqdm is installed, else as the lines that it prints."""

from __future__ import annotations

import re
import sys
import warnings
from types import TracebackType
from typing import Any

#: `` 27 %  12 s left      best 3.0 m``: the completed share, and the text next to it.
_SHARE = re.compile(r"\s*(\d{1,3}) %  (.*)")
_COUNT = re.compile(r"(\d+) of (\d+) (.*)")


class Progress:
    """Takes the lines of one command.

    >>> with Progress() as progress:        # doctest: +SKIP
    ...     progress.show(" 27 %  12 s left     best 3.0 m")
    """

    def __init__(self) -> None:
        self._bars = _tqdm()
        self._bar: Any = None

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._close()

    def show(self, line: str) -> None:
        """Moves the bar, or prints the line if it states no share."""
        share, count = _SHARE.match(line), _COUNT.match(line)
        if self._bars is None or not (share or count):
            self._print(line)
        elif share:
            self._move(int(share[1]), 100, share[2])
        elif count:
            self._move(int(count[1]), int(count[2]), count[3])

    def _move(self, done: int, total: int, text: str) -> None:
        if self._bar is not None and (self._bar.total != total or done < self._bar.n):
            self._close()
        if self._bar is None:
            self._bar = self._bars(total=total, file=sys.stderr, bar_format="{l_bar}{bar}|{postfix}")
        self._bar.set_postfix_str(" ".join(text.split()), refresh=False)
        self._bar.update(done - self._bar.n)

    def _print(self, line: str) -> None:
        if self._bar is None:
            print(line, file=sys.stderr)
        else:
            self._bars.write(line, file=sys.stderr)

    def _close(self) -> None:
        if self._bar is not None:
            self._bar.close()
            self._bar = None


def _tqdm() -> Any:
    """tqdm's class for this terminal or notebook; None if it is not installed."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a notebook without widgets gets a bar of text
        try:
            from tqdm.auto import tqdm
        except ImportError:
            return None
    return tqdm
