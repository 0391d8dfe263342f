"""Scenarios in Python: vehicles, their policies, and measures.

A scenario is a dataclass. Its parameters that are floats are settings, which ``settings={"ring-m": 6}`` and
``vary={"ring-m": (4, 12)}`` change without Python; its other fields are fixed when it is traced. What its
``__post_init__``, properties and methods compute from settings is traced. A vehicle's policy is a method or function;
`skein_uav.formula` lists the functions that it may call.

Examples
--------
>>> from dataclasses import dataclass
>>> from skein_uav.formula import atan2
>>> from skein_uav.scenario import Scenario, Series, Vehicle, setting
>>> @dataclass
... class Chase(Scenario):
...     pace_mps: float = setting(6.0, "speed of the chaser")
...     def vehicles(self):
...         return [
...             Vehicle("Runner", lambda seen: seen.along(0.5, 4.0), start_ned_m=(20, 0, -5)),
...             Vehicle("Chaser", self.chase, start_ned_m=(0, 0, -5)),
...         ]
...     def chase(self, seen):
...         runner = seen.vehicles[0]
...         return seen.along(atan2(runner.east_m - seen.own.east_m, runner.north_m - seen.own.north_m), self.pace_mps)
...     def gap(self, now):
...         return now.distance_m(0, 1)
...     def measures(self):
...         return [Series("gap", "m", self.gap).mean("mean gap")]
>>> print(Chase().text().splitlines()[0])
skein-scenario 1
"""

from __future__ import annotations

import dataclasses
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .actions import Action, Yaw, along, attitude, hover, land, position, turn, velocity, velocity_at
from .closures import bound
from .formula import atan2, hypot, minimum, smallest, where
from .places import plainly
from .untraceable import explained, refused

__all__ = [
    "Action",
    "Known",
    "Limit",
    "Measure",
    "Moment",
    "Observation",
    "Scenario",
    "Series",
    "Vehicle",
    "Yaw",
    "along",
    "attitude",
    "hover",
    "land",
    "position",
    "setting",
    "turn",
    "velocity",
    "velocity_at",
]


_FUNCTIONS = ("attitude", "hover", "land", "position", "turn", "velocity", "velocity_at")


def setting(default: float, meaning: str) -> Any:
    """A field of a scenario: its default, and its meaning with the unit."""
    return field(default=default, metadata={"meaning": meaning})


@dataclass(frozen=True)
class Known:
    """The known state of a vehicle, in the world frame: north, east, down.

    Attributes
    ----------
    north_m, east_m, down_m, north_mps, east_mps, down_mps : float
        Estimated position and velocity.
    heading_rad : float
        The last commanded heading, as far as known; before the first command, that of the start. Not in measures.
    age_s : float
        Age of the reading behind the estimate, s. Not in measures.
    """

    north_m: Any = 0.0
    east_m: Any = 0.0
    down_m: Any = 0.0
    north_mps: Any = 0.0
    east_mps: Any = 0.0
    down_mps: Any = 0.0
    heading_rad: Any = 0.0
    age_s: Any = 0.0

    def distance_m(self, other: Known) -> Any:
        """Distance in the horizontal plane."""
        return hypot(self.north_m - other.north_m, self.east_m - other.east_m)


@dataclass(frozen=True)
class Moment:
    """All vehicles at one moment of a flight, for measures and `Scenario.is_over`."""

    vehicles: Sequence[Known]
    elapsed_s: Any = 0.0

    def distance_m(self, one: int, other: int) -> Any:
        """Distance between two vehicles in the horizontal plane."""
        return self.vehicles[one].distance_m(self.vehicles[other])


