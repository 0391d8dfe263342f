"""Calls policies, and notes the lines that return their answers."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from typing import Any

from .places import code_of, place_of
from .untraceable import shown


def answered(function: Callable[..., Any], what: str, *arguments: Any) -> tuple[Any, str]:
    """A policy's answer, and the line that returned it, for messages: ``patrol.py:31: the policy of Scout``."""
    _check(function, what, len(arguments))
    line: int | None = None

    def note(frame: Any, event: str, _: Any) -> None:
        nonlocal line
        if event == "return" and frame.f_code is code_of(function):
            line = frame.f_lineno

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        answer = function(*arguments)
    finally:
        sys.setprofile(before)
    return answer, f"{place_of(function, line)}: {what}"


def _check(function: Any, what: str, count: int) -> None:
    if not callable(function):
        raise TypeError(f"expected a function as {what}, got {shown(function)}")
    try:
        takes = inspect.signature(function)
    except (TypeError, ValueError):  # of a function in C
        return
    try:
        takes.bind(*range(count))
    except TypeError:
        given = "an observation and the memory" if count == 2 else "an observation, as the vehicle has no memory"
        raise TypeError(f"{place_of(function)}: {what}: expected a function of {given}, got one of {takes}") from None
