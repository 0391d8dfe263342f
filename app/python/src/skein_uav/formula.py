"""Ordinary arithmetic on numbers that are known in flight alone.

A policy or a measure is an ordinary function. Called with floats, it computes with floats. A scenario (see
`skein_uav.scenario`) calls it once with symbolic numbers and writes down what it computes, which every engine flies.

Operators, NumPy's functions and those of this module take both: ``sin``, ``cos``, ``tan``, ``asin``, ``acos``, ``atan``,
``atan2``, ``hypot``, ``sqrt``, ``exp``, ``tanh``, ``floor``, ``ceil``, ``rint``, ``sign``, ``remainder``, ``wrap``,
``minimum``, ``maximum``, ``clip``, ``where``, ``logical_and``, ``logical_or``, ``logical_not``, ``pick`` and
``smallest``. `Untraceable` says which line does what cannot be written down, and what to write instead.
"""

from __future__ import annotations

import dataclasses
import functools
import linecache
import math
import os
import re
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .errors import SkeinError

_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep


class Untraceable(SkeinError):
    """A policy does what cannot be written down; the message has its line, and what to write instead."""


def refused(reason: str) -> Untraceable:
    """The error for the line of the user's code that is being run."""
    frame = sys._getframe(1)
    while frame.f_back is not None and not _is_users(frame.f_code.co_filename):
        frame = frame.f_back
    name, line = frame.f_code.co_filename, frame.f_lineno
    code = linecache.getline(name, line).strip()
    shown = f": {code}" if code else ""
    return Untraceable(f"{os.path.basename(name)}:{line}{shown}\n  {_better(reason, code)}")


def _is_users(name: str) -> bool:
    inside = os.path.abspath(name).startswith(_HERE) or name.startswith("<")
    return not inside and f"{os.sep}numpy{os.sep}" not in name and "dataclasses.py" not in name


def _better(reason: str, code: str) -> str:
    """Names what to write instead, as far as the line says what was meant."""
    if reason == _BRANCH:
        for pattern, instead in _BRANCHES:
            if re.search(pattern, code):
                return f"{reason}; write {instead}"
        return f"{reason}; write where(condition, a, b), which takes one of both"
    if reason == _INDEX:
        if re.search(r"\brange\(", code):
            return f"{reason}; write a loop over a range that is known, with where(condition, changed, unchanged) in it"
        return f"{reason}; write pick(index, values)"
    if reason == _VALUE:
        called = re.search(r"\b(?:math|np|numpy)\.(?:linalg\.)?(\w+)\(", code)
        if called and called[1] in ("norm", "dist"):
            return f"{reason}; write hypot(x, y) of skein_uav.formula"
        if called and called[1] in globals():
            return f"{reason}; write {called[1]} of skein_uav.formula"
        if called and called[1] in ("log", "log2", "log10"):
            return f"{reason}; there is no logarithm in formulas"
        for pattern, instead in _VALUES:
            if re.search(pattern, code):
                return f"{reason}; {instead}"
        return f"{reason}; write it with the functions of skein_uav.formula, and leave it a number"
    return reason


_BRANCH = "it branches on a number that is known in flight alone"
_VALUE = "it needs the value of a number that is known in flight alone"
_INDEX = "it counts or indexes by a number that is known in flight alone"
_VALUES = [
    (r"\bround\(", "write rint(x) of skein_uav.formula"),
    (r"\bint\(", "write floor(x) or ceil(x) of skein_uav.formula"),
    (r"\bfloat\(", "leave it a number, without float"),
    (r"\bf[\"']|\bformat\(|%", "a text cannot hold it; leave the text away, or make the number a series of the scenario"),
]
_BRANCHES = [
    (r"\bmin\(", "minimum(a, b)"),
    (r"\bmax\(", "maximum(a, b)"),
    (r"\b(?:sorted|\.sort)\(", "smallest(items, key), or minimum and maximum of neighbours"),
    (r"\b(?:argmin|argmax)\(", "smallest(items, key)"),
    (r"\band\b", "logical_and(a, b), or a & b with each comparison in parentheses"),
    (r"\bor\b", "logical_or(a, b), or a | b with each comparison in parentheses"),
    (r"\bnot\b", "logical_not(condition), or ~condition"),
    (r"\bwhile\b", "a loop over a range that is known, with where(condition, changed, unchanged) in it"),
    (r"[<>]=?[^<>=]+[<>]=?", "logical_and(a < b, b < c)"),
    (r"\bin\b", "comparisons, joined by logical_or"),
]


