"""A link and a loop's timing around any environment: delays in seconds, ages, actions on their way.

``DelayEnv`` wraps an environment of Gymnasium, ``DelayVectorEnv`` a vector of them, ``DelayParallelEnv`` one of
PettingZoo; ``Delay``, on which they are based, works on arrays and needs only NumPy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .core import Delay, Seen
from .profiles import Delays, Trace, delays

if TYPE_CHECKING:
    from .parallel import DelayParallelEnv
    from .single import DelayEnv
    from .vector import DelayVectorEnv

__all__ = ["Delay", "DelayEnv", "DelayParallelEnv", "DelayVectorEnv", "Delays", "Seen", "Trace", "delays"]

_WRAPPERS = {"DelayEnv": "single", "DelayVectorEnv": "vector", "DelayParallelEnv": "parallel"}


def __getattr__(name: str) -> Any:
    """Imports the wrappers on first use, since their modules need Gymnasium or PettingZoo."""
    if name in _WRAPPERS:
        from importlib import import_module

        from ..errors import needed

        needed("pettingzoo" if name == "DelayParallelEnv" else "gymnasium", "delay")
        return getattr(import_module(f".{_WRAPPERS[name]}", __name__), name)
    raise AttributeError(f"module {__name__} has no {name}")
