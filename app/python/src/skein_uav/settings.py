"""A scenario's settings, and the scenario with symbolic numbers in their place."""

from __future__ import annotations

import copy
import dataclasses
import dis
import functools
import inspect
import math
import sys
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from .places import is_users
from .symbols import Graph, Number, Symbol
from .untraceable import Untraceable, explained


def symbolic(scenario: Any, graph: Graph) -> tuple[Any, list[tuple[str, float, str]]]:
    """A copy of a scenario whose settings are symbols; and each setting's key, default and meaning.

    Settings are parameters of the class that are float fields. The user's ``__init__`` and ``__post_init__`` run again,
    on symbols; of their results the copy takes what depends on settings, and has all else from the original.
    """
    if not dataclasses.is_dataclass(scenario):
        return _copied(scenario, {}), []
    fields = {each.name: each for each in dataclasses.fields(scenario) if each.init}
    values = {name: getattr(scenario, name) for name in fields}
    if _code(type(scenario)) is not None:
        made, values, leaves = _built(scenario, fields, values, graph)
    else:
        leaves = _leaves(fields, values, graph)
        made = _copied(scenario, leaves)
    settings = [(_key(name), float(values[name]), fields[name].metadata.get("meaning", "")) for name in leaves]
    return made, settings


def _key(name: str) -> str:
    return name.lower().replace("_", "-")


def _leaves(fields: Mapping[str, Any], values: Mapping[str, Any], graph: Graph) -> dict[str, Number]:
    leaves = {}
    for name, value in values.items():
        if isinstance(value, float) or (isinstance(value, int) and fields[name].type in (float, "float")):
            if not math.isfinite(value):
                raise ValueError(f"{name}: expected a finite number, got {float(value)}")
            leaves[name] = graph.leaf("setting", _key(name))
    return leaves


def _code(of: type) -> str | None:
    """The method of the user's that runs when a scenario is made."""
    if hasattr(of, "__post_init__"):
        return "__post_init__"
    code = getattr(of.__init__, "__code__", None)
    return "__init__" if code is not None and is_users(code) else None


def _copied(scenario: Any, leaves: Mapping[str, Number]) -> Any:
    """A copy with symbols, and without cached properties, which may depend on settings."""
    made = copy.copy(scenario)
    for name in cached(made):
        del made.__dict__[name]
    for name, leaf in leaves.items():
        object.__setattr__(made, name, leaf)
    return made


def cached(of: Any) -> list[str]:
    """Names of an object's cached properties that have been computed."""
    names = getattr(of, "__dict__", {})
    return [name for name in names if isinstance(getattr(type(of), name, None), functools.cached_property)]


def _built(scenario: Any, fields: Mapping[str, Any], now: Mapping[str, Any], graph: Graph) -> Any:
    """A scenario made from symbols, the values from which it is made otherwise, and the symbols."""
    kind = type(scenario)
    args, options = scenario._given
    given = inspect.signature(kind.__init__).bind(scenario, *args, **options)

    def made_of(arguments: Mapping[str, Any]) -> Any:
        for name, one in arguments.items():
            if isinstance(one, (list, dict, set, np.ndarray)):  # which its code may change
                given.arguments[name] = copy.copy(one)
        return kind(*given.args[1:], **given.kwargs)

    first = dict(given.arguments)
    fresh, stored = _storing(lambda: made_of(first))
    values, computed = {}, [name for name in _names(fresh) if name not in fields]
    for name, each in fields.items():
        if name not in given.signature.parameters:
            continue
        started = getattr(fresh, name, None)
        values[name] = given.arguments.get(name, started if each.default is dataclasses.MISSING else each.default)
        if values[name] is not started:
            computed.append(name)
        if isinstance(now[name], (int, float)) and now[name] != started:  # it was changed since
            values[name] = now[name]
    leaves = _leaves(fields, values, graph)
    given.arguments.update(leaves)
    try:
        made = made_of(first)
    except Exception as error:
        computes = ", ".join(dict.fromkeys([*computed, *stored]))
        if not computes:  # it only checks them
            return _copied(scenario, leaves), values, leaves
        raise Untraceable(
            f"{explained(error) or error}\n  {_code(kind)} is traced, as it computes {computes}; "
            "with properties instead, it may branch"
        ).with_traceback(error.__traceback__) from None
    lazy = cached(scenario)
    for name in _names(scenario):
        if name not in lazy and not _depends(getattr(made, name, None), made):
            object.__setattr__(made, name, getattr(scenario, name))
    return made, values, leaves


def _storing(make: Callable[[], Any]) -> tuple[Any, list[str]]:
    """What a function makes; and the attributes that the user's code, when it runs meanwhile, may set."""
    codes: dict[CodeType, None] = {}

    def note(frame: Any, event: str, _: Any) -> None:
        if event == "call" and is_users(frame.f_code):
            codes[frame.f_code] = None

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        made = make()
    finally:
        sys.setprofile(before)
    each = [one for code in codes for one in dis.get_instructions(code)]
    stored = [one.argval for one in each if one.opname == "STORE_ATTR"]
    return made, stored + [one.argval for one in each if one.argval in ("setattr", "__setattr__")]


def _names(scenario: Any) -> list[str]:
    """Attributes, also those in slots."""
    slots = [each.name for each in dataclasses.fields(scenario) if hasattr(scenario, each.name)]
    return [name for name in dict.fromkeys([*slots, *vars(scenario)]) if name != "_given"]


def _depends(value: Any, made: Any) -> bool:
    """Whether a value contains symbols, or the scenario that has them."""
    left, known = [value], {}
    while left:
        one = left.pop()
        if isinstance(one, Symbol) or one is made:
            return True
        if id(one) not in known:
            known[id(one)] = one
            left.extend(parts(one))
    return False


def parts(of: Any) -> Iterator[Any]:
    """The objects that an object holds: its items, attributes or closure."""
    if isinstance(of, Mapping):
        yield from of.values()
    elif isinstance(of, (list, tuple, set, frozenset, deque)):
        yield from of
    elif isinstance(of, np.ndarray) and of.dtype == object:
        yield from of.ravel().tolist()
    elif isinstance(of, MethodType):
        yield of.__self__
    elif isinstance(of, functools.partial):
        yield from (of.func, of.args, of.keywords)
    elif isinstance(of, FunctionType):
        yield of.__defaults__
        for cell in of.__closure__ or ():
            try:
                yield cell.cell_contents
            except ValueError:  # it has no value yet
                continue
    elif dataclasses.is_dataclass(of) and not isinstance(of, type):
        yield from (getattr(of, each.name, None) for each in dataclasses.fields(of))
    elif not isinstance(of, (type, ModuleType)):
        yield from getattr(of, "__dict__", {}).values()
