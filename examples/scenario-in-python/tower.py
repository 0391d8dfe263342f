"""Two scouts climb around a tower, each on its own side, and keep a distance from one another."""

from dataclasses import dataclass

from skein_uav.formula import cos, hypot, logical_and, minimum, sin, sqrt, where
from skein_uav.scenario import Limit, Scenario, Series, Vehicle, Yaw, setting, velocity


@dataclass
class Turns:
    angle_rad: float = 0.0
    is_up: bool = True


@dataclass
class Tower(Scenario):
    ring_m: float = setting(6.0, "distance from the tower's middle, m")
    top_m: float = setting(20.0, "altitude at which a scout turns back, m")
    pace_rad_per_s: float = setting(0.4, "around the tower, rad/s")
    climb_mps: float = setting(1.0, "up and down, m/s")

    def vehicles(self):
        for one in range(2):
            start = (self.ring_m * (1 - 2 * one), 0.0, -5.0)
            yield Vehicle(f"Scout{one + 1}", self.inspect, start, 4.0, memory=Turns(3.1415926 * one))

    def inspect(self, seen, memory):
        """A spiral: the memory is the place on it, which goes on by time, not by decisions."""
        own = seen.own
        angle = memory.angle_rad + self.pace_rad_per_s * seen.elapsed_s
        is_up = where(memory.is_up, -own.down_m < self.top_m, -own.down_m < 6.0)
        north = 0.8 * (self.ring_m * cos(angle) - own.north_m)
        east = 0.8 * (self.ring_m * sin(angle) - own.east_m)
        down = where(is_up, -self.climb_mps, self.climb_mps)
        return velocity(north, east, down, Yaw.turning(self.pace_rad_per_s)), Turns(angle, is_up)

    def off(self, now):
        """Of the scout that is farther from its distance to the tower."""
        return sum((hypot(one.north_m, one.east_m) - self.ring_m) ** 2 for one in now.vehicles) ** 0.5

    def apart(self, now):
        one, other = now.vehicles
        return sqrt((one.north_m - other.north_m) ** 2 + (one.east_m - other.east_m) ** 2 + (one.down_m - other.down_m) ** 2)

    def speed(self, now):
        return minimum(*(hypot(one.north_mps, one.east_mps) for one in now.vehicles))

    def limits(self):
        return [Limit.separation(3.0), Limit.ceiling(self.top_m + 3.0)]

    def measures(self):
        off = Series("off the distance", "m", self.off)
        return [
            off.rms("off", after_s=5),
            Series("apart", "m", self.apart).least("closest"),
            Series("slower one", "m/s", self.speed).mean("pace", after_s=5),
        ]

    def is_over(self, now):
        return logical_and(now.elapsed_s > 50, now.vehicles[0].down_m > -7)
