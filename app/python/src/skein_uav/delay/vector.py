"""Delay around a vector environment of Gymnasium."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper
from gymnasium.vector.utils import batch_space, create_empty_array

from .arrays import each
from .core import Delay
from .spaces import Telling, encoding, idle


class DelayVectorEnv(VectorWrapper, gym.utils.RecordConstructorArgs):
    """Puts a link and a loop's timing between a policy and many environments, each with a link of its own.

    Like `skein_uav.delay.single.DelayEnv`. In its first episode each environment has the delays of a single one with
    its seed. All modes of automatic resets work; ``final_obs`` is the seen observation at the end. Arrays may be of
    NumPy, PyTorch or JAX; results are of the environment's kind.

    Parameters
    ----------
    env : VectorEnv
        An environment whose ``metadata["autoreset_mode"]`` states when it is reset.
    step_s, ages, pending, idle_action, **settings
        As in `DelayEnv`. If a decision lasts several steps, wrap each environment before a vector is made of them.
    """

    def __init__(
        self,
        env: VectorEnv,
        step_s: float,
        *,
        ages: bool = True,
        pending: int = 0,
        idle_action: Any = None,
        **settings: Any,
    ) -> None:
        gym.utils.RecordConstructorArgs.__init__(
            self, step_s=step_s, ages=ages, pending=pending, idle_action=idle_action, **settings
        )
        VectorWrapper.__init__(self, env)
        if "substeps" in settings or "every" in settings:
            raise ValueError("substeps: wrap each environment in DelayEnv before a vector is made of them")
        if env.metadata.get("autoreset_mode") is None:
            raise ValueError("env: expected metadata['autoreset_mode'], of gymnasium.vector.AutoresetMode, got none")
        mode = AutoresetMode(env.metadata["autoreset_mode"])
        self._resets, self._resets_next = mode is not AutoresetMode.DISABLED, mode is AutoresetMode.NEXT_STEP
        self._idle = idle(env.single_action_space) if idle_action is None else idle_action
        encode = encoding(env.single_observation_space, env.single_action_space)
        own = {"pending": pending, "encode": encode, "idle_action": self._idle}
        self._delay = Delay(env.num_envs, step_s, **own, **settings)
        self._telling = Telling(
            env.single_observation_space, env.single_action_space, self._delay.longest_age_s, ages, pending
        )
        self._delay.spare = self._telling.spare
        self.single_observation_space = self._telling.space
        self.observation_space = batch_space(self.single_observation_space, env.num_envs)
        self._like = create_empty_array(env.single_action_space, env.num_envs, fn=np.zeros)
        self._ended: Any = None

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins episodes; seeds apply to the links, too, except with a ``reset_mask``, with which links continue."""
        mask = None if options is None else options.get("reset_mask")
        observations, infos = self.env.reset(seed=seed, options=options)
        seeds = None
        if mask is None:
            self._ended = None
            if seed is not None:
                seeds = [seed + number for number in range(self.num_envs)] if np.ndim(seed) == 0 else list(seed)
        elif self._ended is not None:
            self._ended = self._ended & ~mask
        seen = self._delay.begin(observations, mask, seeds, actions=self._like)
        return self._telling.told(seen), infos

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Makes a decision in every environment on the last returned observations."""
        observations, rewards, terminated, truncated, infos = self.env.step(self._delay.acting(actions))
        if self._resets_next:
            seen = self._delay.seen(observations, self._ended)
            self._ended = terminated | truncated
        elif not self._resets:
            seen = self._delay.seen(observations)
        elif "final_obs" in infos:
            seen = self._finals(observations, terminated | truncated, infos)
        else:
            seen = self._delay.seen(observations, terminated | truncated)
        return self._telling.told(seen), rewards, terminated, truncated, infos

    def _finals(self, observations: Any, done: Any, infos: dict[str, Any]) -> Any:
        """Stores the final observations of episodes that other ones followed in this step; returns the first of these."""
        finals = infos["final_obs"]
        is_list = isinstance(finals, np.ndarray) and finals.dtype == object
        last = each(np.copy, observations) if is_list else finals
        for at in np.flatnonzero(done) if is_list else ():
            each(lambda all, one: all.__setitem__(at, one), last, finals[at])
        told = self._telling.told(self._delay.seen(last))
        if is_list:
            infos["final_obs"] = np.full(self.num_envs, None, dtype=object)
            for at in np.flatnonzero(done):
                infos["final_obs"][at] = each(lambda one: one[at], told)
        else:
            infos["final_obs"] = told
        return self._delay.begin(observations, done)
