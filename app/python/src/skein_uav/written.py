"""Traces a scenario: calls its functions once, with numbers that are known only in flight."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from .actions import Action, Choice, Yaw, cases
from .answers import answered
from .formula import where
from .kept import unchanged
from .lines import Lines, quoted
from .memory import filled, form, leaves
from .places import place_of
from .scenario import Known, Limit, Measure, Moment, Observation, Scenario, Series, Vehicle
from .settings import symbolic
from .symbols import Condition, Graph, Number, constant
from .untraceable import Untraceable, refused, shown


class Writer:
    """Calls a scenario's functions once, and traces their computations."""

    def __init__(self, scenario: Scenario) -> None:
        self.graph = Graph()
        self.lines = Lines(self.graph)
        self.name = scenario.title
        if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", self.name):
            what = f"the name {scenario.name!r}" if scenario.name else f"the class {type(scenario).__name__}"
            raise ValueError(f"expected a name of Latin letters, such as name = 'my-patrol', got {what}")
        self.scenario, self.settings = symbolic(scenario, self.graph)

    def file(self) -> tuple[str, dict[int, str]]:
        """The text of the file, and the places in Python of its lines, by their numbers."""
        vehicles = self.listed("vehicles", Vehicle)
        at = place_of(self.scenario.vehicles)
        if not vehicles:
            raise ValueError(f"{at}: expected a list of Vehicle from vehicles(), one or more")
        self.lines.at = f"the scenario {self.name}"
        self.lines.add("duration", self.fixed(self.scenario.duration_s, "duration_s"))
        for place, vehicle in enumerate(vehicles):
            if vehicle.name in [one.name for one in vehicles[:place]]:
                raise ValueError(f"{at}: expected a name of its own for each vehicle, got {vehicle.name!r} twice")
            self.vehicle(place, vehicle, vehicles)
        self.lines.at = place_of(self.scenario.limits)
        for limit in self.listed("limits", Limit):
            self.lines.add("limit", limit.kind, *(self.fixed(one, "a limit") for one in limit.numbers))
        self.drawn(len(vehicles))
        self.lines.at = place_of(self.scenario.is_over)
        over = self.called(self.scenario.is_over, self.moment(len(vehicles), object()))
        if over is not False:
            if not isinstance(over, Condition):
                raise Untraceable(f"{self.lines.at}: expected a condition from is_over, got {shown(over)}")
            self.lines.add("over", over)
        return self.lines.file(self.head())

    def head(self) -> list[str]:
        lines = ["skein-scenario 1", f"name {self.name}"]
        if self.scenario.note:
            lines.append(f"note {quoted(self.scenario.note)}")
        if self.scenario.scene != "empty":
            lines.append(f"scene {self.scenario.scene}")
        return lines + [f"setting {key} {value!r} {quoted(meaning)}" for key, value, meaning in self.settings]

    def listed(self, name: str, kind: type) -> list[Any]:
        """What a method of the scenario returns, as a list of one kind."""
        method = getattr(self.scenario, name)
        expected, answer = f"{place_of(method)}: expected a list of {kind.__name__} from {name}()", method()
        if isinstance(answer, kind):
            raise TypeError(f"{expected}, got one {kind.__name__} without a list")
        if not isinstance(answer, Iterable):
            raise TypeError(f"{expected}, got {shown(answer)}")
        all_ = list(answer)
        for one in all_:
            if kind is Measure and isinstance(one, Series):
                raise TypeError(f"{expected}, got a Series; reduce it, such as by .mean('mean {one.name}')")
            if not isinstance(one, kind):
                raise TypeError(f"{expected}, got {shown(one)}")
        return all_

    def called(self, function: Callable[..., Any], *arguments: Any) -> Any:
        with unchanged(self.scenario, function):
            return function(*arguments)

    def number(self, value: Any, what: str) -> Number:
        if isinstance(value, Number):
            return value
        if isinstance(value, Condition) or isinstance(value, bool) or not isinstance(value, (int, float)):
            if hasattr(value, "item") and getattr(value, "shape", None) == ():
                return self.number(value.item(), what)
            instead = "; write where(condition, a, b)" if isinstance(value, Condition) else ""
            raise Untraceable(f"{self.lines.at}: expected a number as {what}, got {shown(value)}{instead}")
        if not math.isfinite(value):
            raise Untraceable(f"{self.lines.at}: expected a finite number as {what}, got {value}")
        return constant(self.graph, float(value))

    def fixed(self, value: Any, what: str) -> Number:
        number = self.number(value, what)
        if number.of is not None:
            raise Untraceable(f"{self.lines.at}: expected a number of settings alone as {what}, got one of a decision")
        return number

    def known(self, place: int, of: object) -> Known:
        words = ("north", "east", "down", "north-mps", "east-mps", "down-mps", "heading", "age")
        return Known(*(self.graph.leaf(word, str(place), of) for word in words))

    def moment(self, count: int, of: object) -> Moment:
        return Moment(_Team(self.known(place, of) for place in range(count)), self.graph.leaf("elapsed", "", of))

    def seen(self, place: int, vehicles: Sequence[Vehicle], of: object) -> Observation:
        others = [one for one in range(len(vehicles)) if one != place]
        rivals = [one for one in others if _role(vehicles[one].role) != _role(vehicles[place].role)]
        leaves = (self.graph.leaf(word, "", of) for word in ("elapsed", "acts-in", "cruise", "start-down"))
        known = _Team(self.known(one, of) for one in range(len(vehicles)))
        return Observation(place, known, *leaves, rivals=rivals or others, time_s=self.graph.leaf("time", "", of))

    def vehicle(self, place: int, vehicle: Vehicle, all_: Sequence[Vehicle]) -> None:
        what = f"the policy of {vehicle.name}"
        self.lines.at = f"{place_of(vehicle.policy)}: {what}"
        if len(vehicle.start_ned_m) != 3:
            raise ValueError(f"{vehicle.name}: expected north, east and down as its start, got {vehicle.start_ned_m}")
        self.lines.add(
            "vehicle",
            quoted(vehicle.name),
            quoted(vehicle.role),
            self.fixed(vehicle.speed_mps, "the vehicle's speed"),
            *(self.fixed(one, "the vehicle's start") for one in vehicle.start_ned_m),
            self.fixed(vehicle.heading_rad, "the vehicle's heading"),
        )
        of = object()
        seen = self.seen(place, all_, of)
        starts: list[Any] = [] if vehicle.memory is None else leaves(vehicle.memory, self.lines.at)
        if vehicle.memory is None:
            (decided, self.lines.at), after = self.answered(vehicle.policy, what, seen), []
        else:
            decided, after = self.remembering(vehicle, what, seen, starts, of)
        self.does(decided)
        for start, next_ in zip(starts, after, strict=True):
            first = float(start) if isinstance(start, bool) else start
            self.lines.add("remembers", self.fixed(first, "a memory"), self.remembered(next_))
        if vehicle.wants is not None:
            wanted = self.called(vehicle.wants, seen, self.graph.leaf("ahead", "", of))
            if not isinstance(wanted, tuple) or len(wanted) != 2 or vehicle.most_mps is None:
                raise ValueError(f"{vehicle.name}: expected north and east from wants, and most_mps")
            self.lines.add(
                "wants",
                *(self.number(one, "a place wanted") for one in wanted),
                self.fixed(vehicle.most_mps, "most_mps"),
                self.fixed(vehicle.least_apart_m, "least_apart_m"),
            )

    def answered(self, policy: Callable[..., Any], what: str, *arguments: Any) -> tuple[Any, str]:
        with unchanged(self.scenario, policy):
            return answered(policy, what, *arguments)

    def remembering(self, of: Vehicle, what: str, seen: Observation, starts: list[Any], decision: object) -> Any:
        """The decision of a policy with memory, and the numbers of the next memory."""
        held = (self.graph.leaf("memory", str(number), decision) for number in range(len(starts)))
        given = (one > 0.5 if isinstance(start, bool) else one for start, one in zip(starts, held, strict=True))
        answer, self.lines.at = self.answered(of.policy, what, seen, filled(of.memory, given))
        if not isinstance(answer, tuple) or len(answer) != 2:
            raise Untraceable(f"{self.lines.at}: expected an action and the next memory, got {shown(answer)}")
        decided, memory = answer
        if form(memory) != form(of.memory):
            raise Untraceable(
                f"{self.lines.at}: expected a next memory of the form of the first, {form(of.memory)}, "
                f"got {form(memory)}"
            )
        return decided, leaves(memory, self.lines.at)

    def does(self, decided: Any) -> None:
        if not isinstance(decided, (Action, Choice)):
            raise Untraceable(
                f"{self.lines.at}: expected an action, such as seen.along(heading, speed), got {shown(decided)}"
            )
        listed = cases(decided, True)
        for number, (condition, action) in enumerate(listed):
            when = ["when", condition] if number < len(listed) - 1 and isinstance(condition, Condition) else []
            numbers = [
                self.number(one, f"argument {place} of {action.kind}") for place, one in enumerate(action.numbers, 1)
            ]
            if not isinstance(action.yaw, Yaw):
                raise Untraceable(f"{self.lines.at}: expected a yaw, such as Yaw.forward(), got {shown(action.yaw)}")
            yaw: list[Any] = [] if action.yaw.kind == "still" else ["yaw", action.yaw.kind]
            if action.yaw.number is not None:
                yaw.append(self.number(action.yaw.number, "a yaw"))
            self.lines.add("does", *when, action.kind, *numbers, *yaw)
            if not when:
                break

    def remembered(self, value: Any) -> Number:
        if isinstance(value, Condition):
            return where(value, 1.0, 0.0)
        return self.number(float(value) if isinstance(value, bool) else value, "a number of the memory")

    def drawn(self, count: int) -> None:
        measures = self.listed("measures", Measure)
        known: dict[str, tuple[Any, ...]] = {}
        for one in [*(each.of for each in measures), *self.listed("series", Series)]:
            self.lines.at = f"{place_of(one.of)}: the series {one.name}"
            value = self.number(self.called(one.of, self.moment(count, object())), "its value")
            unknown = self.graph.inputs(value.node) & {"heading", "age"}
            if unknown:
                name = "heading_rad" if "heading" in unknown else "age_s"
                raise Untraceable(
                    f"{self.lines.at}: expected positions, velocities and elapsed_s alone in a measure, got {name}"
                )
            is_new, same = one.name not in known, (value.node, one.unit)
            if known.setdefault(one.name, same) != same:
                raise ValueError(f"{self.lines.at}: expected a name of its own for each series, got {one.name!r} twice")
            if not is_new:
                continue
            bound = [] if one.bound is None else ["bound", quoted(one.bound[0]), self.fixed(one.bound[1], "a bound")]
            self.lines.add("series", quoted(one.name), quoted(one.unit), value, *bound)
            self.lines.at = place_of(self.scenario.measures)
            for each in measures:
                if each.of.name == one.name:
                    window = [] if each.window is None else [each.window[0], self.fixed(each.window[1], "a window")]
                    self.lines.add("measure", quoted(each.name), each.reduction, *window)


class _Team(list[Known]):
    """The vehicles, by their indices."""

    def __getitem__(self, place: Any) -> Any:
        try:
            return super().__getitem__(place)
        except IndexError:
            raise refused(f"it reads vehicle {place} of a team of vehicles 0 to {len(self) - 1}") from None


def _role(name: str) -> str:
    """Skein's own roles are recognised in any letter case."""
    return name.lower() if name.lower() in ("pursuer", "evader", "leader", "follower", "traveller") else name
