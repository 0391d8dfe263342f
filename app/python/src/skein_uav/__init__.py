"""Control loops for teams of drones under real latency: flights, searches and environments.

Examples
--------
>>> import skein_uav as skein
>>> skein.spread(loop=["stream", "predictive"], link="vpn", seeds=20)       # doctest: +SKIP
"""

from .commands import Flights, Found, budget, fly, run, search, spread, to_onnx
from .errors import NotFound, SkeinError
from .recording import Recording, load
from .scenario import Scenario

__all__ = [
    "Flights",
    "Found",
    "NotFound",
    "Recording",
    "Scenario",
    "SkeinError",
    "budget",
    "fly",
    "load",
    "run",
    "search",
    "spread",
    "to_onnx",
]
