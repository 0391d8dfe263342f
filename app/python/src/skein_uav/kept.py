"""Refuses functions that change something: they are traced once, and what they keep would stay as it was then."""

from __future__ import annotations

import dataclasses
import linecache
import re
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FunctionType, MethodType
from typing import Any

import numpy as np

from .places import code_of
from .settings import cached, parts
from .untraceable import at_line

_PLAIN = (bool, int, float, str, bytes, type(None))


@contextmanager
def unchanged(scenario: Any, function: Callable[..., Any]) -> Iterator[None]:
    """Refuses a function that meanwhile changes attributes of the scenario or its own object, or its closure.

    Raises
    ------
    Untraceable
        With the line, and what was changed.
    """
    before = _held(scenario, function)
    yield
    after = _held(scenario, function)
    for name in dict.fromkeys([*before, *after]):
        if (name in before) != (name in after) or before[name][0] != after[name][0]:
            code = code_of(function) or code_of(scenario.vehicles)
            reason = f"it changes {name}, but is called once, before the flight"
            instead = "a policy keeps what it returns as its memory"
            raise at_line(code.co_filename, _line(code, name), f"{reason}; {instead}")


def _held(scenario: Any, function: Any) -> dict[str, tuple[list[Any], list[Any]]]:
    """The contents of attributes and variables in which a function can keep something, by their names in its code."""
    is_function = isinstance(function, FunctionType)
    owner = function.__self__ if isinstance(function, MethodType) else scenario if is_function else function
    roots = {f"self.{name}": one for of in (owner, scenario) for name, one in _attributes(of).items()}
    plain = getattr(function, "__func__", function)
    if isinstance(plain, FunctionType):
        for name, cell in zip(plain.__code__.co_freevars, plain.__closure__ or (), strict=True):
            try:
                roots[name] = cell.cell_contents
            except ValueError:  # it has no value yet
                continue
    return {name: _contents(one, (owner, scenario)) for name, one in roots.items()}


def _attributes(of: Any) -> dict[str, Any]:
    """Attributes, also those in slots and what a class holds for all, without cached properties."""
    held = {name: one for kind in reversed(type(of).__mro__) for name, one in vars(kind).items() if name[:2] != "__"}
    known = {name: one for name, one in held.items() if isinstance(one, (list, dict, set, deque, np.ndarray))}
    fields = dataclasses.fields(of) if dataclasses.is_dataclass(of) else ()
    known |= {each.name: getattr(of, each.name) for each in fields if hasattr(of, each.name)}
    return {name: one for name, one in {**known, **getattr(of, "__dict__", {})}.items() if name not in cached(of)}


def _contents(value: Any, roots: tuple[Any, ...]) -> tuple[list[Any], list[Any]]:
    """What a value consists of, comparable, and the objects, which must live as long as the comparison."""
    found: list[Any] = []
    known: dict[int, Any] = {}
    left = [value]
    while left:
        one = left.pop()
        found.append(one if isinstance(one, _PLAIN) else id(one))
        if isinstance(one, _PLAIN) or id(one) in known or any(one is root for root in roots):
            continue
        known[id(one)] = one
        if isinstance(one, np.ndarray) and one.dtype != object:
            found.append(one.tobytes())
        hidden = [one.__dict__[name] for name in cached(one)]
        left.extend(part for part in parts(one) if not any(part is each for each in hidden))
    return found, list(known.values())


def _line(code: Any, name: str) -> int:
    """The line of a function that sets this or calls a method of it, or its first."""
    lines = sorted({line for _, _, line in code.co_lines() if line})
    changes = rf"\b{re.escape(name)}\b(?:\[[^\]]*\])*(?:\s*(?:[-+*/%|&^]|//|\*\*)?=(?!=)|\.\w+\()"
    changing = (line for line in lines if re.search(changes, linecache.getline(code.co_filename, line)))
    return next(changing, code.co_firstlineno)
