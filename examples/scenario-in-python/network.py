"""A duel in which a network of 16 and 16 neurons pursues; its weights are drawn, not learned."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pursuit import Pursuit

from skein_uav.formula import cos, sin, tanh

PARAMETERS = np.loadtxt(Path(__file__).with_name("network.txt"))


def layers(widths=(4, 16, 16, 1)):
    """Of each neuron its weights, and behind them its bias."""
    at = 0
    for inputs, neurons in zip(widths, widths[1:]):
        end = at + neurons * (inputs + 1)
        yield PARAMETERS[at:end].reshape(neurons, inputs + 1)
        at = end


@dataclass
class Network(Pursuit):
    def pursue(self, seen):
        """Sees the evader's place and velocity in the own frame; its output is how hard it turns."""
        own, evader = seen.own, seen.opponent
        north, east = evader.north_m - own.north_m, evader.east_m - own.east_m
        north_mps, east_mps = evader.north_mps - own.north_mps, evader.east_mps - own.east_mps
        c, s = cos(own.heading_rad), sin(own.heading_rad)
        values = [(north * c + east * s) / 20, (east * c - north * s) / 20]
        values += [(north_mps * c + east_mps * s) / 10, (east_mps * c - north_mps * s) / 10]
        for layer in layers():
            # `weights @ values` is as good, but does not begin with 0, so that a fused sum rounds otherwise.
            values = [tanh(sum(weight * x for weight, x in zip(row, values)) + row[-1]) for row in layer]
        return seen.along(own.heading_rad + self.turn_rate_rad_per_s * values[0] * seen.elapsed_s, seen.cruise_mps)
