"""A scenario as a ParallelEnv of PettingZoo: the caller decides for several of its vehicles.

Observations, actions and rewards are those of `skein_uav.environments`. In the duel the sum of both rewards is 0.

A step lasts until the loop lets a learner decide. Under ``paused`` learners decide simultaneously with SIMD, unless other
vehicles decide between them, and one after another by the scalar engine. Over a link one may still be waiting for an answer
while another decides alone; then its observation stays unchanged and its action is ignored: ``infos[agent]["decides"]``
states it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from .batch import Floats
from .environments import action_space, observation_space, open_batch, seeds_of
from .errors import SkeinError
from .pictures import picture


class TeamParallelEnv(ParallelEnv[str, Floats, Floats]):
    """One world of a scenario; its agents are the learners' vehicles, by their names in lower case.

    Where two names differ only in case, all agents have the names of the scenario.

    Parameters
    ----------
    scenario : str
        The paper's ``duel``, or for example ``surround``.
    learners : str
        ``all`` vehicles, all of a role (``pursuers``), or names separated by commas (``Pursuer1,Evader``); others use
        their own policies.
    settings : mapping, optional
        Settings of the scenario, for example ``{"vehicles": 4}``.
    render_mode : {None, 'rgb_array'}
        Renders the last agent's observation as a picture.
    backend : {'process', 'socket', 'unix:PATH'}
        As in `skein_uav.environments.PursuitVectorEnv`.
    **others
        ``loop``, ``link``, ``period_ms``, ``plant``, ``sensors``, ``altitude_m``, ``episode_s``, ``capture_radius_m``,
        ``start_within_m``, ``moves_in_flight``, ``turn_rate_rad_per_s``, ``climb_mps`` and ``objective``, as in `PursuitVectorEnv`.
    """

    metadata = {"name": "skein_uav_team_v0", "render_modes": ["rgb_array"], "render_fps": 10, "is_parallelizable": True}

    def __init__(
        self,
        scenario: str = "duel",
        learners: str = "all",
        settings: Mapping[str, Any] | None = None,
        *,
        render_mode: str | None = None,
        backend: str = "process",
        **others: Any,
    ) -> None:
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode: expected None or 'rgb_array', got {render_mode!r}")
        given = {"scenario": scenario, "learners": learners, "settings": settings, **others}
        self._backend = open_batch(given, 1, AutoresetMode.DISABLED, backend)
        self._block = self._backend.block
        self.engine = self._backend.engine()
        names = self._backend.learners
        lowered = [name.lower() for name in names]
        self.possible_agents = lowered if len(set(lowered)) == len(names) else list(names)
        self.agents: list[str] = []
        self.render_mode = render_mode
        # By name, too, as PettingZoo's wrappers and skrl read them.
        climbs = (others.get("climb_mps") or 0) > 0
        self.observation_spaces = {agent: observation_space(climbs) for agent in self.possible_agents}
        self.action_spaces = {agent: action_space(climbs) for agent in self.possible_agents}
        self._random = np.random.default_rng()
        self._is_reset = self._is_closed = False

    def observation_space(self, agent: str) -> gym.spaces.Box:
        """The observation space of an agent; always one object, as PettingZoo requires."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> gym.spaces.Box:
        """The action space of an agent; always one object, as PettingZoo requires."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Floats], dict[str, dict[str, Any]]]:
        """Begins a new episode; equal seeds give equal ones."""
        self._assert_open()
        if seed is not None:
            self._random, _ = seeding.np_random(seed)
        self._backend.reset(seeds_of(seed, 1, self._is_reset, self._random), None)
        self._is_reset = True
        self.agents = list(self.possible_agents)
        return self._seen(), self._infos()

    def step(
        self, actions: dict[str, Floats]
    ) -> tuple[
        dict[str, Floats], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]
    ]:
        """Makes the decisions of all agents whose turn it is."""
        self._assert_open()
        if not self.agents:
            raise SkeinError("the episode has ended, or was not begun: reset() begins one")
        for number, agent in enumerate(self.possible_agents):
            if agent not in actions:
                raise ValueError(f"actions: expected one of {agent}, got {', '.join(actions) or 'none'}")
            chosen = np.asarray(actions[agent])
            shape = self.action_spaces[agent].shape
            if chosen.shape != shape or chosen.dtype.kind not in "fiu":
                raise ValueError(
                    f"action of {agent}: expected a number of shape {shape}, got {chosen.dtype} of shape {chosen.shape}"
                )
            self._block.actions[number, :, 0] = chosen
        self._backend.step()
        block = self._block
        terminated, truncated = bool(block.terminated[0]), bool(block.truncated[0])
        result = (
            self._seen(),
            {agent: float(block.rewards[number, 0]) for number, agent in enumerate(self.possible_agents)},
            dict.fromkeys(self.possible_agents, terminated),
            dict.fromkeys(self.possible_agents, truncated),
            self._infos(),
        )
        if terminated or truncated:
            self.agents = []
        return result

    def render(self) -> NDArray[np.uint8] | None:
        """A picture, (200, 200, 3), if ``render_mode`` is ``'rgb_array'``."""
        return None if self.render_mode is None else picture(self._block.observations[-1, :, 0])

    def close(self) -> None:
        """Releases the environment."""
        if not self._is_closed:
            self._is_closed = True
            self._backend.close()

    def _assert_open(self) -> None:
        if self._is_closed:
            raise SkeinError("the environment is closed")

    def _seen(self) -> dict[str, Floats]:
        return {agent: self._block.observations[number, :, 0].copy() for number, agent in enumerate(self.possible_agents)}

    def _infos(self) -> dict[str, dict[str, Any]]:
        block = self._block
        return {
            agent: {
                "distance_m": float(block.distance[number, 0]),
                "time_s": float(block.time[0]),
                "decides": bool(block.due[number, 0]),
            }
            for number, agent in enumerate(self.possible_agents)
        }
