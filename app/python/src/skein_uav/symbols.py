"""Numbers and conditions that are known only in flight, and the graph of computations with them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from .untraceable import BRANCH, INDEX, VALUE, refused

UFUNCS: dict[str, Callable[..., Any]] = {}
"""What NumPy's functions of numbers are in formulas, by their names; `skein_uav.formula` fills it."""
FUNCTIONS: dict[str, Callable[..., Any]] = {}
"""NumPy's other functions."""


class Graph:
    """The computation so far: each operation once, with its arguments' indices."""

    def __init__(self) -> None:
        self.lines: list[tuple[str, tuple[int, ...], str]] = []
        self._known: dict[tuple[str, tuple[int, ...], str], int] = {}

    def add(self, op: str, args: tuple[int, ...] = (), text: str = "") -> int:
        key = (op, args, text)
        if key not in self._known:
            self._known[key] = len(self.lines)
            self.lines.append(key)
        return self._known[key]

    def inputs(self, node: int) -> set[str]:
        """The operations without arguments on which a node depends."""
        left, known = [node], {node}
        while left:
            more = [one for one in self.lines[left.pop()][1] if one not in known]
            known.update(more)
            left.extend(more)
        return {op for op, args, _ in map(self.lines.__getitem__, known) if not args}

    def leaf(self, op: str, text: str = "", of: object = None) -> Number:
        """An input, of the decision or the settings that it belongs to."""
        return Number(self, self.add(op, (), text), of)


class Symbol:
    """A number or a condition of a graph.

    `of` is the decision during which it was read; None if it depends only on settings.
    """

    __slots__ = ("graph", "node", "of")
    __array_priority__ = 1000.0

    def __init__(self, graph: Graph, node: int, of: object = None) -> None:
        self.graph, self.node, self.of = graph, node, of

    def __bool__(self) -> bool:
        raise refused(BRANCH)

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, _: Any) -> Any:
        return self

    def __hash__(self) -> int:
        raise refused("it looks something up by a number that is known in flight alone; write pick(index, values)")

    def _no_value(self, *_: object) -> Any:
        raise refused(VALUE)

    __float__ = __int__ = __complex__ = __round__ = __trunc__ = _no_value  # type: ignore[assignment]

    def __index__(self) -> int:
        raise refused(INDEX)

    def __format__(self, form: str) -> str:
        if form:
            raise refused(VALUE)
        return repr(self)

    def __iter__(self) -> Any:
        raise refused("it is one number, not several; it cannot be taken apart")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        # NumPy's numbers are such arrays in comparisons.
        inputs = tuple(one.item() if isinstance(one, np.ndarray) and one.ndim == 0 else one for one in inputs)
        if method != "__call__" or any(isinstance(one, np.ndarray) for one in inputs):
            # Arrays of numbers: NumPy then applies operators and methods to each.
            inputs = tuple(_boxed(one) if isinstance(one, Symbol) else one for one in inputs)
            return getattr(ufunc, method)(*inputs, **options)
        function = UFUNCS.get(ufunc.__name__)
        if function is None or options:
            raise refused(f"there is no {ufunc.__name__} in formulas; write it with those of skein_uav.formula")
        return function(*(one.item() if isinstance(one, np.generic) else one for one in inputs))

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        known = FUNCTIONS.get(function.__name__)
        if known is None:
            raise refused(f"there is no {function.__name__} in formulas; write it with those of skein_uav.formula")
        return known(*args, **kwargs)


def _boxed(one: Symbol) -> np.ndarray[Any, Any]:
    box = np.empty((), dtype=object)
    box[()] = one
    return box


class Condition(Symbol):
    """A condition whose value is known only in flight."""

    __slots__ = ()
    words = "a condition"

    def __and__(self, other: Any) -> Condition:
        return operation("and", self, other)

    def __or__(self, other: Any) -> Condition:
        return operation("or", self, other)

    __rand__, __ror__ = __and__, __or__

    def __invert__(self) -> Condition:
        return operation("not", self)

    def _no_number(self, *_: object) -> Any:
        raise refused("it computes with a condition; write where(condition, 1.0, 0.0)")

    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __truediv__ = __rtruediv__ = _no_number
    __neg__ = __lt__ = __le__ = __gt__ = __ge__ = __eq__ = __ne__ = _no_number  # type: ignore[assignment]
    __hash__ = Symbol.__hash__

    def __repr__(self) -> str:
        return "<condition>"


