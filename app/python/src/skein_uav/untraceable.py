"""Names the line of a policy that cannot be traced, and what to write instead."""

from __future__ import annotations

import linecache
import re
import sys
import traceback
from typing import Any

import numpy as np

from .errors import SkeinError
from .places import is_users, place


class Untraceable(SkeinError):
    """A policy's computation cannot be traced; the message has the line, and what to write instead."""


def refused(reason: str) -> Untraceable:
    """The error for the line of the user's code that runs now."""
    frame = sys._getframe(1)
    while frame.f_back is not None and not is_users(frame.f_code):
        frame = frame.f_back
    return at_line(frame.f_code.co_filename, frame.f_lineno, reason)


def explained(error: Exception) -> Untraceable | None:
    """Replaces errors of Python and NumPy that are about numbers known only in flight."""
    walked = traceback.walk_tb(error.__traceback__)
    frames = [(frame.f_code.co_filename, line) for frame, line in walked if is_users(frame.f_code)]
    if not frames:
        return None
    if re.search(r"could not convert string to float: '<.*>'", str(error)):
        return at_line(*frames[-1], f"{VALUE}; a text of it is no number: leave it a number")
    lacking = re.search(_LACKING, str(error))
    name = lacking[lacking.lastindex or 0] if lacking else ""
    if not isinstance(getattr(np, name, None), np.ufunc):
        return None
    instead = f"write {name} of skein_uav.formula, which takes arrays" if name in _KNOWN else "nor have formulas"
    return at_line(*frames[-1], f"NumPy has no {name} for this array; {instead}")


def shown(value: Any) -> str:
    """A value of the wrong kind, for a message."""
    if value is None:
        return "None; is a return missing?"
    if isinstance(value, type):
        return f"the class {value.__name__}"
    kind, text = type(value).__name__, repr(value)
    return getattr(type(value), "words", None) or (text if text.startswith(kind) else f"{kind} {text}")


def at_line(name: str, line: int, reason: str) -> Untraceable:
    """The error for a line of a file."""
    code = linecache.getline(name, line).strip()
    return Untraceable(f"{place(name, line)}{f': {code}' if code else ''}\n  {_better(reason, code)}")


def _better(reason: str, code: str) -> str:
    """Suggests what to write instead, as far as the line shows the intention."""
    if reason == BRANCH:
        for pattern, instead in _BRANCHES:
            if re.search(pattern, code):
                return f"{reason}; write {instead}"
        return f"{reason}; write where(condition, a, b), which takes one of both"
    if reason == INDEX:
        if re.search(r"\brange\(", code):
            return f"{reason}; write a loop over a range that is known, with where(condition, changed, unchanged) in it"
        return f"{reason}; write pick(index, values)"
    if reason == VALUE:
        called = re.search(r"\b(?:math|np|numpy)\.(?:linalg\.)?(\w+)\(", code)
        if called and called[1] in ("norm", "dist"):
            return f"{reason}; write hypot(x, y) of skein_uav.formula"
        if called and called[1] in _KNOWN:
            return f"{reason}; write {called[1]} of skein_uav.formula"
        if called and called[1] in ("log", "log2", "log10"):
            return f"{reason}; there is no logarithm in formulas"
        for pattern, instead in _VALUES:
            if re.search(pattern, code):
                return f"{reason}; {instead}"
        return f"{reason}; write it with the functions of skein_uav.formula, and leave it a number"
    return reason


_LACKING = (
    r"has no callable (\w+) method|^'(?:float|int|bool|Number)' object has no attribute '(\w+)'"
    r"|^ufunc '(\w+)' not supported"
)
_KNOWN = frozenset(
    "sin cos tan asin acos atan atan2 arcsin arccos arctan arctan2 hypot sqrt exp tanh floor ceil rint sign remainder "
    "minimum maximum clip where".split()
)
BRANCH = "it branches on a number that is known in flight alone"
VALUE = "it needs the value of a number that is known in flight alone"
INDEX = "it counts or indexes by a number that is known in flight alone"
_VALUES = [
    (r"\bround\(", "write rint(x) of skein_uav.formula"),
    (r"\bint\(", "write floor(x) or ceil(x) of skein_uav.formula"),
    (r"\bfloat\(", "leave it a number, without float"),
    (r"\bf[\"']|\bformat\(|%", "a text cannot hold it; leave it away, or make it a series of the scenario"),
    (r"(?:^|[;\s])[\w.]+\[[^\]]*\]\s*[-+*/]?=(?!=)", "make it an array of objects, such as np.zeros(3, dtype=object)"),
]
_BRANCHES = [
    (r"\bnp\.maximum\(", "maximum(a, b) of skein_uav.formula, which takes arrays"),
    (r"\bnp\.minimum\(", "minimum(a, b) of skein_uav.formula, which takes arrays"),
    (r"\bnp\.clip\(", "clip(x, least, most) of skein_uav.formula, which takes arrays"),
    (r"\bfor\b.*\bin\b.*\bif\b", "a sum or minimum over all of them, with where(condition, value, neutral) for each"),
    (r"\bmax\(.*\bkey\s*=", "smallest(items, key) of skein_uav.formula with the key negated"),
    (r"\bmin\(.*\bkey\s*=", "smallest(items, key) of skein_uav.formula"),
    (r"\bmin\(", "minimum(a, b)"),
    (r"\bmax\(", "maximum(a, b)"),
    (r"(?:\bsorted|\.sort|\.median)\(", "smallest(items, key), or minimum and maximum of neighbours"),
    (r"\b(?:any|all)\(", "logical_or or logical_and of one after the other"),
    (r"\b(?:argmin|argmax)\(", "smallest(items, key)"),
    (r"\band\b", "logical_and(a, b), or a & b with each comparison in parentheses"),
    (r"\bor\b", "logical_or(a, b), or a | b with each comparison in parentheses"),
    (r"\bnot\b", "logical_not(condition), or ~condition"),
    (r"\bwhere\(", "maximum or minimum of skein_uav.formula, which take arrays, or where for each number of an array"),
    (r"\bwhile\b", "a loop over a range that is known, with where(condition, changed, unchanged) in it"),
    (r"[<>]=?[^<>=]+[<>]=?", "logical_and(a < b, b < c)"),
    (r"^(?!.*\bfor\b).*\bin\b", "comparisons, joined by logical_or"),
]
