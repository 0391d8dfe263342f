"""A policy's input as a space of Gymnasium."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.spaces import Box, Dict, Discrete, MultiBinary, MultiDiscrete, Tuple

from .arrays import Tree, cast, joined, namespace
from .core import Seen
from .pending import OneHot


class Telling:
    """Joins observation, age and pending actions.

    If observations are vectors of floats, the result is one, too: the observation, its age in s, and the pending actions,
    the oldest first, those of a ``Discrete`` space one-hot encoded. Other observations become a dict of ``observation``,
    ``age_s`` and ``pending``. With neither ages nor pending actions they stay unchanged.

    Parameters
    ----------
    observation, action : Space
        Spaces of one environment.
    longest_age_s : float
        Greatest age of an observation, s.
    ages : bool
        Whether the result contains ages.
    pending : int
        Number of pending actions that it contains.

    Attributes
    ----------
    space : Space
        Space of the result for one environment.
    spare : int
        Number of columns after an observation, as in `skein_uav.delay.Delay`; 0 without ages.
    """

    def __init__(
        self, observation: gym.Space, action: gym.Space, longest_age_s: float, ages: bool, pending: int
    ) -> None:
        if pending and not isinstance(action, (Box, Discrete)):
            raise ValueError(f"pending: expected 0 with actions that are no Box and no Discrete, got {pending}")
        self._ages, self._pending = ages, pending
        self._is_flat = _is_flat(observation)
        self.spare = 0
        if not ages and not pending:
            self.space = observation
        elif self._is_flat:
            least, most = [observation.low], [observation.high]
            if ages:
                least.append(np.zeros(1))
                most.append(np.full(1, longest_age_s))
            if pending:
                one_hot = isinstance(action, Discrete)
                least.append(np.tile(np.zeros(action.n) if one_hot else action.low.ravel(), pending))
                most.append(np.tile(np.ones(action.n) if one_hot else action.high.ravel(), pending))
            low, high = (np.concatenate(parts).astype(observation.dtype) for parts in (least, most))
            self.space = Box(low, high, dtype=observation.dtype)
            self._width = len(low)
            self.spare = self._width - len(observation.low) if ages else 0
        else:
            parts = {"observation": observation}
            if ages:
                parts["age_s"] = Box(0, longest_age_s, (1,), np.float32)
            if pending and isinstance(action, Discrete):
                parts["pending"] = MultiDiscrete(np.full(pending, action.n), start=np.full(pending, action.start))
            elif pending:
                least, most = (np.stack([one] * pending) for one in (action.low, action.high))
                parts["pending"] = Box(least, most, dtype=action.dtype)
            self.space = Dict(parts)

    def told(self, seen: Seen | np.ndarray) -> Tree:
        """Joins the parts for a batch, unless they are joined already."""
        if type(seen) is np.ndarray:
            return seen
        observation = seen.observation
        if not self._ages and not self._pending:
            return observation
        if not self._is_flat:
            told = {"observation": observation}
            if self._ages:
                told["age_s"] = cast(seen.age_s[:, None], namespace(seen.age_s).float32)
            if self._pending:
                told["pending"] = seen.pending
            return told
        pending = seen.pending.reshape(len(observation), -1) if self._pending else None
        return joined([observation, seen.age_s[:, None] if self._ages else None, pending], self._width)


def encoding(observation: gym.Space, action: gym.Space) -> Callable[[Tree], Tree] | None:
    """The encoding of pending actions next to such an observation; None: unchanged."""
    if not _is_flat(observation) or not isinstance(action, Discrete):
        return None
    return OneHot(np.arange(action.start, action.start + action.n))


def _is_flat(observation: gym.Space) -> bool:
    is_vector = isinstance(observation, Box) and len(observation.shape) == 1
    return is_vector and np.issubdtype(observation.dtype, np.floating)


def idle(space: gym.Space) -> Any:
    """The idle action: 0, or the nearest one of the space."""
    if isinstance(space, Box):
        return np.clip(np.zeros(space.shape, space.dtype), space.low, space.high)
    if isinstance(space, (Discrete, MultiDiscrete)):
        return space.start
    if isinstance(space, MultiBinary):
        return np.zeros(space.shape, space.dtype)
    if isinstance(space, Dict):
        return {name: idle(one) for name, one in space.items()}
    if isinstance(space, Tuple):
        return tuple(idle(one) for one in space)
    raise ValueError(f"idle_action: expected one, since there is none for {space}")


def batched(tree: Tree) -> Tree:
    """A batch of one."""
    if isinstance(tree, dict):
        return {name: batched(one) for name, one in tree.items()}
    if isinstance(tree, tuple):
        return tuple(batched(one) for one in tree)
    return np.asarray(tree)[None]
