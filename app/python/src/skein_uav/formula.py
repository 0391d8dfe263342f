"""Ordinary arithmetic on numbers that are known only in flight.

A policy or a measure is an ordinary function. Called with floats, it computes with floats. A scenario (see
`skein_uav.scenario`) calls it once with symbolic numbers and traces its computation, which every engine executes.

A whole power is a product, so from the third on it may round otherwise than that of floats.

Operators, NumPy's functions and those of this module take both: ``sin``, ``cos``, ``tan``, ``asin``, ``acos``, ``atan``,
``atan2``, ``hypot``, ``sqrt``, ``exp``, ``tanh``, ``floor``, ``ceil``, ``rint``, ``sign``, ``remainder``, ``wrap``,
``minimum``, ``maximum``, ``clip``, ``where``, ``logical_and``, ``logical_or``, ``logical_not``, ``pick`` and
``smallest``. `Untraceable` names a line whose computation cannot be traced, and what to write instead.
"""

from __future__ import annotations

import copy
import dataclasses
import functools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from .symbols import FUNCTIONS, UFUNCS, Condition, Number, Symbol, operation
from .untraceable import Untraceable as Untraceable
from .untraceable import refused, shown


_OF_TWO = ("atan2", "hypot", "remainder", "min", "max")


def _function(op: str, plain: Callable[..., Any], name: str, text: str) -> Any:
    takes = 2 if op in _OF_TWO else 1

    def function(*args: Any) -> Any:
        if len(args) != takes:
            raise TypeError(f"{name}() takes {takes} number{'s' * (takes - 1)}, got {len(args)}")
        if any(isinstance(one, np.ndarray) and one.ndim > 0 for one in args):
            made = np.frompyfunc(function, len(args), 1)(*args)
            return made if any(isinstance(one, Symbol) for one in made.flat) else made.astype(float)
        if any(isinstance(one, Symbol) for one in args):
            made = operation(op, *args)
            if made is NotImplemented:
                raise refused(f"{name} takes numbers, got {', '.join(type(one).__name__ for one in args)}")
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
_hypot = _function("hypot", math.hypot, "hypot", "Length of the vector (x, y).")
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


def hypot(x: Any, y: Any, *others: Any) -> Any:
    """Length of the vector (x, y), or of one with more numbers."""
    return functools.reduce(_hypot, others, _hypot(x, y))


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
    """The number, limited to the bounds."""
    return minimum(maximum(x, least), most)


def logical_and(a: Any, b: Any) -> Any:
    """Whether both hold."""
    return operation("and", a, b) if isinstance(a, Symbol) or isinstance(b, Symbol) else bool(a) and bool(b)


def logical_or(a: Any, b: Any) -> Any:
    """Whether at least one holds."""
    return operation("or", a, b) if isinstance(a, Symbol) or isinstance(b, Symbol) else bool(a) or bool(b)


def logical_not(a: Any) -> Any:
    """Whether it does not hold."""
    return operation("not", a) if isinstance(a, Symbol) else not a


def where(condition: Any, a: Any, b: Any) -> Any:
    """`a` where the condition holds, else `b`.

    Both are computed. They may be numbers, conditions, actions, or arrays, dataclasses, tuples and lists of these, of
    one form.
    """
    if not isinstance(condition, Symbol):
        return a if condition else b
    if isinstance(condition, Number):
        raise refused("it takes a number for a condition; write a comparison, such as x > 0")
    if hasattr(type(a), "_where") or hasattr(type(b), "_where"):
        return (a if hasattr(type(a), "_where") else b)._where(condition, a, b)
    if dataclasses.is_dataclass(a) and not isinstance(a, type) and type(a) is type(b):
        parts = {
            each.name: where(condition, getattr(a, each.name), getattr(b, each.name)) for each in dataclasses.fields(a)
        }
        return replaced(a, parts)
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        one, other = np.broadcast_arrays(np.asarray(a, dtype=object), np.asarray(b, dtype=object))
        made = [where(condition, *both) for both in zip(one.flat, other.flat, strict=True)]
        return np.array(made, dtype=object).reshape(one.shape)
    if isinstance(a, (tuple, list)) and type(a) is type(b) and len(a) == len(b):
        return like(a, (where(condition, one, other) for one, other in zip(a, b, strict=True)))
    if isinstance(a, Condition) or isinstance(b, Condition) or (isinstance(a, bool) and isinstance(b, bool)):
        return logical_or(logical_and(condition, a), logical_and(logical_not(condition), b))
    if a is b:
        return a
    if (isinstance(a, str) or a is None) and a == b:
        return a
    made = operation("where", condition, a, b)
    if made is NotImplemented:
        raise refused(f"where takes two of one kind, got {shown(a)} and {shown(b)}")
    return made


def replaced(of: Any, parts: Mapping[str, Any]) -> Any:
    """A copy of a dataclass with other values, also of fields that it computes itself."""
    made = copy.copy(of)
    for name, part in parts.items():
        object.__setattr__(made, name, part)
    return made


def like(of: Any, values: Iterable[Any]) -> Any:
    """A tuple, a named tuple or a list, of the type of another."""
    return getattr(type(of), "_make", type(of))(values)


def pick(index: Any, values: Sequence[Any]) -> Any:
    """The value at the nearest index from 0 to the last; halfway between two, at the greater one.

    The index may be known only in flight, and need not be whole: at 0.7 and 1 it is the second value, at -1 the first.
    """
    chosen = values[-1]
    for place in range(len(values) - 2, -1, -1):
        chosen = where(index < place + 0.5, values[place], chosen)
    return chosen


def smallest(items: Sequence[Any], key: Callable[[Any], Any]) -> Any:
    """The item with the least key; of several, the first."""
    best, least = items[0], key(items[0])
    for item in items[1:]:
        found = key(item)
        is_less = found < least
        best, least = where(is_less, item, best), where(is_less, found, least)
    return best


_OF_NUMPY: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: operation("add", a, b),
    "subtract": lambda a, b: operation("sub", a, b),
    "multiply": lambda a, b: operation("mul", a, b),
    "divide": lambda a, b: operation("div", a, b),
    "negative": lambda a: -a,
    "absolute": abs,
    "fabs": abs,
    "square": lambda a: a * a,
    "floor_divide": lambda a, b: a // b,
    "remainder": lambda a, b: a % b,
    "divmod": divmod,
    "power": lambda a, b: a**b,
    "less": lambda a, b: operation("lt", a, b),
    "less_equal": lambda a, b: operation("le", a, b),
    "greater": lambda a, b: operation("lt", b, a),
    "greater_equal": lambda a, b: operation("le", b, a),
    "equal": lambda a, b: operation("eq", a, b),
    "not_equal": lambda a, b: logical_not(operation("eq", a, b)),
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
UFUNCS.update(_OF_NUMPY)


def _clip_of_numpy(a: Any, a_min: Any = None, a_max: Any = None, *, min: Any = None, max: Any = None) -> Any:
    least, most = a_min if min is None else min, a_max if max is None else max
    return clip(a, -math.inf if least is None else least, math.inf if most is None else most)


FUNCTIONS.update(where=where, clip=_clip_of_numpy)
