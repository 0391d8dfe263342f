"""Pursuers close a ring around an evader, which flees from the nearest of them: `surround`, written in Python."""

import math
from dataclasses import dataclass

from skein_uav.formula import atan2, cos, hypot, logical_and, logical_or, maximum, minimum, sin, sqrt, where
from skein_uav.scenario import Scenario, Series, Vehicle, setting

PER_S = 0.6  # commanded speed per metre behind


@dataclass
class Ring(Scenario):
    pursuers: int = 5
    ring_m: float = setting(8.0, "radius of the ring, m")
    pursuer_mps: float = setting(8.0, "speed of the pursuers, m/s")
    evader_mps: float = setting(4.0, "speed of the evader, m/s")
    start_m: float = setting(30.0, "from the pursuers' line to the evader at the start, m")
    altitude_m: float = setting(5.0, "of all vehicles, m")

    def vehicles(self):
        place = (self.start_m, 0.0, -self.altitude_m)
        yield Vehicle("Evader", self.flee, place, self.evader_mps, role="Evader")
        for one in range(self.pursuers):
            place = (0.0, (one - (self.pursuers - 1) / 2) * self.ring_m / 2, -self.altitude_m)
            yield Vehicle(
                f"Pursuer{one + 1}",
                self.surround,
                place,
                self.pursuer_mps,
                role="Pursuer",
                wants=self.slot,
                most_mps=self.pursuer_mps,
            )

    def flee(self, seen):
        """Straight away from the nearest other vehicle, the first of equals."""
        least, away_north, away_east = math.inf, 0.0, 0.0
        for other in seen.others:
            north, east = seen.own.north_m - other.north_m, seen.own.east_m - other.east_m
            distance = hypot(north, east)
            is_nearer = distance < least
            least = where(is_nearer, distance, least)
            away_north, away_east = where(is_nearer, (north, east), (away_north, away_east))
        is_still = logical_and(away_north == 0, away_east == 0)
        return seen.along(where(is_still, seen.own.heading_rad, atan2(away_east, away_north)), self.evader_mps)

    def surround(self, seen):
        """Keeps a slot on the ring; slots keep the order in which the pursuers stand around the evader."""
        evader, own = seen.vehicles[0], seen.own
        slot = self.slot_rad(seen)
        north = evader.north_m + self.ring_m * cos(slot)
        east = evader.east_m + self.ring_m * sin(slot)
        return seen.towards(
            evader.north_mps + PER_S * (north - own.north_m) + (evader.north_mps - own.north_mps),
            evader.east_mps + PER_S * (east - own.east_m) + (evader.east_mps - own.east_mps),
            self.pursuer_mps,
        )

    def slot(self, seen, ahead_s):
        """For the loop `plan`: the place wanted in so many seconds."""
        evader, slot = seen.vehicles[0], self.slot_rad(seen)
        return (
            evader.north_m + evader.north_mps * ahead_s + self.ring_m * cos(slot),
            evader.east_m + evader.east_mps * ahead_s + self.ring_m * sin(slot),
        )

    def slot_rad(self, seen):
        n = len(seen.vehicles) - 1
        bearings = {one: bearing(seen, one) for one in range(1, n + 1)}
        own = bearings[seen.place]
        before, total = 0.0, 0.0
        for one, its in bearings.items():
            total = total + its
            comes_first = logical_or(its < own, logical_and(its == own, one < seen.place))
            before = where(comes_first, before + 1, before)
        return total / n + (before - (n - 1) / 2) * 2 * math.pi / n

    def off_ring(self, now):
        squares = 0.0
        for one in range(1, len(now.vehicles)):
            off = now.distance_m(0, one) - self.ring_m
            squares = squares + off * off
        return sqrt(squares / (len(now.vehicles) - 1))

    def gap(self, now):
        """The largest angle between neighbours, as the evader sees them, degrees."""
        bearings = [bearing(now, one) for one in range(1, len(now.vehicles))]
        for last in range(len(bearings) - 1, 0, -1):
            for one in range(last):
                first, second = bearings[one], bearings[one + 1]
                bearings[one], bearings[one + 1] = minimum(first, second), maximum(first, second)
        widest = bearings[0] + 2 * math.pi - bearings[-1]
        for one, other in zip(bearings, bearings[1:]):
            widest = maximum(widest, other - one)
        return widest * (180 / math.pi)

    def measures(self):
        return [
            Series("off the ring, rms", "m", self.off_ring).rms("off ring", last_s=10),
            Series("gap", "°", self.gap).mean("gap", last_s=10),
        ]


def bearing(seen, one):
    """From the evader, from north towards east, rad."""
    evader, vehicle = seen.vehicles[0], seen.vehicles[one]
    return atan2(vehicle.east_m - evader.east_m, vehicle.north_m - evader.north_m)
