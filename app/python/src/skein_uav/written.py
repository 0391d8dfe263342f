"""Traces a scenario: calls its functions once, with numbers that are known only in flight."""

from __future__ import annotations

import copy
import dataclasses
import math
import os
import re
import sys
from collections.abc import Callable, Sequence
from typing import Any

from .actions import Action, Choice, cases
from .formula import where
from .scenario import Known, Moment, Observation, Scenario, Series, Vehicle
from .symbols import Condition, Graph, Number, constant
from .untraceable import Untraceable


def _key(name: str) -> str:
    return name.lower().replace("_", "-")


class Writer:
    """Calls a scenario's functions once, and traces their computations."""

    def __init__(self, scenario: Scenario) -> None:
        self.graph = Graph()
        self.lines: list[tuple[Any, ...]] = []
        self.name = scenario.title
        self.note, self.scene = scenario.note, scenario.scene
        self.settings: list[tuple[str, float, str]] = []
        self.scenario = copy.copy(scenario)
        for each in dataclasses.fields(scenario) if dataclasses.is_dataclass(scenario) else ():
            value = getattr(scenario, each.name)
            if isinstance(value, float) or (isinstance(value, int) and each.type in (float, "float")):
                value = float(value)
                if not math.isfinite(value):
                    raise ValueError(f"{each.name}: expected a finite number, got {value}")
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
                place = _place(self.scenario.is_over)
                raise Untraceable(f"{place}: expected a condition from is_over, got {_came(over)}")
            self.add("over", over)
        return self.file()

    def add(self, *words: Any) -> None:
        self.lines.append(words)

    def number(self, value: Any, what: str, where_: str = "") -> Number:
        if isinstance(value, Number):
            return value
        if isinstance(value, Condition) or isinstance(value, bool) or not isinstance(value, (int, float)):
            if hasattr(value, "item") and getattr(value, "shape", None) == ():
                return self.number(value.item(), what, where_)
            instead = "; write where(condition, a, b)" if isinstance(value, Condition) else ""
            raise Untraceable(f"{_at(where_)}expected a number as {what}, got {_came(value)}{instead}")
        if not math.isfinite(value):
            raise Untraceable(f"{_at(where_)}expected a finite number as {what}, got {value}")
        return constant(self.graph, float(value))

    def fixed(self, value: Any, what: str) -> Number:
        number = self.number(value, what)
        if number.of is not None:
            raise Untraceable(f"expected a number of settings alone as {what}, got one of a decision")
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
            raise ValueError(f"{vehicle.name}: expected north, east and down as its start, got {vehicle.start_ned_m}")
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
            (decided, place_), after = _answered(vehicle.policy, seen), []
            where_ = f"{place_}: the policy of {vehicle.name}"
        else:
            held = iter(
                [
                    self.graph.leaf("memory", str(number), of) > 0.5
                    if isinstance(start, bool)
                    else self.graph.leaf("memory", str(number), of)
                    for number, start in enumerate(starts)
                ]
            )
            answer, place_ = _answered(vehicle.policy, seen, _filled(vehicle.memory, held))
            where_ = f"{place_}: the policy of {vehicle.name}"
            if not isinstance(answer, tuple) or len(answer) != 2:
                raise Untraceable(f"{where_}: expected an action and the next memory, got {_came(answer)}")
            decided, memory = answer
            if _form(memory) != _form(vehicle.memory):
                raise Untraceable(
                    f"{where_}: expected a next memory of the form of the first, {_form(vehicle.memory)}, "
                    f"got {_form(memory)}"
                )
            after = _leaves(memory, where_)
        if not isinstance(decided, (Action, Choice)):
            raise Untraceable(
                f"{where_}: expected an action, such as seen.along(heading, speed), got {_came(decided)}"
            )
        listed = cases(decided, True)
        for number, (condition, action) in enumerate(listed):
            when = ["when", condition] if number < len(listed) - 1 and isinstance(condition, Condition) else []
            numbers = [
                self.number(one, f"argument {place} of {action.kind}", where_)
                for place, one in enumerate(action.numbers, 1)
            ]
            yaw: list[Any] = [] if action.yaw.kind == "still" else ["yaw", action.yaw.kind]
            if action.yaw.number is not None:
                yaw.append(self.number(action.yaw.number, "a yaw", where_))
            self.add("does", *when, action.kind, *numbers, *yaw)
            if not when:
                break
        for start, next_ in zip(starts, after, strict=True):
            first = float(start) if isinstance(start, bool) else start
            self.add("remembers", self.fixed(first, "a memory"), self.remembered(next_, where_))
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
        return self.number(float(value) if isinstance(value, bool) else value, "a number of the memory", where_)

    def drawn(self, count: int) -> None:
        measures = list(self.scenario.measures())
        series: list[Series] = []
        for one in [*(each.of for each in measures), *self.scenario.series()]:
            if one.name not in [each.name for each in series]:
                series.append(one)
        for one in series:
            value = one.of(self.moment(count, object()))
            bound = [] if one.bound is None else ["bound", _quoted(one.bound[0]), self.fixed(one.bound[1], "a bound")]
            node = self.number(value, f"the series {one.name}", _place(one.of))
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
    """Skein's own roles are recognised in any letter case."""
    return name.lower() if name.lower() in ("pursuer", "evader", "leader", "follower", "traveller") else name


def _quoted(text: str) -> str:
    plain = " ".join(str(text).split())
    if re.fullmatch(r"[A-Za-z][\w-]*", plain):
        return plain
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _place(function: Callable[..., Any], line: int | None = None) -> str:
    code = _code(function)
    return f"{os.path.basename(code.co_filename)}:{line or code.co_firstlineno}" if code else repr(function)


def _code(function: Callable[..., Any]) -> Any:
    return getattr(getattr(function, "__func__", function), "__code__", None)


def _answered(function: Callable[..., Any], *arguments: Any) -> tuple[Any, str]:
    """A function's answer, and the line that returned it."""
    line: int | None = None

    def note(frame: Any, event: str, _: Any) -> None:
        nonlocal line
        if event == "return" and frame.f_code is _code(function):
            line = frame.f_lineno

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        answer = function(*arguments)
    finally:
        sys.setprofile(before)
    return answer, _place(function, line)


def _at(where_: str) -> str:
    return f"{where_}: " if where_ else ""


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
    raise Untraceable(f"{where_}: expected a memory of floats, in dataclasses, tuples or lists, got {_came(memory)}")


def _filled(memory: Any, held: Any) -> Any:
    """A memory of this form with other values."""
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
    if isinstance(memory, (bool, Condition)):
        return "bool"
    return "float" if isinstance(memory, (int, float, Number)) else _came(memory)