class Graph:
    """What was computed so far: each operation once, with its arguments' places."""

    def __init__(self) -> None:
        self.lines: list[tuple[str, tuple[int, ...], str]] = []
        self._known: dict[tuple[str, tuple[int, ...], str], int] = {}

    def add(self, op: str, args: tuple[int, ...] = (), text: str = "") -> int:
        key = (op, args, text)
        if key not in self._known:
            self._known[key] = len(self.lines)
            self.lines.append(key)
        return self._known[key]

    def leaf(self, op: str, text: str = "", of: object = None) -> Number:
        """A number that is read, by the decision or settings that it belongs to."""
        return Number(self, self.add(op, (), text), of)


class _Symbol:
    """A number or a condition of a graph.

    `of` is the decision during which it was read; None for what depends on settings alone.
    """

    __slots__ = ("graph", "node", "of")
    __array_priority__ = 1000.0

    def __init__(self, graph: Graph, node: int, of: object = None) -> None:
        self.graph, self.node, self.of = graph, node, of

    def __bool__(self) -> bool:
        raise refused(_BRANCH)

    def __hash__(self) -> int:
        raise refused("it looks something up by a number that is known in flight alone; write pick(index, values)")

    def _no_value(self, *_: object) -> Any:
        raise refused(_VALUE)

    __float__ = __int__ = __complex__ = __round__ = __trunc__ = _no_value  # type: ignore[assignment]

    def __index__(self) -> int:
        raise refused(_INDEX)

    def __format__(self, form: str) -> str:
        if form:
            raise refused(_VALUE)
        return repr(self)

    def __iter__(self) -> Any:
        raise refused("it is one number, not several; it cannot be taken apart")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or any(isinstance(one, np.ndarray) for one in inputs):
            # Arrays of numbers: NumPy then applies operators and methods to each.
            inputs = tuple(_boxed(one) if isinstance(one, _Symbol) else one for one in inputs)
            return getattr(ufunc, method)(*inputs, **options)
        function = _UFUNCS.get(ufunc.__name__)
        if function is None or options:
            raise refused(f"there is no {ufunc.__name__} in formulas; write it with those of skein_uav.formula")
        return function(*(one.item() if isinstance(one, np.generic) else one for one in inputs))

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        known = {"where": where, "clip": clip}.get(function.__name__)
        if known is None:
            raise refused(f"there is no {function.__name__} in formulas; write it with those of skein_uav.formula")
        return known(*args, **kwargs)


def _boxed(one: _Symbol) -> np.ndarray[Any, Any]:
    box = np.empty((), dtype=object)
    box[()] = one
    return box


class Condition(_Symbol):
    """Whether something holds, known in flight alone."""

    __slots__ = ()

    def __and__(self, other: Any) -> Condition:
        return logical_and(self, other)

    def __or__(self, other: Any) -> Condition:
        return logical_or(self, other)

    __rand__, __ror__ = __and__, __or__

    def __invert__(self) -> Condition:
        return logical_not(self)

    def _no_number(self, *_: object) -> Any:
        raise refused("it computes with a condition; write where(condition, 1.0, 0.0)")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = _no_number
    __neg__ = __lt__ = __le__ = __gt__ = __ge__ = __eq__ = __ne__ = _no_number  # type: ignore[assignment]
    __hash__ = _Symbol.__hash__

    def __repr__(self) -> str:
        return "<condition>"


