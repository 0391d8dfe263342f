"""Delay around a parallel environment of PettingZoo."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.vector.utils import create_empty_array
from pettingzoo import ParallelEnv
from pettingzoo.utils.wrappers import BaseParallelWrapper

from .arrays import each
from .core import Delay
from .spaces import Telling, batched, encoding, idle


class DelayParallelEnv(BaseParallelWrapper):
    """Puts a link and a loop's timing between the agents' policies and an environment.

    Each agent's observations and actions have delays of their own. The state of a ``correlated`` link, or of one that is
    busy at times, is common to all. Otherwise like `skein_uav.delay.single.DelayEnv`.

    Parameters
    ----------
    env : ParallelEnv
    step_s, ages, pending, **settings
        As in `DelayEnv`, for every agent; a decision lasts one step.
    """

    def __init__(
        self,
        env: ParallelEnv,
        step_s: float,
        *,
        ages: bool = True,
        pending: int = 0,
        seed: int | None = None,
        **settings: Any,
    ) -> None:
        super().__init__(env)
        if "substeps" in settings or "every" in settings:
            raise ValueError("substeps: expected none, as a decision lasts one step of a parallel environment")
        self._delays: dict[Any, Delay] = {}
        self._tellings: dict[Any, Telling] = {}
        self._seed = np.random.SeedSequence(seed).entropy
        for agent in env.possible_agents:
            space = env.action_space(agent)
            own = {"pending": pending, "encode": encoding(env.observation_space(agent), space), "idle_action": idle(space)}
            self._delays[agent] = Delay(1, step_s, **{**own, **settings})
            longest = self._delays[agent].longest_age_s
            self._tellings[agent] = Telling(env.observation_space(agent), space, longest, ages, pending)
        self.observation_spaces = {agent: one.space for agent, one in self._tellings.items()}
        self._live: set[Any] = set()

    def observation_space(self, agent: Any) -> Any:
        """The observation space of an agent; always one object."""
        return self.observation_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[Any, Any], dict[Any, dict[str, Any]]]:
        """Begins an episode; a seed applies to the link, too."""
        observations, infos = self.env.reset(seed=seed, options=options)
        if seed is None:
            seed, self._seed = self._seed, None
        else:
            self._seed = None
        self._live = set()
        # An agent that left earlier has equal progress on the link.
        now = max((one.row for one in self._delays.values()), default=0)
        for one in self._delays.values():
            one.row = now
        return {agent: self._told(agent, one, seed) for agent, one in observations.items()}, infos

    def step(self, actions: dict[Any, Any]) -> tuple[dict[Any, Any], ...]:
        """Decides for every agent."""
        acting = {
            agent: each(lambda one: one[0], self._delays[agent].acting(batched(action)))
            for agent, action in actions.items()
        }
        observations, *others = self.env.step(acting)
        return {agent: self._told(agent, one) for agent, one in observations.items()}, *others

    def _told(self, agent: Any, observation: Any, seed: int | None = None) -> Any:
        delay, observation = self._delays[agent], batched(observation)
        if agent in self._live:
            seen = delay.seen(observation)
        else:
            self._live.add(agent)
            line = self.env.possible_agents.index(agent)
            like = create_empty_array(self.env.action_space(agent), 1, fn=np.zeros)
            seen = delay.begin(observation, seed=[seed], line=line, actions=like)
        return each(lambda one: one[0], self._tellings[agent].told(seen))
