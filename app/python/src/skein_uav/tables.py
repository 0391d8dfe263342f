"""Tables that commands print, as data frames."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import pandas as pd

_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?"

#: Cells for people with several numbers, or one with its unit, and a suffix of the column's name for each number.
_PARTS = [
    (re.compile(f"({_NUMBER}) ± ({_NUMBER}), ({_NUMBER}) … ({_NUMBER})"), ("", " sd", " min", " max")),
    (re.compile(f"({_NUMBER})/({_NUMBER})/({_NUMBER})"), (" mean", " median", " p99")),
    (re.compile(f"({_NUMBER}) … ({_NUMBER})"), (" min", " max")),
    (re.compile(f"({_NUMBER}) %"), (" %",)),
]


def frame(table: Mapping[str, Any]) -> pd.DataFrame:
    """A table of ``--json``; a cell with several numbers becomes several columns."""
    columns: dict[str, list[Any]] = {}
    titles = list(table["columns"])
    for number, title in enumerate(titles):
        cells = [row[number] for row in table["rows"]]
        for name, values in _numbers(_title(titles, number), cells):
            columns[name] = values
    made = pd.DataFrame(columns)
    made.attrs["note"] = table["note"]
    return made


def _title(titles: list[str], number: int) -> str:
    """Qualifies a repeated title by the last title before it that was not repeated: ``paper m: closest m``."""
    title = titles[number]
    if title not in titles[:number]:
        return title
    before = next((one for at, one in reversed(list(enumerate(titles[:number]))) if one not in titles[:at]), "")
    return f"{before}: {title}"


def _numbers(title: str, cells: list[Any]) -> list[tuple[str, list[Any]]]:
    """One column, or several if each cell holds several numbers."""
    for pattern, names in _PARTS:
        found = [None if cell is None else pattern.fullmatch(str(cell)) for cell in cells]
        if any(found) and all(cell is None or one for cell, one in zip(cells, found, strict=True)):
            stem = title.removesuffix(" min … max").removesuffix("min … max").removesuffix(" ")
            return [
                (f"{stem}{name}".strip(), [None if one is None else float(one[part + 1]) for one in found])
                for part, name in enumerate(names)
            ]
    return [(title, cells)]
