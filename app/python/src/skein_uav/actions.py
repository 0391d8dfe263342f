"""A policy's decisions: actions, and choices between them by values that are known only in flight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .formula import logical_and
from .symbols import Condition
from .untraceable import refused


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
        The arguments of the function that the kind names.
    yaw : Yaw
    """

    kind: str
    numbers: tuple[Any, ...] = ()
    yaw: Yaw = Yaw()

    def _where(self, condition: Condition, a: Any, b: Any) -> Any:
        return Choice(cases(a, True), cases(b, True), condition)


@dataclass(frozen=True)
class Choice:
    """One of two actions, by a condition."""

    a: list[tuple[Any, Action]]
    b: list[tuple[Any, Action]]
    condition: Condition

    def _where(self, condition: Condition, a: Any, b: Any) -> Any:
        return Choice(cases(a, True), cases(b, True), condition)


def cases(of: Any, when: Any) -> list[tuple[Any, Action]]:
    """Actions with their conditions: the first whose condition holds applies; the last one always holds."""
    if isinstance(of, Choice):
        first = [(logical_and(of.condition, condition), action) for condition, action in of.a]
        return first + of.b
    if not isinstance(of, Action):
        raise refused(f"where takes two actions, got {type(of).__name__}")
    return [(when, of)]


def along(heading_rad: Any, speed_mps: Any, down_m: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies on a heading at an altitude; `Observation.along` keeps the altitude of the start."""
    return Action("along", (heading_rad, speed_mps, down_m), yaw)


def velocity_at(north_mps: Any, east_mps: Any, down_m: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies with a horizontal velocity at an altitude."""
    return Action("velocity-at", (north_mps, east_mps, down_m), yaw)


def velocity(north_mps: Any, east_mps: Any, down_mps: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies with a velocity in three dimensions."""
    return Action("velocity", (north_mps, east_mps, down_mps), yaw)


def position(north_m: Any, east_m: Any, down_m: Any, speed_mps: Any, yaw: Yaw = Yaw()) -> Action:
    """Flies to a position, no faster than a speed, and stays there."""
    return Action("position", (north_m, east_m, down_m, speed_mps), yaw)


def turn(yaw: Yaw) -> Action:
    """Stays, and turns."""
    return Action("turn", (), yaw)


def attitude(roll_rad: Any, pitch_rad: Any, yaw_rad: Any, thrust: Any) -> Action:
    """Holds an attitude, with a share of full thrust from 0 to 1."""
    return Action("attitude", (roll_rad, pitch_rad, yaw_rad, thrust))


def hover() -> Action:
    """Stays where it is."""
    return Action("hover")


def land() -> Action:
    """Descends until it stands on the ground."""
    return Action("land")
