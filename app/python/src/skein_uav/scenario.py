"""Scenarios in Python: who flies, by which policies, measured how.

A scenario is a dataclass. Its fields that are floats are settings, which ``settings={"ring-m": 6}`` and
``vary={"ring-m": (4, 12)}`` change without Python; its other fields are fixed when it is written down. A vehicle's
policy is a method or function; `skein_uav.formula` has what it may call.

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

import copy
import dataclasses
import math
import os
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import formula
from .formula import Condition, Graph, Number, Untraceable, atan2, hypot, logical_and, minimum, smallest, where

__all__ = [
    "Action",
    "Known",
    "Limit",
    "Measure",
    "Observation",
    "Scenario",
    "Series",
    "Vehicle",
    "Yaw",
    "attitude",
    "hover",
    "land",
    "position",
    "setting",
    "turn",
    "velocity",
    "velocity_at",
]


def setting(default: float, meaning: str) -> Any:
    """A field of a scenario: its default, and its meaning with the unit."""
    return field(default=default, metadata={"meaning": meaning})


@dataclass(frozen=True)
class Yaw:
    """How an action controls the yaw: `Yaw()` keeps it, `Yaw.forward()` looks ahead."""

    kind: str = "still"
    number: Any = None

    @staticmethod
    def forward() -> Yaw:
        return Yaw("forward")

    @staticmethod
    def towards(heading_rad: Any) -> Yaw:
        return Yaw("towards", heading_rad)

    @staticmethod
    def turning(rad_per_s: Any) -> Yaw:
        return Yaw("turning", rad_per_s)


@dataclass(frozen=True)
class Action:
    """What a vehicle does until the next decision.

    Attributes
    ----------
    kind : str
        ``along``, ``velocity-at``, ``velocity``, ``position``, ``turn``, ``attitude``, ``hover`` or ``land``.
    numbers : tuple
        Those of the kind, as the function of its name takes them.
    yaw : Yaw
    """

    kind: str
    numbers: tuple[Any, ...] = ()
    yaw: Yaw = Yaw()

    def _where(self, condition: Condition, a: Any, b: Any) -> Any:
        return _Choice(_cases(a, True), _cases(b, True), condition)


@dataclass(frozen=True)
class _Choice:
    """One of two actions, by a condition."""

    a: list[tuple[Any, Action]]
    b: list[tuple[Any, Action]]
    condition: Condition

    def _where(self, condition: Condition, a: Any, b: Any) -> Any:
        return _Choice(_cases(a, True), _cases(b, True), condition)


def _cases(of: Any, when: Any) -> list[tuple[Any, Action]]:
    """Actions with their conditions; the first that holds is meant, and the last one holds."""
    if isinstance(of, _Choice):
        first = [(logical_and(of.condition, condition), action) for condition, action in of.a]
        return first + of.b
    if not isinstance(of, Action):
        raise formula.refused(f"where takes two actions, came {type(of).__name__}")
    return [(when, of)]


def along(heading_rad: Any, speed_mps: Any, down_m: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies on a heading at an altitude; `Observation.along` is at that of the start."""
    return Action("along", (heading_rad, speed_mps, down_m), yaw)


