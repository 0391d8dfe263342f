"""Names the line of a policy that cannot be traced, and what to write instead."""

from __future__ import annotations

import linecache
import os
import re
import sys
import traceback

from .errors import SkeinError

_HERE = os.path.dirname(os.path.abspath(__file__)) + os.sep


class Untraceable(SkeinError):
    """A policy's computation cannot be traced; the message has the line, and what to write instead."""


def refused(reason: str) -> Untraceable:
    """The error for the line of the user's code that runs now."""
    frame = sys._getframe(1)
    while frame.f_back is not None and not _is_users(frame.f_code.co_filename):
        frame = frame.f_back
    return _at(frame.f_code.co_filename, frame.f_lineno, reason)


def explained(error: TypeError) -> Untraceable | None:
    """Replaces NumPy's error about an array that mixes numbers known only in flight with others."""
    lacking = re.search(r"has no callable (\w+) method", str(error))
    frames = [one for one in traceback.extract_tb(error.__traceback__) if _is_users(one.filename)]
    if lacking is None or not frames:
        return None
    reason = f"NumPy has no {lacking[1]} for this array; write {lacking[1]} of skein_uav.formula, which takes arrays"
    return _at(frames[-1].filename, frames[-1].lineno or 0, reason)


def _at(name: str, line: int, reason: str) -> Untraceable:
    code = linecache.getline(name, line).strip()
    shown = f": {code}" if code else ""
    return Untraceable(f"{os.path.basename(name)}:{line}{shown}\n  {_better(reason, code)}")


def _is_users(name: str) -> bool:
    inside = os.path.abspath(name).startswith(_HERE) or name.startswith("<")
    return not inside and f"{os.sep}numpy{os.sep}" not in name and "dataclasses.py" not in name


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
]
_BRANCHES = [
    (r"\bnp\.maximum\(", "maximum(a, b) of skein_uav.formula, which takes arrays"),
    (r"\bnp\.minimum\(", "minimum(a, b) of skein_uav.formula, which takes arrays"),
    (r"\bnp\.clip\(", "clip(x, least, most) of skein_uav.formula, which takes arrays"),
    (r"\bwhere\(", "maximum or minimum of skein_uav.formula, which take arrays, or where for each number of an array"),
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
