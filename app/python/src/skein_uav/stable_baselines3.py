"""The environments with Stable-Baselines3's own interface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from stable_baselines3.common.vec_env import VecEnv

from .environments import PursuitVectorEnv


class PursuitVecEnv(VecEnv):
    """Many duels in lockstep; its parameters are those of `skein_uav.environments.PursuitVectorEnv`."""

    def __init__(self, num_envs: int = 64, **settings: Any) -> None:
        self._env = PursuitVectorEnv(num_envs, autoreset_mode=AutoresetMode.SAME_STEP, **settings)
        self._actions: Any = None
        super().__init__(num_envs, self._env.single_observation_space, self._env.single_action_space)

    def reset(self) -> Any:
        seeds = None if self._seeds[0] is None else list(self._seeds)
        seen, _ = self._env.reset(seed=seeds)
        self._reset_seeds()
        return seen

    def step_async(self, actions: Any) -> None:
        self._actions = actions

    def step_wait(self) -> Any:
        seen, rewards, terminated, truncated, told = self._env.step(self._actions)
        done = terminated | truncated
        infos: list[dict[str, Any]] = [
            {"distance_m": float(distance), "time_s": float(time)}
            for distance, time in zip(told["distance_m"], told["time_s"], strict=True)
        ]
        for number in np.flatnonzero(done):
            infos[number] |= {
                "terminal_observation": told["final_obs"][number],
                "TimeLimit.truncated": bool(truncated[number]),
            }
        return seen, rewards, done, infos

    def close(self) -> None:
        self._env.close()

    def get_images(self) -> Sequence[Any]:
        return self._env.render() or ()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self._env, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        raise NotImplementedError("all environments have the settings that they were made with")

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **named: Any) -> list[Any]:
        raise NotImplementedError("the environments fly together: none has methods of its own")

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        return [False] * len(list(self._get_indices(indices)))