def velocity_at(north_mps: Any, east_mps: Any, down_m: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies by a horizontal velocity at an altitude."""
    return Action("velocity-at", (north_mps, east_mps, down_m), yaw)


def velocity(north_mps: Any, east_mps: Any, down_mps: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies by a velocity in space."""
    return Action("velocity", (north_mps, east_mps, down_mps), yaw)


def position(north_m: Any, east_m: Any, down_m: Any, speed_mps: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies to a place, no faster than a speed, and stays there."""
    return Action("position", (north_m, east_m, down_m, speed_mps), yaw)


def turn(yaw: Yaw) -> Action:
    """Stays, and turns."""
    return Action("turn", (), yaw)


def attitude(roll_rad: Any, pitch_rad: Any, yaw_rad: Any, thrust: Any) -> Action:
    """Holds three angles, by a share of full thrust from 0 to 1."""
    return Action("attitude", (roll_rad, pitch_rad, yaw_rad, thrust))


def hover() -> Action:
    """Stays where it is."""
    return Action("hover")


def land() -> Action:
    """Descends until it stands on the ground."""
    return Action("land")


@dataclass(frozen=True)
class Known:
    """What is known of a vehicle. World frame, north, east and down.

    Attributes
    ----------
    north_m, east_m, down_m, north_mps, east_mps, down_mps : float
        Estimated position and velocity.
    heading_rad : float
        Commanded last, as far as known; before the first command, that of the start. Not in measures.
    age_s : float
        Of the reading behind it. Not in measures.
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
    """What a policy decides by.

    Attributes
    ----------
    place : int
        The own one in the team.
    vehicles : sequence of Known
    elapsed_s : float
        Since the own last decision; 0 at the first. Integrate over it, and never count decisions.
    acts_in_s : float
        Predicted time until the command acts; 0 where nothing is predicted.
    cruise_mps : float
        The speed that the scenario gives the vehicle.
    start_down_m : float
        Of its start.
    rivals : sequence of int
        Vehicles of another role, or all others where there are none.
    """

    place: int
    vehicles: Sequence[Known]
    elapsed_s: Any = 0.1
    acts_in_s: Any = 0.0
    cruise_mps: Any = 5.0
    start_down_m: Any = -5.0
    rivals: Sequence[int] | None = None

    @property
    def own(self) -> Known:
        return self.vehicles[self.place]

    @property
    def others(self) -> list[Known]:
        return [one for place, one in enumerate(self.vehicles) if place != self.place]

    @property
    def opponent(self) -> Known:
        """The nearest rival in the plane, the first of equals."""
        rivals = self.rivals or [place for place in range(len(self.vehicles)) if place != self.place] or [self.place]
        return smallest([self.vehicles[one] for one in rivals], self.own.distance_m)

    def along(self, heading_rad: Any, speed_mps: Any, yaw: Yaw = Yaw()) -> Action:
        """Flies on a heading at the altitude of the start."""
        return along(heading_rad, speed_mps, self.start_down_m, yaw)

    def towards(self, north_mps: Any, east_mps: Any, most_mps: Any) -> Any:
        """Flies by a velocity, limited to a greatest speed, at the altitude of the start."""
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
        From an `Observation` to an action, or, with `memory`, from an observation and the memory to an action and the
        next memory.
    start_ned_m : tuple of float
    speed_mps : float
        What `Observation.cruise_mps` is.
    heading_rad : float
        At the start.
    role : str
        Any word; vehicles of one role are no rivals.
    memory : optional
        Before the first decision: a float or a bool, or a dataclass, tuple or list of them.
    wants : callable, optional
        From an observation and a time ahead, s, to the place wanted then, north and east, m: what planners need, with
        `most_mps` and `least_apart_m`.
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

    Searches optimise measures of positions by SIMD.

    Attributes
    ----------
    name, unit : str
    of : callable
        From a `Moment` to a number.
    bound : tuple of str and float, optional
        A line to compare it with.
    """

    name: str
    unit: str
    of: Callable[[Moment], Any]
    bound: tuple[str, Any] | None = None

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
        """When it was least, s."""
        return self._reduced(name, "least-at")

    def most_at(self, name: str) -> Measure:
        """When it was greatest, s."""
        return self._reduced(name, "most-at")

    def time_positive(self, name: str, *, last_s: Any = None, after_s: Any = None) -> Measure:
        """How long it was above 0, s."""
        return self._reduced(name, "time-positive", last_s, after_s)

    def first_positive(self, name: str) -> Measure:
        """When it was first above 0, s."""
        return self._reduced(name, "first-positive")

    def _reduced(self, name: str, by: str, last_s: Any = None, after_s: Any = None) -> Measure:
        if last_s is not None and after_s is not None:
            raise ValueError("expected last_s or after_s, came both")
        window = ("last", last_s) if last_s is not None else ("after", after_s) if after_s is not None else None
        return Measure(name, self, by, window)


@dataclass(frozen=True)
class Limit:
    """What must not happen; violations are counted, listed and shown."""

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
        In settings and recordings; the class's name in words unless set.
    duration_s : float
        Of a flight.
    note : str
        How to read the measures, for the report.
    scene : str
        Of the built-in simulator.
    """

    name = ""
    duration_s: Any = 60.0
    note = ""
    scene = "empty"

    @property
    def title(self) -> str:
        """The name, of small letters."""
        return self.name or _words(type(self).__name__)

    def vehicles(self) -> Sequence[Vehicle]:
        raise NotImplementedError("a scenario has a method vehicles()")

    def limits(self) -> Sequence[Limit]:
        return []

    def series(self) -> Sequence[Series]:
        """Quantities that the report draws, beside those of the measures."""
        return []

    def measures(self) -> Sequence[Measure]:
        return []

    def is_over(self, now: Moment) -> Any:
        """Whether the flight ends before its duration."""
        return False

    def text(self) -> str:
        """The scenario as data, which ``./skein fly --scenario FILE.scenario`` and all other commands take.

        Raises
        ------
        Untraceable
            If a function does what cannot be written down; with its line, and what to write instead.
        """
        return _Writer(self).text()

    def write(self, file: str | os.PathLike[str]) -> Path:
        """Writes `text` to a file, whose name ends in ``.scenario``."""
        path = Path(file)
        if path.suffix != ".scenario":
            raise ValueError(f"expected a file that ends in .scenario, came {path}")
        path.write_text(self.text(), encoding="utf-8")
        return path


def _words(name: str) -> str:
    return re.sub(r"(?<=.)([A-Z])", r"-\1", name).lower()


def _key(name: str) -> str:
    return name.lower().replace("_", "-")


class _Writer:
    """Calls a scenario's functions once, and writes down what they compute."""

    def __init__(self, scenario: Scenario) -> None:
        self.graph = Graph()
        self.lines: list[tuple[Any, ...]] = []
        self.name = scenario.title
        self.note, self.scene = scenario.note, scenario.scene
        self.settings: list[tuple[str, float, str]] = []
        self.scenario = copy.copy(scenario)
        for each in dataclasses.fields(scenario) if dataclasses.is_dataclass(scenario) else ():  # type: ignore[arg-type]
            value = getattr(scenario, each.name)
            if isinstance(value, float) or (isinstance(value, int) and each.type in (float, "float")):
                value = float(value)
                if not math.isfinite(value):
                    raise ValueError(f"{each.name}: expected a finite number, came {value}")
                key = _key(each.name)
                self.settings.append((key, value, each.metadata.get("meaning", "")))
                object.__setattr__(self.scenario, each.name, self.graph.leaf("setting", key))

    def text(self) -> str:
        vehicles = list(self.scenario.vehicles())
        if not all(isinstance(one, Vehicle) for one in vehicles) or not vehicles:
            raise ValueError("expected a list of Vehicle from vehicles(), one or more")
        self.add("duration", self.fixed(self.scenario.duration_s, "duration_s"))
        for place, vehicle in enumerate(vehicles):
            self.vehicle(place, vehicle, vehicles)
        for limit in self.scenario.limits():
            self.add("limit", limit.kind, *(self.fixed(one, "a limit") for one in limit.numbers))
        self.drawn(len(vehicles))
        over = self.scenario.is_over(self.moment(len(vehicles), object()))
        if over is not False:
            if not isinstance(over, Condition):
                raise Untraceable(f"{_place(self.scenario.is_over)}: expected a condition from is_over, came {_came(over)}")
            self.add("over", over)
        return self.file()

    def add(self, *words: Any) -> None:
        self.lines.append(words)

    def number(self, value: Any, what: str) -> Number:
        if isinstance(value, Number):
            return value
        if isinstance(value, Condition) or isinstance(value, bool) or not isinstance(value, (int, float)):
            if hasattr(value, "item") and getattr(value, "shape", None) == ():
                return self.number(value.item(), what)
            raise Untraceable(f"expected a number as {what}, came {_came(value)}")
        if not math.isfinite(value):
            raise Untraceable(f"expected a finite number as {what}, came {value}")
        return formula.constant(self.graph, float(value))

    def fixed(self, value: Any, what: str) -> Number:
        number = self.number(value, what)
        if number.of is not None:
            raise Untraceable(f"expected a number of settings alone as {what}, came one of a decision")
        return number

    def known(self, place: int, of: object) -> Known:
        words = ("north", "east", "down", "north-mps", "east-mps", "down-mps", "heading", "age")
        return Known(*(self.graph.leaf(word, str(place), of) for word in words))

    def moment(self, count: int, of: object) -> Moment:
        return Moment([self.known(place, of) for place in range(count)], self.graph.leaf("elapsed", "", of))

    def seen(self, place: int, vehicles: Sequence[Vehicle], of: object) -> Observation:
        others = [one for one in range(len(vehicles)) if one != place]
        rivals = [one for one in others if _role(vehicles[one].role) != _role(vehicles[place].role)]
        leaves = (self.graph.leaf(word, "", of) for word in ("elapsed", "acts-in", "cruise", "start-down"))
        known = [self.known(one, of) for one in range(len(vehicles))]
        return Observation(place, known, *leaves, rivals=rivals or others or [place])

    def vehicle(self, place: int, vehicle: Vehicle, all_: Sequence[Vehicle]) -> None:
        if len(vehicle.start_ned_m) != 3:
            raise ValueError(f"{vehicle.name}: expected north, east and down as its start, came {vehicle.start_ned_m}")
        what = f"the {{}} of {vehicle.name}"
        self.add(
            "vehicle",
            _quoted(vehicle.name),
            _quoted(vehicle.role),
            self.fixed(vehicle.speed_mps, what.format("speed")),
            *(self.fixed(one, what.format("start")) for one in vehicle.start_ned_m),
            self.fixed(vehicle.heading_rad, what.format("heading")),
        )
        of = object()
        seen = self.seen(place, all_, of)
        where_ = f"{_place(vehicle.policy)}: the policy of {vehicle.name}"
        starts: list[Any] = _leaves(vehicle.memory, where_) if vehicle.memory is not None else []
        if vehicle.memory is None:
            decided, after = vehicle.policy(seen), []
        else:
            held = iter(
                [
                    self.graph.leaf("memory", str(number), of) > 0.5
                    if isinstance(start, bool)
                    else self.graph.leaf("memory", str(number), of)
                    for number, start in enumerate(starts)
                ]
            )
            answer = vehicle.policy(seen, _filled(vehicle.memory, held))
            if not isinstance(answer, tuple) or len(answer) != 2:
                raise Untraceable(f"{where_}: expected an action and the next memory, came {_came(answer)}")
            decided, memory = answer
            if _form(memory) != _form(vehicle.memory):
                raise Untraceable(
                    f"{where_}: expected a next memory of the form of the first, {_form(vehicle.memory)}, "
                    f"came {_form(memory)}"
                )
            after = _leaves(memory, where_)
        if not isinstance(decided, (Action, _Choice)):
            raise Untraceable(f"{where_}: expected an action, such as seen.along(heading, speed), came {_came(decided)}")
        cases = _cases(decided, True)
        for number, (condition, action) in enumerate(cases):
            when = ["when", condition] if number < len(cases) - 1 and isinstance(condition, Condition) else []
            numbers = [self.number(one, f"a number of {action.kind}, {where_}") for one in action.numbers]
            yaw: list[Any] = [] if action.yaw.kind == "still" else ["yaw", action.yaw.kind]
            if action.yaw.number is not None:
                yaw.append(self.number(action.yaw.number, f"a yaw, {where_}"))
            self.add("does", *when, action.kind, *numbers, *yaw)
            if not when:
                break
        for start, next_ in zip(starts, after, strict=True):
            self.add("remembers", self.fixed(float(start) if isinstance(start, (bool, int)) else start, "a memory"), self.remembered(next_, where_))
        if vehicle.wants is not None:
            wanted = vehicle.wants(seen, self.graph.leaf("ahead", "", of))
            if not isinstance(wanted, tuple) or len(wanted) != 2 or vehicle.most_mps is None:
                raise ValueError(f"{vehicle.name}: expected north and east from wants, and most_mps")
            self.add(
                "wants",
                *(self.number(one, "a place wanted") for one in wanted),
                self.fixed(vehicle.most_mps, "most_mps"),
                self.fixed(vehicle.least_apart_m, "least_apart_m"),
            )

    def remembered(self, value: Any, where_: str) -> Number:
        if isinstance(value, Condition):
            return where(value, 1.0, 0.0)
        return self.number(float(value) if isinstance(value, bool) else value, f"a number of the memory, {where_}")

    def drawn(self, count: int) -> None:
        measures = list(self.scenario.measures())
        series: list[Series] = []
        for one in [*(each.of for each in measures), *self.scenario.series()]:
            if one.name not in [each.name for each in series]:
                series.append(one)
        for one in series:
            value = one.of(self.moment(count, object()))
            bound = [] if one.bound is None else ["bound", _quoted(one.bound[0]), self.fixed(one.bound[1], "a bound")]
            node = self.number(value, f"the series {one.name}, {_place(one.of)}")
            self.add("series", _quoted(one.name), _quoted(one.unit), node, *bound)
            for each in measures:
                if each.of.name == one.name:
                    window = [] if each.window is None else [each.window[0], self.fixed(each.window[1], "a window")]
                    self.add("measure", _quoted(each.name), each.reduction, *window)

    def file(self) -> str:
        """The lines, with the nodes that they need, arguments first."""
        needed: set[int] = set()
        left = [word.node for words in self.lines for word in words if isinstance(word, (Number, Condition))]
        while left:
            node = left.pop()
            if node not in needed:
                needed.add(node)
                left.extend(self.graph.lines[node][1])
        places = {node: place for place, node in enumerate(sorted(needed))}
        lines = ["skein-scenario 1", f"name {self.name}"]
        if self.note:
            lines.append(f"note {_quoted(self.note)}")
        if self.scene != "empty":
            lines.append(f"scene {self.scene}")
        lines += [f"setting {key} {value!r} {_quoted(meaning)}" for key, value, meaning in self.settings]
        for node, place in places.items():
            op, args, text = self.graph.lines[node]
            lines.append(" ".join([str(place), op, *(str(places[one]) for one in args), *([text] if text else [])]))
        for words in self.lines:
            lines.append(
                " ".join(str(places[one.node]) if isinstance(one, (Number, Condition)) else str(one) for one in words)
            )
        return "\n".join(lines) + "\n"


def _role(name: str) -> str:
    """Skein's own roles are known whatever the letters' case."""
    return name.lower() if name.lower() in ("pursuer", "evader", "leader", "follower", "traveller") else name


def _quoted(text: str) -> str:
    plain = " ".join(str(text).split())
    if re.fullmatch(r"[A-Za-z][\w-]*", plain):
        return plain
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _place(function: Callable[..., Any]) -> str:
    code = getattr(getattr(function, "__func__", function), "__code__", None)
    return f"{os.path.basename(code.co_filename)}:{code.co_firstlineno}" if code else repr(function)


def _came(value: Any) -> str:
    if isinstance(value, Condition):
        return "a condition"
    return "None; is a return missing?" if value is None else f"{type(value).__name__} {value!r}"


def _leaves(memory: Any, where_: str) -> list[Any]:
    """The numbers and truth values of a memory, in order."""
    if dataclasses.is_dataclass(memory) and not isinstance(memory, type):
        return [leaf for each in dataclasses.fields(memory) for leaf in _leaves(getattr(memory, each.name), where_)]
    if isinstance(memory, (tuple, list)):
        return [leaf for each in memory for leaf in _leaves(each, where_)]
    if isinstance(memory, (int, float, Number, Condition)):
        return [memory]
    raise Untraceable(f"{where_}: expected a memory of floats, in dataclasses, tuples or lists, came {_came(memory)}")


def _filled(memory: Any, held: Any) -> Any:
    """A memory of this form with other numbers."""
    if dataclasses.is_dataclass(memory) and not isinstance(memory, type):
        parts = {each.name: _filled(getattr(memory, each.name), held) for each in dataclasses.fields(memory)}
        return dataclasses.replace(memory, **parts)
    if isinstance(memory, (tuple, list)):
        return type(memory)(_filled(each, held) for each in memory)
    return next(held)


def _form(memory: Any) -> str:
    if dataclasses.is_dataclass(memory) and not isinstance(memory, type):
        parts = ", ".join(_form(getattr(memory, each.name)) for each in dataclasses.fields(memory))
        return f"{type(memory).__name__}({parts})"
    if isinstance(memory, (tuple, list)):
        return f"{type(memory).__name__}({', '.join(map(_form, memory))})"
    return "bool" if isinstance(memory, (bool, Condition)) else "float" if isinstance(memory, (int, float, Number)) else _came(memory)
