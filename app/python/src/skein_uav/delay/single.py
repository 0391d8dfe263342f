"""Delay around an environment of Gymnasium."""

from __future__ import annotations

from typing import Any, SupportsFloat

import gymnasium as gym
import numpy as np
from gymnasium.vector.utils import create_empty_array

from .arrays import each
from .core import Delay
from .spaces import Telling, batched, encoding, idle


class DelayEnv(gym.Wrapper, gym.utils.RecordConstructorArgs):
    """Puts a link and a loop's timing between a policy and an environment.

    Observations arrive late; the policy sees the newest one, with its age, and actions act once they have arrived. Rewards
    and the ends of episodes are those of the environment itself, without delay. After an end, messages in transit are
    void.

    Parameters
    ----------
    env : gymnasium.Env
        An environment whose observations and actions are arrays, numbers, or dicts and tuples of them.
    step_s : float
        Simulated time of a step of the environment, s.
    ages : bool
        Whether the policy's input contains ages (`skein_uav.delay.spaces.Telling`).
    pending : int
        Number of last decisions that it contains as well.
    substeps : int
        Number of steps from one decision to the next; rewards are added. Messages arrive at whole steps.
    idle_action : array, number, or a tree of them, optional
        The action that acts before one of the episode has arrived; by default 0, or the nearest action to it.
    **settings
        ``link``, ``observation_delay``, ``action_delay``, ``compute_s``, ``dropout``, ``moves_in_flight``, ``arrival``,
        ``first``, ``predict`` and ``seed``, as in `skein_uav.delay.Delay`.
    """

    def __init__(
        self,
        env: gym.Env,
        step_s: float,
        *,
        ages: bool = True,
        pending: int = 0,
        substeps: int = 1,
        idle_action: Any = None,
        **settings: Any,
    ) -> None:
        gym.utils.RecordConstructorArgs.__init__(
            self, step_s=step_s, ages=ages, pending=pending, substeps=substeps, idle_action=idle_action, **settings
        )
        gym.Wrapper.__init__(self, env)
        self._idle = idle(env.action_space) if idle_action is None else idle_action
        self._like = create_empty_array(env.action_space, 1, fn=np.zeros)
        self._substeps = substeps
        encode = encoding(env.observation_space, env.action_space)
        own = {"pending": pending, "encode": encode, "every": substeps, "idle_action": self._idle}
        self._delay = Delay(1, step_s, **own, **settings)
        self._telling = Telling(env.observation_space, env.action_space, self._delay.longest_age_s, ages, pending)
        self._delay.spare = self._telling.spare
        self.observation_space = self._telling.space

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode; a seed applies to the link, too."""
        observation, info = self.env.reset(seed=seed, options=options)
        return self._told(self._delay.begin(batched(observation), seed=[seed], actions=self._like)), info

    def step(self, action: Any) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Makes a decision on the last returned observation."""
        acting, reward = self._delay.acting(batched(action)), None
        for number in range(self._substeps):
            if number:
                acting = self._delay.acting()
            observation, more, terminated, truncated, info = self.env.step(each(lambda one: one[0], acting))
            reward = more if reward is None else reward + more
            seen = self._delay.seen(batched(observation))
            if terminated or truncated:
                break
        return self._told(seen), reward, terminated, truncated, info

    def _told(self, seen: Any) -> Any:
        return each(lambda one: one[0], self._telling.told(seen))