@dataclass(frozen=True)
class Observation:
    """The input of a policy's decision.

    Attributes
    ----------
    place : int
        Index of the deciding vehicle in the team.
    vehicles : sequence of Known
    elapsed_s : float
        Time since this vehicle's previous decision; 0 at the first. Integrate over it, and never count decisions.
    acts_in_s : float
        Predicted time until the command acts; 0 if the loop does not predict.
    cruise_mps : float
        The speed that the scenario gives the vehicle.
    start_down_m : float
        Down coordinate of its start.
    rivals : sequence of int
        Indices of the vehicles of another role, or of all others if there are none.
    time_s : float
        Time of the flight at which the command acts, as far as the loop knows: the present plus `acts_in_s`, since
        this vehicle was first read.
    """

    place: int
    vehicles: Sequence[Known]
    elapsed_s: Any = 0.1
    acts_in_s: Any = 0.0
    cruise_mps: Any = 5.0
    start_down_m: Any = -5.0
    rivals: Sequence[int] | None = None
    time_s: Any = 0.0

    def __getattr__(self, name: str) -> Any:
        if name in _FUNCTIONS:
            raise AttributeError(f"{name} is no method of an observation; import it from skein_uav.scenario")
        known = ", ".join(one for one in dir(self) if not one.startswith("_"))
        raise AttributeError(f"an observation has no {name}; it has {known}")

    @property
    def own(self) -> Known:
        return self.vehicles[self.place]

    @property
    def others(self) -> list[Known]:
        return [one for place, one in enumerate(self.vehicles) if place != self.place]

    @property
    def opponent(self) -> Known:
        """The nearest rival in the plane; of several, the first. The only vehicle has none."""
        rivals = self.rivals or [place for place in range(len(self.vehicles)) if place != self.place]
        if not rivals:
            raise refused("it seeks an opponent of the only vehicle")
        return smallest([self.vehicles[one] for one in rivals], self.own.distance_m)

    def along(self, heading_rad: Any, speed_mps: Any, yaw: Yaw = Yaw()) -> Action:
        """Flies on a heading at the altitude of the start."""
        return along(heading_rad, speed_mps, self.start_down_m, yaw)

    def towards(self, north_mps: Any, east_mps: Any, most_mps: Any) -> Any:
        """Flies with a velocity, limited to a maximum speed, at the altitude of the start."""
        speed = hypot(north_mps, east_mps)
        still = self.along(self.own.heading_rad, 0.0)
        return where(speed < 1e-9, still, self.along(atan2(east_mps, north_mps), minimum(speed, most_mps)))


@dataclass
class Vehicle:
    """A vehicle and its policy.

    Attributes
    ----------
    name : str
    policy : callable
        Maps an `Observation` to an action, or, with `memory`, an observation and the memory to an action and the next
        memory. Its closure keeps the values that it has now, also in a loop.
    start_ned_m : tuple of float
    speed_mps : float
        The value of `Observation.cruise_mps`.
    heading_rad : float
        Heading at the start.
    role : str
        Any word; vehicles of one role are not rivals.
    memory : optional
        The memory before the first decision: a float or a bool, or a dataclass, tuple, list or array of them.
    wants : callable, optional
        Maps an observation and a time ahead, s, to the position wanted then, north and east, m: the input of planners,
        with `most_mps` and `least_apart_m`.
    """

    name: str
    policy: Callable[..., Any]
    start_ned_m: tuple[Any, Any, Any] = (0.0, 0.0, -5.0)
    speed_mps: Any = 5.0
    heading_rad: Any = 0.0
    role: str = "vehicle"
    memory: Any = None
    wants: Callable[..., Any] | None = None
    most_mps: Any = None
    least_apart_m: Any = 0.0

    def __post_init__(self) -> None:
        self.policy, self.wants = bound(self.policy), bound(self.wants)


@dataclass(frozen=True)
class Measure:
    """A series reduced to one number."""

    name: str
    of: Series
    reduction: str
    window: tuple[str, Any] | None = None


