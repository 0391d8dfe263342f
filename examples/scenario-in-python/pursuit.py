"""The paper's duel, written in Python."""

import math
from dataclasses import dataclass

from skein_uav.formula import atan2, cos, sign, sin, where
from skein_uav.scenario import Scenario, Series, Vehicle, setting


@dataclass
class Pursuit(Scenario):
    turn_rate_rad_per_s: float = setting(1.0, "greatest turn rate of the pursuer, rad/s")
    radius_m: float = setting(8.0, "turning radius that the evader expects of the pursuer, m")

    def vehicles(self):
        return [
            Vehicle("Evader", self.evade, (21, 0, -20), 5.0, math.cos(0.5), "Evader"),
            Vehicle("Pursuer", self.pursue, (0, 0, -20), 10.0, 0.0, "Pursuer"),
        ]

    def pursue(self, seen):
        """Turns to the side on which the evader is, as hard as it can."""
        own = seen.own
        dx, dy = seen.opponent.north_m - own.north_m, seen.opponent.east_m - own.east_m
        c, s = cos(own.heading_rad), sin(own.heading_rad)
        x, y = dx * c + dy * s, -dx * s + dy * c
        side = where(y != 0, sign(y), where(x < 0, 1.0, 0.0))
        return seen.along(own.heading_rad + side * (self.turn_rate_rad_per_s * seen.elapsed_s), seen.cruise_mps)

    def evade(self, seen):
        """Heads for safety inside a turning circle of the pursuer, breaks away near it, and runs far from it."""
        other, radius = seen.opponent, self.radius_m
        dx, dy = other.north_m - seen.own.north_m, other.east_m - seen.own.east_m
        c, s = cos(other.heading_rad), sin(other.heading_rad)
        x, y = -dx * c - dy * s, dx * s - dy * c
        far = other.heading_rad + atan2(y, x)
        near = where(x * x + y * y < 4 * radius * radius, far + math.pi / 2, far)
        left = where(in_circle(x, y + radius, radius), other.heading_rad + atan2(y - radius, x), near)
        right = where(in_circle(x, y - radius, radius), other.heading_rad + atan2(y + radius, x), left)
        return seen.along(right, seen.cruise_mps)

    def distance(self, now):
        return now.distance_m(1, 0)

    def measures(self):
        distance = Series("distance", "m", self.distance)
        return [distance.mean("last 10 s", last_s=10), distance.least("closest")]


def in_circle(x, y, radius):
    return x * x + y * y < radius * radius
