"""The commands' results: data frames and files, with their display in notebooks."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd

from .recording import Recording, load


T = TypeVar("T")


class Named(dict[str, T]):
    """A dict that lists its keys if one is missing."""

    def __missing__(self, name: str) -> T:
        raise KeyError(f"expected one of {', '.join(map(repr, self))}, got {name!r}")


class Tables(Named[pd.DataFrame]):
    """A command's output: data frames by their titles, which a notebook shows one below the other."""

    def _repr_html_(self) -> str:
        return "".join(_table(title, frame) for title, frame in self.items())


@dataclass(frozen=True)
class Figure:
    """A figure of a command, which a notebook shows.

    Attributes
    ----------
    path : Path
        The SVG file.
    """

    path: Path

    def _repr_svg_(self) -> str:
        text = self.path.read_text(encoding="utf-8")
        return text[text.index("<svg") :]  # some notebooks put it into their page, where XML's declaration is wrong


@dataclass(frozen=True)
class Flights:
    """The result of `fly`. A notebook shows its first table and its figures.

    Attributes
    ----------
    tables : dict of str to DataFrame
        The report's tables, by title; units are in the columns' names.
    recordings : list of Path
        One DuckDB file per flight, in the order of the tables; the virtual twins of live flights come last.
        `skein_uav.load` opens one.
    report : Path
        A page with tables and pictures.
    """

    tables: Tables
    recordings: list[Path]
    report: Path

    @property
    def figures(self) -> dict[str, Figure]:
        """The report's figures, by the files' names: ``trajectories``, ``latency``, …; graphs of loops come last."""
        return _figures(self.report.parent / "figures")

    def load(self, number: int = 0) -> Recording:
        """Opens one of the recordings."""
        return load(self.recordings[number])

    def __getitem__(self, title: str) -> pd.DataFrame:
        """The table of this title."""
        return self.tables[title]

    def __repr__(self) -> str:
        """The names of its parts, since whole tables would fill pages."""
        titles = ", ".join(repr(title) for title in self.tables)
        files = ", ".join(path.name for path in self.recordings)
        return f"Flights(tables: {titles}; recordings: {files}; report: {self.report})"

    def _repr_html_(self) -> str:
        first, *others = [_table(title, frame) for title, frame in self.tables.items()] or [""]
        shown = {name: figure for name, figure in self.figures.items() if not name.startswith("graph-")}
        return first + _pictures(shown) + _folded("More tables", "".join(others))


@dataclass(frozen=True)
class Found:
    """The result of `search`. A notebook shows the result and the picture of the landscape.

    Attributes
    ----------
    result : DataFrame
        The policy found and the one it started from, each with its mean on fresh episodes and a 95 % interval.
    policy : Path or None
        A policy file in `folder`, for ``fly(policy=…)``; None for a team's scenario, whose settings are `parameters`.
    landscape : DataFrame or None
        The objective around the policy found; None if the search was stopped before.
    folder : Path
        State, policy and pictures; temporary, unless ``search(out=…)`` named it.
    """

    result: pd.DataFrame
    policy: Path | None
    landscape: pd.DataFrame | None
    folder: Path

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters found; of a scenario its settings, for ``fly(settings=…)``."""
        words = [one.rsplit(" = ", 1) for one in self.result["parameters"].iloc[0].split(", ")]
        return {name: float(value) for name, value in words}

    @property
    def figures(self) -> dict[str, Figure]:
        """``landscape``, if one was drawn."""
        return _figures(self.folder, "landscape")

    def __repr__(self) -> str:
        """The result, and the folder of the other files."""
        return f"Found(policy: {self.policy}; folder: {self.folder}; result:\n{self.result.to_string()})"

    def _repr_html_(self) -> str:
        return _table("", self.result) + _pictures(self.figures)


@dataclass(frozen=True)
class Budget:
    """The result of `budget`. A notebook shows the picture of the map.

    Attributes
    ----------
    map : DataFrame
        A row for each cell: mean and jitter of the latency in ms, the objective there, and its deviation from `paused`,
        in per cent of it, or with ``within=`` in the objective's unit.
    sentence : str
        How much latency is tolerated; of several periods, a line for each.
    engine : str
        What simulated it.
    folder : Path
        The map's files; temporary, unless ``budget(out=…)`` named it.
    """

    map: pd.DataFrame
    sentence: str
    engine: str
    folder: Path

    @staticmethod
    def of(maps: list[dict[str, Any]], folder: Path) -> Budget:
        """A command's maps as JSON, and the folder in which it wrote their cells."""
        cells = pd.read_csv(folder / "map.csv")
        if maps[0]["deviation"].startswith("share"):
            cells["deviation %"] = 100 * cells.pop("deviation")
        sentences = "\n".join(f"{one['policy']}: {one['sentence']}" for one in maps)
        return Budget(cells, sentences, ", ".join(dict.fromkeys(one["engine"] for one in maps)), folder)

    def __repr__(self) -> str:
        return f"Budget({self.sentence}; engine: {self.engine}; {len(self.map)} cells; folder: {self.folder})"

    @property
    def figures(self) -> dict[str, Figure]:
        """``map``."""
        return _figures(self.folder, "map")

    def _repr_html_(self) -> str:
        said = f"<p>{escape(self.sentence)}</p><p><small>engine: {escape(self.engine)}</small></p>"
        return said + _pictures(self.figures) + _folded("Cells", _table("", self.map))


def _figures(folder: Path, name: str = "*") -> dict[str, Figure]:
    files = sorted(folder.glob(f"{name}.svg"), key=lambda file: (file.stem.startswith("graph-"), file.stem))
    return Named({file.stem: Figure(file) for file in files})


def _table(title: str, frame: pd.DataFrame) -> str:
    note = frame.attrs.get("note", "")
    return (
        (f"<h4>{escape(title)}</h4>" if title else "")
        + frame.astype(object).where(frame.notna(), "").to_html(index=False, border=0, max_rows=60)
        + (f"<p><small>{escape(note)}</small></p>" if note else "")
    )


def _pictures(figures: dict[str, Figure]) -> str:
    """The figures as images, not inline, so that one figure's style does not affect another's."""

    def picture(name: str, figure: Figure) -> str:
        coded = base64.b64encode(figure.path.read_bytes()).decode()
        return f'<p><img alt="{escape(name)}" style="max-width: 100%" src="data:image/svg+xml;base64,{coded}"></p>'

    return "".join(picture(name, figure) for name, figure in figures.items())


def _folded(summary: str, content: str) -> str:
    return f"<details><summary>{escape(summary)}</summary>{content}</details>" if content else ""
