"""Arguments of Skein's commands, from those of Python's functions."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from .errors import SkeinError
from .scenario import Scenario
from .untraceable import shown


class WrittenFile(str):
    """The path of the file of a scenario in Python, which knows the places in Python of its lines."""

    places: dict[int, str]

    def explained(self, complaint: str) -> str:
        """A command's error message, with places in Python in place of the file and its lines."""

        def placed(found: re.Match[str]) -> str:
            number = found[1]
            return f"{self.places.get(int(number), '')}: ".removeprefix(": ") if number else ""

        file = rf"(?:--scenario: )?{re.escape(self)}: (?:line (\d+): )?(?:by its defaults: )?"
        return re.sub(file, placed, complaint).replace(": agents: ", ": vehicles(): ")


def scenario_file(scenario: Scenario | str | os.PathLike[str] | None, folder: Path) -> str | None:
    """The value of ``--scenario``; a scenario written in Python is saved as a file in the folder."""
    if isinstance(scenario, type) and issubclass(scenario, Scenario):
        raise TypeError(f"expected a scenario, such as {scenario.__name__}(), got the class {scenario.__name__}")
    if not isinstance(scenario, Scenario):
        if scenario is not None and not isinstance(scenario, (str, os.PathLike)):
            raise TypeError(f"expected a scenario, its file or its name, got {shown(scenario)}")
        return None if scenario is None else os.fspath(scenario)
    text, places = scenario._file()
    file = folder / f"{scenario.title}.scenario"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise SkeinError(f"out: cannot write to {folder}: {error.strerror}") from None
    written = WrittenFile(file)
    written.places = places
    return written


@contextlib.contextmanager
def folder(out: str | os.PathLike[str] | None) -> Iterator[Path]:
    """The folder of a command's files: without `out` a new temporary one.

    If the command fails, that is removed, or named if it holds recordings or a search.
    """
    if out is not None:
        yield Path(out)
        return
    made = Path(tempfile.mkdtemp(prefix="skein-"))
    try:
        yield made
    except Exception as error:
        if any(made.glob("*.duckdb")) or (made / "search.json").exists():
            error.args = (f"{error}\nwhat was written before is in {made}",)
        else:
            shutil.rmtree(made, ignore_errors=True)
        raise


def renamed(function: str, options: Mapping[str, Any], **names: str) -> None:
    """Refuses options of the command for which the function uses another name."""
    for option, name in names.items():
        if option in options:
            raise TypeError(f"{function}() takes {name}, not {option}")


def some(name: str, value: Any) -> list[Any]:
    """One or more values; a command would take none for its default."""
    several = _several(value)
    if not several:
        raise ValueError(f"{name}: expected one or more, got none")
    return several


def _several(value: Any) -> list[Any]:
    is_one = isinstance(value, (str, os.PathLike)) or not isinstance(value, Iterable)
    return [value] if is_one else list(value)


def flags(options: Mapping[str, Any]) -> list[str]:
    """Options as words of the command line; ``period_ms=50`` is ``--period 50ms``."""
    words: list[str] = []
    for name, value in options.items():
        unit = re.search(r"_(ms|s)$", name)
        for one in _several(value):
            if unit and isinstance(one, Real) and not isinstance(one, bool):
                words += [_option(name[: unit.start()]), f"{float(one):.12g}{unit[1]}"]
            elif one is True:
                words.append(_option(name))
            elif one is not None and one is not False:
                words += [_option(name), os.fspath(one) if isinstance(one, os.PathLike) else str(one)]
    return words


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def planned(
    loop: Any, link: Any, duration_s: float | None, scenario: object, options: Mapping[str, Any]
) -> dict[str, Any]:
    """The values of ``--loop``, ``--link`` and ``--duration``; beside a configuration only those that are given."""
    is_configured = options.get("config") is not None
    if not is_configured:
        loop, link = "stream" if loop is None else loop, "direct" if link is None else link
    if duration_s is not None:
        duration = milliseconds("duration_s", duration_s, "s")
    else:
        has_own = is_configured or isinstance(scenario, Scenario) or str(scenario).endswith(".scenario")
        duration = None if has_own else "60000ms"
    return {"loop": some("loop", loop), "link": some("link", link), "duration": duration}


def milliseconds(name: str, time: float, unit: str) -> str:
    if not isinstance(time, Real) or isinstance(time, bool):
        raise TypeError(f"{name}: expected a number of {unit}, got {time!r}")
    return f"{float(time) * {'s': 1000, 'ms': 1}[unit]:.12g}ms"


def key(name: str) -> str:
    return name.replace("_", "-")


def texts(settings: Mapping[str, Any] | None) -> dict[str, str]:
    """Settings of a scenario as Skein names and reads them."""
    if settings is not None and not isinstance(settings, Mapping):
        raise TypeError(f"settings: expected names with values, such as {{'ring_m': 6}}, got {settings!r}")
    return {
        key(name): str(value).lower() if isinstance(value, (bool, np.bool_)) else str(value)
        for name, value in (settings or {}).items()
    }


def set_to(settings: Mapping[str, Any] | None) -> list[str]:
    """The values of ``--set``."""
    return [f"{name}={value}" for name, value in texts(settings).items()]


def varied(vary: Mapping[str, tuple[float, float]] | None) -> list[str]:
    """The values of ``--vary``."""
    if vary is not None and not isinstance(vary, Mapping):
        raise TypeError(f"vary: expected names with bounds, such as {{'ring_m': (4, 12)}}, got {vary!r}")
    words = []
    for name, bounds in (vary or {}).items():
        try:
            least, most = (float(one) for one in bounds)
        except (TypeError, ValueError):
            raise TypeError(
                f"vary: expected the least and the greatest value of {name}, such as (1, 10), got {bounds!r}"
            ) from None
        words.append(f"{key(name)}={least:.12g}..{most:.12g}")
    return words