@dataclass(frozen=True)
class Series:
    """A quantity over time: the report draws it, and measures reduce it.

    Searches fly with SIMD by series of positions and `elapsed_s` alone.

    Attributes
    ----------
    name, unit : str
    of : callable
        Maps a `Moment` to a number.
    bound : tuple of str and float, optional
        A line to compare it with.
    """

    name: str
    unit: str
    of: Callable[[Moment], Any]
    bound: tuple[str, Any] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "of", bound(self.of))

    def mean(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        return self._reduced(name, "mean", last_s, after_s)

    def rms(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        return self._reduced(name, "rms", last_s, after_s)

    def sd(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        return self._reduced(name, "sd", last_s, after_s)

    def least(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        return self._reduced(name, "least", last_s, after_s)

    def most(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        return self._reduced(name, "most", last_s, after_s)

    def least_at(self, name: str) -> Measure:
        """Time of the least value, s."""
        return self._reduced(name, "least-at")

    def most_at(self, name: str) -> Measure:
        """Time of the greatest value, s."""
        return self._reduced(name, "most-at")

    def time_positive(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        """Total time above 0, s."""
        return self._reduced(name, "time-positive", last_s, after_s)

    def entries(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        """How many times it comes to be above 0."""
        return self._reduced(name, "entries", last_s, after_s)

    def first_positive(self, name: str) -> Measure:
        """First time above 0, s."""
        return self._reduced(name, "first-positive")

    def stays_positive(self, name: str) -> Measure:
        """Time from which it stays above 0 until the end, s; no value if it ends otherwise."""
        return self._reduced(name, "stays-positive")

    def _reduced(self, name: str, by: str, last_s: Any = None, after_s: Any = None) -> Measure:
        if last_s is not None and after_s is not None:
            raise ValueError("expected last_s or after_s, got both")
        window = ("last", last_s) if last_s is not None else ("after", after_s) if after_s is not None else None
        return Measure(name, self, by, window)


@dataclass(frozen=True)
class Limit:
    """A condition that must hold; violations are counted, listed and shown."""

    kind: str
    numbers: tuple[Any, ...]

    @staticmethod
    def separation(least_m: Any) -> Limit:
        return Limit("separation", (least_m,))

    @staticmethod
    def horizontal_separation(least_m: Any) -> Limit:
        return Limit("horizontal-separation", (least_m,))

    @staticmethod
    def floor(altitude_m: Any) -> Limit:
        return Limit("floor", (altitude_m,))

    @staticmethod
    def ceiling(altitude_m: Any) -> Limit:
        return Limit("ceiling", (altitude_m,))

    @staticmethod
    def speed(most_mps: Any) -> Limit:
        return Limit("speed", (most_mps,))

    @staticmethod
    def circle(north_m: Any, east_m: Any, radius_m: Any) -> Limit:
        return Limit("circle", (north_m, east_m, radius_m))

    @staticmethod
    def polygon(corners_m: Sequence[tuple[Any, Any]]) -> Limit:
        return Limit("polygon", tuple(number for corner in corners_m for number in corner))


class Scenario:
    """A task for a team; inherit from it, as a dataclass.

    Attributes
    ----------
    name : str
        Name in settings and recordings, in any case and with spaces; by default the class's name.
    duration_s : float
        Duration of a flight, s.
    note : str
        How to read the measures, for the report.
    scene : str
        Scene of the built-in simulator.
    """

    name = ""
    duration_s: Any = 60.0
    note = ""
    scene = "empty"

    _given: tuple[tuple[Any, ...], dict[str, Any]]

    def __new__(cls, *args: Any, **options: Any) -> Any:
        __tracebackhide__ = True
        for one in cls.__mro__[: cls.__mro__.index(Scenario)]:
            settings = _undeclared(one)
            if settings:
                names = ", ".join(settings)
                raise TypeError(f"{one.__name__} has settings ({names}): write @dataclass above the class")
        made = super().__new__(cls)
        made.__dict__["_given"] = args, options
        return made

    @property
    def title(self) -> str:
        """The name in lower-case letters, with dashes between words."""
        return "-".join(re.findall(r"\w+", (self.name or _words(type(self).__name__)).lower().replace("_", " ")))

    def vehicles(self) -> Sequence[Vehicle]:
        raise NotImplementedError(f"expected a method vehicles() of {type(self).__name__}, got none")

    def limits(self) -> Sequence[Limit]:
        return []

    def series(self) -> Sequence[Series]:
        """Quantities that the report draws in addition to those of the measures."""
        return []

    def measures(self) -> Sequence[Measure]:
        return []

    def is_over(self, now: Moment) -> Any:
        """Whether the flight ends before its duration."""
        return False

    @plainly
    def text(self) -> str:
        """The scenario as data, which ``./skein fly --scenario FILE.scenario`` and all other commands accept.

        Raises
        ------
        Untraceable
            If a function's computation cannot be traced; with its line, and what to write instead.
        """
        return self._file()[0]

    def _file(self) -> tuple[str, dict[int, str]]:
        """The text, and the places in Python of its lines, by their numbers."""
        from .written import Writer

        try:
            return Writer(self).file()
        except (TypeError, ValueError, AttributeError) as error:
            if (better := explained(error)) is None:
                raise
            raise better.with_traceback(error.__traceback__) from None

    @plainly
    def write(self, file: str | os.PathLike[str]) -> Path:
        """Writes `text` to a file, whose name ends in ``.scenario``."""
        path = Path(file)
        if path.suffix != ".scenario":
            raise ValueError(f"expected a file that ends in .scenario, got {path}")
        path.write_text(self.text(), encoding="utf-8")
        return path


def _undeclared(of: type) -> list[str]:
    """Names of the settings of a class that is no dataclass."""
    if "__dataclass_fields__" in vars(of):
        return []
    fields = [name for name, value in vars(of).items() if isinstance(value, dataclasses.Field)]
    typed = vars(of).get("__annotations__", {}).items()
    known = (*fields, *vars(Scenario))
    return fields + [name for name, kind in typed if kind in (float, "float") and name not in known]


def _words(name: str) -> str:
    return re.sub(r"(?<=.)([A-Z])", r"-\1", name).lower()
