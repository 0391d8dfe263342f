"""Places in a user's code, for messages, and tracebacks without the frames of this package."""

from __future__ import annotations

import functools
import os
import re
import sys
import sysconfig
from collections.abc import Callable, Iterator
from types import CodeType, TracebackType
from typing import Any, ParamSpec, TypeVar

from .errors import SkeinError

_EXPLAINED = (SkeinError, TypeError, ValueError, NotImplementedError, KeyboardInterrupt)

P = ParamSpec("P")
T = TypeVar("T")

_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep
_TYPED = ("<stdin>", "<ipython-input", "<python-input")
_PYTHON = sysconfig.get_paths()["stdlib"] + os.sep
_LIBRARIES = tuple(f"{os.sep}{one}{os.sep}" for one in ("numpy", "pandas"))


def is_users(code: CodeType) -> bool:
    """Whether code is not of this package, Python itself, NumPy, pandas, or what dataclasses generate."""
    name = code.co_filename
    if name.startswith("<"):
        return name.startswith(_TYPED) or (name == "<string>" and not code.co_name.startswith("__"))
    is_pythons = name.startswith(_PYTHON) and "-packages" not in name
    return not (is_pythons or os.path.abspath(name).startswith(_HERE) or any(part in name for part in _LIBRARIES))


def place(file: str, line: int) -> str:
    """``patrol.py:31``, or ``cell 2, line 4`` in a notebook."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    label = getattr(getattr(shell, "compile", None), "format_code_name", lambda _: None)(file)
    number = re.search(r"\d+", label[1]) if label else None
    return f"cell {number[0]}, line {line}" if number else f"{os.path.basename(file)}:{line}"


def place_of(function: Callable[..., Any], line: int | None = None) -> str:
    """A line of a function; by default its first."""
    code = code_of(function)
    return place(code.co_filename, line or code.co_firstlineno) if code else repr(function)


def code_of(function: Any) -> Any:
    """The code of a function, a method, a `functools.partial` or an object that can be called; None if it has none."""
    function = getattr(function, "func", function)
    for one in (function, getattr(function, "__call__", None)):
        if code := getattr(getattr(one, "__func__", one), "__code__", None):
            return code
    return None


def plainly(function: Callable[P, T]) -> Callable[P, T]:
    """Shows the errors of a user's mistakes with the frames of the user's own code alone."""

    @functools.wraps(function)
    def called(*args: P.args, **kwargs: P.kwargs) -> T:
        __tracebackhide__ = True  # for IPython and pytest
        try:
            return function(*args, **kwargs)
        except (Exception, KeyboardInterrupt) as error:
            frames = list(_each(error.__traceback__))
            own = [one for one in frames if is_users(one.tb_frame.f_code)]
            if not isinstance(error, _EXPLAINED) and frames[-1:] != own[-1:]:
                raise
            trace = None
            for one in reversed(own):
                trace = TracebackType(trace, one.tb_frame, one.tb_lasti, one.tb_lineno)
            raise error.with_traceback(trace)

    return called


def _each(trace: TracebackType | None) -> Iterator[TracebackType]:
    while trace is not None:
        yield trace
        trace = trace.tb_next
