"""Tables that commands print, as data frames."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import pandas as pd

_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?"

#: How many flights have no number, and why.
_REST = r"(?:, (\d+ [a-z].*))?"

#: Cells for people with several numbers, or one with its unit, and a suffix of the column's name for each number.
_PARTS = [
    (
        re.compile(f"({_NUMBER})(?= ±|, \\d+ [a-z])(?: ± ({_NUMBER}), ({_NUMBER}) … ({_NUMBER}))?{_REST}"),
        ("", " sd", " min", " max"),
    ),
    (re.compile(f"({_NUMBER})/({_NUMBER})/({_NUMBER}){_REST}"), (" mean", " median", " p99")),
    (re.compile(f"({_NUMBER}) … ({_NUMBER}){_REST}"), (" min", " max")),
    (re.compile(f"({_NUMBER}) %{_REST}"), (" %",)),
]


def frame(table: Mapping[str, Any]) -> pd.DataFrame:
    """A table of ``--json``; a cell with several numbers becomes several columns.

    Words among a column's numbers are in a column of their own, ``TITLE note``; the number is then missing.
    """
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
    """One column, or several if cells hold several numbers, or words among numbers."""
    texts = [cell if isinstance(cell, str) else "" for cell in cells]
    suffixes: tuple[str, ...] = ("",)
    found: list[re.Match[str] | None] = [None] * len(cells)
    for pattern, names in _PARTS:
        matches = [pattern.fullmatch(text) for text in texts]
        if any(matches):
            suffixes, found = names, matches
            break
    else:
        if not any(texts) or not any(isinstance(cell, (int, float)) for cell in cells):
            return [(title, cells)]
    rows = [_parted(cell, one, suffixes) for cell, one in zip(cells, found, strict=True)]
    stem = title.removesuffix(" min … max").removesuffix("min … max").removesuffix(" ")
    columns = zip((*suffixes, " note"), zip(*rows, strict=True), strict=True)
    return [(f"{stem}{name}".strip(), list(column)) for name, column in columns if set(column) != {None}]


def _parted(cell: Any, found: re.Match[str] | None, suffixes: tuple[str, ...]) -> list[Any]:
    """The numbers of a cell, for each suffix, and its words."""
    if found is not None:
        *numbers, words = found.groups()
        return [*(None if one is None else float(one) for one in numbers), words]
    none = [None] * len(suffixes)
    return [cell, *none] if suffixes[0] == "" and isinstance(cell, (int, float)) else [*none, cell]