class Number(Symbol):
    """A number that is known only in flight."""

    __slots__ = ()

    def __add__(self, other: Any) -> Any:
        return operation("add", self, other)

    def __radd__(self, other: Any) -> Any:
        return operation("add", other, self)

    def __sub__(self, other: Any) -> Any:
        return operation("sub", self, other)

    def __rsub__(self, other: Any) -> Any:
        return operation("sub", other, self)

    def __mul__(self, other: Any) -> Any:
        return operation("mul", self, other)

    def __rmul__(self, other: Any) -> Any:
        return operation("mul", other, self)

    def __truediv__(self, other: Any) -> Any:
        return operation("div", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return operation("div", other, self)

    def __floordiv__(self, other: Any) -> Any:
        return _quotient(self, other)

    def __rfloordiv__(self, other: Any) -> Any:
        return _quotient(other, self)

    def __mod__(self, other: Any) -> Any:
        return _modulo(self, other)

    def __rmod__(self, other: Any) -> Any:
        return _modulo(other, self)

    def __divmod__(self, other: Any) -> Any:
        return self // other, self % other

    def __rdivmod__(self, other: Any) -> Any:
        return other // self, other % self

    def __pow__(self, power: Any) -> Any:
        is_known = isinstance(power, (int, float, np.integer))
        if is_known and power == 0.5:
            return operation("sqrt", self)
        if is_known and power == int(power) and 1 <= abs(power) <= 16:
            product = functools.reduce(lambda one, other: one * other, [self] * int(abs(power)))
            return product if power > 0 else 1.0 / product
        raise refused("it raises to a power; write a product, or sqrt, or exp")

    def __rpow__(self, base: Any) -> Any:
        raise refused("it raises to a power; write exp(x * the logarithm of the base)")

    def __neg__(self) -> Any:
        return operation("neg", self)

    def __pos__(self) -> Any:
        return self

    def __abs__(self) -> Any:
        return operation("abs", self)

    def __floor__(self) -> Any:
        return operation("floor", self)

    def __ceil__(self) -> Any:
        return operation("ceil", self)

    def __lt__(self, other: Any) -> Any:
        return operation("lt", self, other)

    def __le__(self, other: Any) -> Any:
        return operation("le", self, other)

    def __gt__(self, other: Any) -> Any:
        return operation("lt", other, self)

    def __ge__(self, other: Any) -> Any:
        return operation("le", other, self)

    def __eq__(self, other: object) -> Any:
        return operation("eq", self, other)

    def __ne__(self, other: object) -> Any:
        return _negated(operation("eq", self, other))

    __hash__ = Symbol.__hash__

    def __repr__(self) -> str:
        op, _, text = self.graph.lines[self.node]
        return f"<{op} {text}>" if text else f"<{op}>"

    # NumPy applies these to each number of an array; `std` and `var` take the conjugate.
    def conjugate(self) -> Any:
        return self

    def sin(self) -> Any:
        return operation("sin", self)

    def cos(self) -> Any:
        return operation("cos", self)

    def tan(self) -> Any:
        return UFUNCS["tan"](self)

    def arcsin(self) -> Any:
        return operation("asin", self)

    def arccos(self) -> Any:
        return operation("acos", self)

    def arctan(self) -> Any:
        return operation("atan", self)

    def arctan2(self, other: Any) -> Any:
        return UFUNCS["arctan2"](self, other)

    def hypot(self, other: Any) -> Any:
        return UFUNCS["hypot"](self, other)

    def sqrt(self) -> Any:
        return operation("sqrt", self)

    def exp(self) -> Any:
        return operation("exp", self)

    def tanh(self) -> Any:
        return operation("tanh", self)

    def rint(self) -> Any:
        return operation("rint", self)


def _modulo(x: Any, y: Any) -> Any:
    """Python's x % y, exactly: x - y * floor(x / y) would round, so that 1.0 % 0.1 were 0."""
    rest = operation("remainder", x, y)
    if rest is NotImplemented:
        return rest
    return operation("where", rest * y < 0, rest + y, rest + 0.0)  # not -0.0


def _quotient(x: Any, y: Any) -> Any:
    """Python's x // y."""
    modulo = _modulo(x, y)
    return modulo if modulo is NotImplemented else operation("rint", (x - modulo) / y)


def _negated(condition: Any) -> Any:
    return condition if condition is NotImplemented else operation("not", condition)


_CONDITIONS = ("lt", "le", "eq", "not", "and", "or", "always")


def operation(op: str, *args: Any) -> Any:
    """An operation on numbers, at least one of which is symbolic."""
    first = next(one for one in args if isinstance(one, Symbol))
    if op in ("div", "remainder") and isinstance(args[1], (int, float, np.number)) and args[1] == 0:
        raise refused("it divides by 0")
    kind = Condition if op in ("not", "and", "or") else Number
    nodes, of = [], None
    for place, one in enumerate(args):
        symbol = _as_symbol(first.graph, one, Condition if op == "where" and place == 0 else kind)
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


def _as_symbol(graph: Graph, one: Any, kind: type) -> Any:
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
    """A number whose value is known."""
    if math.isnan(value):
        raise refused("it computes with a number that is none (NaN)")
    text = repr(value) if math.isfinite(value) else "Infinity" if value > 0 else "-Infinity"
    return Number(graph, graph.add("const", (), text))