class Number(_Symbol):
    """A number that is known in flight alone."""

    __slots__ = ()

    def __add__(self, other: Any) -> Any:
        return _of("add", self, other)

    def __radd__(self, other: Any) -> Any:
        return _of("add", other, self)

    def __sub__(self, other: Any) -> Any:
        return _of("sub", self, other)

    def __rsub__(self, other: Any) -> Any:
        return _of("sub", other, self)

    def __mul__(self, other: Any) -> Any:
        return _of("mul", self, other)

    def __rmul__(self, other: Any) -> Any:
        return _of("mul", other, self)

    def __truediv__(self, other: Any) -> Any:
        return _of("div", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _of("div", other, self)

    def __floordiv__(self, other: Any) -> Any:
        return floor(self / other)

    def __rfloordiv__(self, other: Any) -> Any:
        return floor(other / self)

    def __mod__(self, other: Any) -> Any:
        return self - floor(self / other) * other

    def __rmod__(self, other: Any) -> Any:
        return other - floor(other / self) * self

    def __pow__(self, power: Any) -> Any:
        if isinstance(power, (int, float)) and power == 0.5:
            return sqrt(self)
        if isinstance(power, (int, float)) and power == int(power) and 1 <= abs(power) <= 16:
            product = functools.reduce(lambda one, other: one * other, [self] * int(abs(power)))
            return product if power > 0 else 1.0 / product
        raise refused("it raises to a power; write a product, or sqrt, or exp")

    def __rpow__(self, base: Any) -> Any:
        raise refused("it raises to a power; write exp(x * the logarithm of the base)")

    def __neg__(self) -> Any:
        return _of("neg", self)

    def __pos__(self) -> Any:
        return self

    def __abs__(self) -> Any:
        return _of("abs", self)

    def __floor__(self) -> Any:
        return floor(self)

    def __ceil__(self) -> Any:
        return ceil(self)

    def __lt__(self, other: Any) -> Any:
        return _of("lt", self, other)

    def __le__(self, other: Any) -> Any:
        return _of("le", self, other)

    def __gt__(self, other: Any) -> Any:
        return _of("lt", other, self)

    def __ge__(self, other: Any) -> Any:
        return _of("le", other, self)

    def __eq__(self, other: object) -> Any:
        return _of("eq", self, other)

    def __ne__(self, other: object) -> Any:
        return logical_not(_of("eq", self, other))

    __hash__ = _Symbol.__hash__

    def __repr__(self) -> str:
        op, _, text = self.graph.lines[self.node]
        return f"<{op} {text}>" if text else f"<{op}>"

    # NumPy applies these to each number of an array.
    def sin(self) -> Any:
        return _of("sin", self)

    def cos(self) -> Any:
        return _of("cos", self)

    def tan(self) -> Any:
        return tan(self)

    def arcsin(self) -> Any:
        return _of("asin", self)

    def arccos(self) -> Any:
        return _of("acos", self)

    def arctan(self) -> Any:
        return _of("atan", self)

    def arctan2(self, other: Any) -> Any:
        return atan2(self, other)

    def hypot(self, other: Any) -> Any:
        return hypot(self, other)

    def sqrt(self) -> Any:
        return _of("sqrt", self)

    def exp(self) -> Any:
        return _of("exp", self)

    def tanh(self) -> Any:
        return _of("tanh", self)

    def rint(self) -> Any:
        return _of("rint", self)


_CONDITIONS = ("lt", "le", "eq", "not", "and", "or", "always")


def _of(op: str, *args: Any) -> Any:
    """An operation on numbers, of which one or more are symbolic."""
    first = next(one for one in args if isinstance(one, _Symbol))
    kind = Condition if op in ("not", "and", "or") else Number
    nodes, of = [], None
    for place, one in enumerate(args):
        symbol = _symbol(first.graph, one, Condition if op == "where" and place == 0 else kind)
        if symbol is NotImplemented:
            return NotImplemented
        if symbol.graph is not first.graph or (of is not None and symbol.of is not None and symbol.of is not of):
            raise refused(
                "it uses a number of another decision; what a policy keeps is in its memory alone, which it returns"
            )
        of = of if of is not None else symbol.of
        nodes.append(symbol.node)
    made = Condition if op in _CONDITIONS else Number
    return made(first.graph, first.graph.add(op, tuple(nodes)), of)


def _symbol(graph: Graph, one: Any, kind: type) -> Any:
    if isinstance(one, kind):
        return one
    if isinstance(one, Number):
        raise refused("it takes a number for a condition; write a comparison, such as x > 0")
    if isinstance(one, Condition):
        raise refused("it computes with a condition; write where(condition, 1.0, 0.0)")
    if isinstance(one, (bool, np.bool_)) and kind is Condition:
        always = graph.add("always")
        return Condition(graph, always if one else graph.add("not", (always,)))
    if isinstance(one, (int, float, np.integer, np.floating)) and kind is Number:
        return constant(graph, float(one))
    return NotImplemented


def constant(graph: Graph, value: float) -> Number:
    """A number that is known already."""
    if math.isnan(value):
        raise refused("it computes with a number that is none (NaN)")
    text = repr(value) if math.isfinite(value) else "Infinity" if value > 0 else "-Infinity"
    return Number(graph, graph.add("const", (), text))


def _function(op: str, plain: Callable[..., Any], name: str, text: str) -> Any:
    def function(*args: Any) -> Any:
        if any(isinstance(one, np.ndarray) and one.ndim > 0 for one in args):
            made = np.frompyfunc(function, len(args), 1)(*args)
            return made if any(isinstance(one, _Symbol) for one in made.flat) else made.astype(float)
        if any(isinstance(one, _Symbol) for one in args):
            made = _of(op, *args)
            if made is NotImplemented:
                raise refused(f"{name} takes numbers, came {', '.join(type(one).__name__ for one in args)}")
            return made
        return plain(*args)

    function.__name__ = function.__qualname__ = name
    function.__doc__ = text
    return function


def _sign(x: float) -> float:
    return math.copysign(1.0, x) if x else x


sin = _function("sin", math.sin, "sin", "Sine of an angle, rad.")
cos = _function("cos", math.cos, "cos", "Cosine of an angle, rad.")
asin = _function("asin", math.asin, "asin", "Arc sine, rad.")
acos = _function("acos", math.acos, "acos", "Arc cosine, rad.")
atan = _function("atan", math.atan, "atan", "Arc tangent, rad.")
atan2 = _function("atan2", math.atan2, "atan2", "Angle of the point (x, y), given y first, rad.")
hypot = _function("hypot", math.hypot, "hypot", "Length of the vector (x, y).")
sqrt = _function("sqrt", math.sqrt, "sqrt", "Square root.")
exp = _function("exp", math.exp, "exp", "Power of e.")
tanh = _function("tanh", math.tanh, "tanh", "Hyperbolic tangent.")
floor = _function("floor", lambda x: float(math.floor(x)), "floor", "Greatest whole number that is not greater.")
ceil = _function("ceil", lambda x: float(math.ceil(x)), "ceil", "Least whole number that is not less.")
rint = _function("rint", lambda x: float(round(x)), "rint", "Nearest whole number; of two, the even one.")
sign = _function("signum", _sign, "sign", "1, 0 or -1 by the sign.")
remainder = _function("remainder", math.remainder, "remainder", "x minus the nearest multiple of y.")
_minimum = _function("min", min, "minimum", "The lesser of two numbers.")
_maximum = _function("max", max, "maximum", "The greater of two numbers.")
arctan2, arcsin, arccos, arctan = atan2, asin, acos, atan


def tan(x: Any) -> Any:
    """Tangent of an angle, rad."""
    return sin(x) / cos(x)


def wrap(angle: Any) -> Any:
    """The angle within -π to π, rad."""
    return remainder(angle, 2 * math.pi)


def minimum(first: Any, *others: Any) -> Any:
    """The least of some numbers."""
    return functools.reduce(lambda one, other: _extreme(_minimum, math.inf, one, other), others, first)


def maximum(first: Any, *others: Any) -> Any:
    """The greatest of some numbers."""
    return functools.reduce(lambda one, other: _extreme(_maximum, -math.inf, one, other), others, first)


def _extreme(of: Callable[..., Any], neutral: float, one: Any, other: Any) -> Any:
    if isinstance(other, Number) and isinstance(one, float) and one == neutral:
        return other
    if isinstance(one, Number) and isinstance(other, float) and other == neutral:
        return one
    return of(one, other)


def clip(x: Any, least: Any, most: Any) -> Any:
    """The number, or the bound that it is beyond."""
    return minimum(maximum(x, least), most)


def logical_and(a: Any, b: Any) -> Any:
    """Whether both hold."""
    return _of("and", a, b) if isinstance(a, _Symbol) or isinstance(b, _Symbol) else bool(a) and bool(b)


def logical_or(a: Any, b: Any) -> Any:
    """Whether one of both holds."""
    return _of("or", a, b) if isinstance(a, _Symbol) or isinstance(b, _Symbol) else bool(a) or bool(b)


def logical_not(a: Any) -> Any:
    """Whether it does not hold."""
    return _of("not", a) if isinstance(a, _Symbol) else not a


def where(condition: Any, a: Any, b: Any) -> Any:
    """`a` where the condition holds, else `b`.

    Both are computed. They may be numbers, conditions, actions, or dataclasses, tuples and lists of these, of one form.
    """
    if not isinstance(condition, _Symbol):
        return a if condition else b
    if isinstance(condition, Number):
        raise refused("it takes a number for a condition; write a comparison, such as x > 0")
    if hasattr(type(a), "_where") or hasattr(type(b), "_where"):
        return (a if hasattr(type(a), "_where") else b)._where(condition, a, b)
    if dataclasses.is_dataclass(a) and not isinstance(a, type) and type(a) is type(b):
        parts = {
            each.name: where(condition, getattr(a, each.name), getattr(b, each.name)) for each in dataclasses.fields(a)
        }
        return dataclasses.replace(a, **parts)
    if isinstance(a, (tuple, list)) and type(a) is type(b) and len(a) == len(b):
        return type(a)(where(condition, one, other) for one, other in zip(a, b, strict=True))
    if isinstance(a, Condition) or isinstance(b, Condition) or (isinstance(a, bool) and isinstance(b, bool)):
        return logical_or(logical_and(condition, a), logical_and(logical_not(condition), b))
    if a is b:
        return a
    if (isinstance(a, str) or a is None) and a == b:
        return a
    made = _of("where", condition, a, b)
    if made is NotImplemented:
        raise refused(f"where takes two of one kind, came {type(a).__name__} and {type(b).__name__}")
    return made


def pick(index: Any, values: Sequence[Any]) -> Any:
    """The value at an index that may be known in flight alone; beyond the last one, the last one."""
    if not isinstance(index, _Symbol):
        return values[int(index)]
    chosen = values[-1]
    for place in range(len(values) - 2, -1, -1):
        chosen = where(index < place + 0.5, values[place], chosen)
    return chosen


def smallest(items: Sequence[Any], key: Callable[[Any], Any]) -> Any:
    """The item with the least key, the first of equals."""
    best, least = items[0], key(items[0])
    for item in items[1:]:
        found = key(item)
        is_less = found < least
        best, least = where(is_less, item, best), where(is_less, found, least)
    return best


_UFUNCS: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: _of("add", a, b),
    "subtract": lambda a, b: _of("sub", a, b),
    "multiply": lambda a, b: _of("mul", a, b),
    "divide": lambda a, b: _of("div", a, b),
    "negative": lambda a: -a,
    "absolute": abs,
    "fabs": abs,
    "square": lambda a: a * a,
    "power": lambda a, b: a**b,
    "less": lambda a, b: _of("lt", a, b),
    "less_equal": lambda a, b: _of("le", a, b),
    "greater": lambda a, b: _of("lt", b, a),
    "greater_equal": lambda a, b: _of("le", b, a),
    "equal": lambda a, b: _of("eq", a, b),
    "not_equal": lambda a, b: logical_not(_of("eq", a, b)),
    "sin": sin,
    "cos": cos,
    "tan": tan,
    "arcsin": asin,
    "arccos": acos,
    "arctan": atan,
    "arctan2": atan2,
    "hypot": hypot,
    "sqrt": sqrt,
    "exp": exp,
    "tanh": tanh,
    "floor": floor,
    "ceil": ceil,
    "rint": rint,
    "sign": sign,
    "minimum": minimum,
    "maximum": maximum,
    "logical_and": logical_and,
    "logical_or": logical_or,
    "logical_not": logical_not,
    "bitwise_and": logical_and,
    "bitwise_or": logical_or,
    "invert": logical_not,
}
