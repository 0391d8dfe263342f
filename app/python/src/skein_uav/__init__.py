"""Control loops for teams of drones under real latency: flights, searches and environments.

Examples
--------
>>> import skein_uav as skein
>>> skein.spread(loop=["stream", "predictive"], link="vpn", seeds=20)       # doctest: +SKIP
"""

from .commands import budget, fly, run, search, spread, to_onnx
from .errors import NotFound, SkeinError
from .evaluation import evaluate
from .recording import Recording, load
from .results import Budget, Figure, Flights, Found, Tables
from .scenario import Scenario

__all__ = [
    "Budget",
    "Figure",
    "Flights",
    "Found",
    "NotFound",
    "Recording",
    "Scenario",
    "SkeinError",
    "Tables",
    "budget",
    "evaluate",
    "fly",
    "load",
    "run",
    "search",
    "spread",
    "to_onnx",
]
