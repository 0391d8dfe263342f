"""Environments of Gymnasium: a scenario under a loop's real timing, over a link.

In ``skein_uav/Pursuit-v0`` the learner is a pursuer, in ``skein_uav/Evasion-v0`` an evader, by default of the duel; other
vehicles use their own policies.

A step is one decision of the learner, at the moment at which the loop decides. Observations are old, and actions take
effect later, by the delays of the link.

Observation, 9 numbers (float32), in the frame whose x-axis is the learner's last commanded heading:

== ================= ===== ====================================================
0  ahead             m     the opponent's position by the readings
1  right             m
2  ahead             m/s   its velocity minus the learner's
3  right             m/s
4  cosine            1     of its last commanded heading, from the learner's
5  sine              1
6  elapsed           s     since the learner's previous decision; 0 at the first
7  own age           s     of the learner's own reading, since physics was sampled
8  opponent's age    s     of the opponent's reading
== ================= ===== ====================================================

Action, 1 number from -1 to 1 (values beyond are clipped): an immediate turn to the right, as a share of the largest one.
That is 1 rad/s times the time since the learner's previous decision, so an episode's first action turns nothing; for an
evader half a turn. With ``turn_rate_rad_per_s`` it is, for both, that rate times that time.

With ``climb_mps`` the learner also climbs and sinks, by the plants ``tilt`` and ``quadrotor``. Its action has a second
number from -1 to 1: the vertical speed, positive up, as a share of ``climb_mps``. Its observation has four more numbers, all
positive up:

== ================= ===== ====================================================
9  height            m     the opponent's above the learner
10 vertical speed    m/s   the opponent's minus the learner's
11 altitude          m     the learner's, above z = 0
12 vertical speed    m/s   the learner's
== ================= ===== ====================================================

Distances, also those of rewards and captures, are then in space.

Reward of a pursuer: minus the distance to its nearest opponent divided by 10 m, once a period, and 10 for a capture. Of an
evader: the opposite. ``objective`` may replace the distance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from . import arguments
from .batch import CLIMBING, Backend, Flags, Floats, InProcess
from .errors import SkeinError
from .seeds import folded
from .pictures import picture
from .served import Served
from .untraceable import shown

_LARGEST_M = 1e5
_LARGEST_MPS = 1e3
_LARGEST_S = 1e4


def observation_space(climbs: bool = False) -> gym.spaces.Box:
    """The observation space of one environment; the module describes its components."""
    most = [_LARGEST_M, _LARGEST_M, _LARGEST_MPS, _LARGEST_MPS, 1.001, 1.001, _LARGEST_S, _LARGEST_S, _LARGEST_S]
    if climbs:
        most += [_LARGEST_M, _LARGEST_MPS] * 2
    least = [0.0 if 6 <= number < 9 else -value for number, value in enumerate(most)]
    return gym.spaces.Box(np.array(least, np.float32), np.array(most, np.float32), dtype=np.float32)


def action_space(climbs: bool = False) -> gym.spaces.Box:
    """The action space of one environment; the module describes its components."""
    return gym.spaces.Box(-1.0, 1.0, (CLIMBING[1] if climbs else 1,), dtype=np.float32)


class PursuitVectorEnv(VectorEnv[Floats, Floats, NDArray[Any]]):
    """Many worlds of a scenario in lockstep, with one learner each; each row of the arrays belongs to one.

    Environments are grouped by 128. Those of a group share a link: their messages have equal delays, and they begin
    together. An episode that ends early, by a capture, is followed by another that lasts until the end of the others.

    Parameters
    ----------
    num_envs : int
        Number of environments.
    learner : str
        ``pursuer``, ``evader`` or another role of the scenario: in environment i the learner is the i-th vehicle of its
        role, modulo their number. Or the name of a vehicle.
    opponent : str
        A policy file or a family's name, for the evaders, or for the pursuers if an evader learns; by default their own.
    loop : {'stream', 'predictive', 'sequential', 'futures', 'paused'}
        The loop whose timing is simulated.
    link : str
        A latency profile: ``none``, ``direct``, ``vpn``, ``vpn-mixed``, ``constant:200ms``, …
    period_ms : float
        Time between decisions for one vehicle, ms.
    plant : str, optional
        The vehicle model: ``reduced``, ``drag``, ``quadrotor``, ``tilt`` or a model file; by default ``reduced`` at 20 m
        altitude and ``drag`` at others, or ``tilt`` if a policy may climb.
    sensors : str
        Errors of readings, such as ``position=0.1,velocity=0.05,dropout=2%`` (standard deviations in m and m/s); by default
        readings are true.
    altitude_m : float, optional
        Altitude of all vehicles at the start; by default the scenario's.
    episode_s : float
        Duration of an episode, s.
    capture_radius_m : float
        Distance at which an episode ends; 0: at none.
    start_within_m : (float, float)
        Least and greatest initial distance of one of two vehicles from the other (of the evader from the pursuer), in any
        direction, with any headings; of each of more vehicles from its usual start; (0, 0): the scenario's start.
    moves_in_flight : int
        Maximum number of unanswered commands to a vehicle.
    scenario : str
        The paper's ``duel``, or for example ``surround``.
    settings : mapping, optional
        Settings of the scenario, for example ``{"vehicles": 4}``.
    objective : str
        The reward instead of the distance to the nearest opponent: a sum of the scenario's measures that are means over
        time, or one root mean square, for example ``off-ring``, by its squares; an evader maximises it and others minimise
        it, unless ``minimise`` or ``maximise`` precedes it.
    turn_rate_rad_per_s : float, optional
        Greatest turn rate of the learner. By default 1 rad/s; an evader's actions are immediate turns.
    climb_mps : float
        Greatest vertical speed of the learner, m/s; 0: it keeps the altitude of its start.
    autoreset_mode : AutoresetMode or str
        When an ended episode is reset, as Gymnasium defines it.
    copy : bool
        Whether observations are copies; if not, the next step overwrites them.
    render_mode : {None, 'rgb_array'}
        A picture of each environment, seen by the learner.
    backend : {'process', 'socket', 'unix:PATH'}
        Java in this process; in a process of its own; in that of a `skein_uav.served.Server`, for processes that fork.

    Attributes
    ----------
    engine : str
        The engine: environments are simulated together (``SIMD, …``), or one by one if that is not supported, some
        hundred times slower (``scalar: …``, with the reason).

    Raises
    ------
    ValueError
        If a setting is invalid; the message states what was expected and what was given.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10, "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        num_envs: int = 1,
        *,
        learner: str = "pursuer",
        opponent: str = "",
        loop: str = "stream",
        link: str = "vpn",
        period_ms: float = 100.0,
        plant: str = "",
        sensors: str = "",
        altitude_m: float | None = None,
        episode_s: float = 60.0,
        capture_radius_m: float = 0.0,
        start_within_m: tuple[float, float] = (0.0, 0.0),
        moves_in_flight: int = 2,
        scenario: str = "duel",
        settings: Mapping[str, Any] | None = None,
        objective: str = "",
        turn_rate_rad_per_s: float | None = None,
        climb_mps: float = 0.0,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        render_mode: str | None = None,
        backend: str = "process",
    ) -> None:
        if not isinstance(num_envs, int) or num_envs < 1:
            raise ValueError(f"num_envs: expected a whole number from 1, got {num_envs!r}")
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode: expected None or 'rgb_array', got {render_mode!r}")
        self.num_envs = num_envs
        self.copy = copy
        self.render_mode = render_mode
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self.autoreset_mode}
        self.single_observation_space = observation_space(climb_mps > 0)
        self.single_action_space = action_space(climb_mps > 0)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        given = {
            "learners": learner,
            "opponent": opponent,
            "loop": loop,
            "link": link,
            "period_ms": period_ms,
            "plant": plant,
            "sensors": sensors,
            "altitude_m": altitude_m,
            "episode_s": episode_s,
            "capture_radius_m": capture_radius_m,
            "start_within_m": start_within_m,
            "moves_in_flight": moves_in_flight,
            "scenario": scenario,
            "settings": settings,
            "objective": objective,
            "turn_rate_rad_per_s": turn_rate_rad_per_s,
            "climb_mps": climb_mps,
        }
        self._backend = open_batch(given, num_envs, self.autoreset_mode, backend)
        self._block = self._backend.block
        if len(self._backend.learners) > 1:
            self._backend.close()
            raise ValueError(
                f"learner: expected one in a world, got {', '.join(self._backend.learners)}; "
                "skein_uav.parallel has several"
            )
        self._observations = self._block.observations[0].T
        self._finals = self._block.finals[0].T
        self._actions = self._block.actions[0]
        self._all = np.ones(num_envs, dtype=np.bool_)
        self._is_reset = False
        self.engine = self._backend.engine()

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begins new episodes.

        Parameters
        ----------
        seed : int, sequence of int, or None
            Environment i uses ``seed + i``, or the i-th seed: integers from 0 of any size
            (`skein_uav.seeds.folded`); equal seeds give equal episodes, to the last bit. None: continues.
        options : dict, optional
            ``reset_mask``, an array of bool: only these are reset.

        Returns
        -------
        observations : ndarray, shape (num_envs, 9), or (num_envs, 13) if the learner climbs
        infos : dict
            ``distance_m`` and ``time_s``, one value per environment.
        """
        self._assert_open()
        super().reset(seed=seed if isinstance(seed, int) else None)
        mask = _mask(options, self.num_envs)
        if mask is not None and not self._is_reset:
            raise ValueError("reset_mask: expected a reset of all environments before one of some")
        self._backend.reset(seeds_of(seed, self.num_envs, self._is_reset, self.np_random), mask)
        self._is_reset = True
        return self._seen(), self._infos()

    def step(self, actions: Floats) -> tuple[Floats, Floats, Flags, Flags, dict[str, Any]]:
        """Makes one decision in every environment.

        Parameters
        ----------
        actions : ndarray, shape (num_envs, 1), or (num_envs, 2) if the learner climbs

        Returns
        -------
        observations : ndarray of float32, as those of `reset`
        rewards : ndarray of float32, shape (num_envs,)
        terminations, truncations : ndarray of bool, shape (num_envs,)
        infos : dict
            ``distance_m`` at the last score, ``time_s`` of the episode; under same-step autoreset those of the episode
            that ended, in addition to ``final_obs`` and ``final_info``.

        Raises
        ------
        ValueError
            If actions have another shape or type, or are not finite; then nothing is done.
        SkeinError
            If the environment is closed, or an episode has ended and was not reset.
        """
        self._assert_open()
        chosen = np.asarray(actions)
        if chosen.shape != self.action_space.shape or chosen.dtype.kind not in "fiu":
            raise ValueError(
                f"actions: expected numbers of shape {self.action_space.shape}, got {chosen.dtype} of shape {chosen.shape}"
            )
        self._actions[:] = chosen.T
        self._backend.step()
        block = self._block
        terminated, truncated = block.terminated.copy(), block.truncated.copy()
        infos = self._infos()
        if self.autoreset_mode is AutoresetMode.SAME_STEP:
            done = terminated | truncated
            if done.any():
                self._tell_finals(done, infos)
        return self._seen(), block.rewards[0].copy(), terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """One picture per environment, (200, 200, 3), if ``render_mode`` is ``'rgb_array'``."""
        if self.render_mode is None:
            return None
        return tuple(picture(seen) for seen in self._observations)

    def close_extras(self, **kwargs: Any) -> None:
        """Releases the batch."""
        self._backend.close()

    def _assert_open(self) -> None:
        if self.closed:
            raise SkeinError("the environment is closed")

    def _seen(self) -> Floats:
        return self._observations.copy() if self.copy else self._observations

    def _infos(self) -> dict[str, Any]:
        block = self._block
        return {
            "distance_m": block.distance[0].copy(),
            "_distance_m": self._all,
            "time_s": block.time.copy(),
            "_time_s": self._all,
        }

    def _tell_finals(self, done: Flags, infos: dict[str, Any]) -> None:
        finals = np.full(self.num_envs, None, dtype=object)
        for number in np.flatnonzero(done):
            finals[number] = self._finals[number].copy()
        infos["final_obs"], infos["_final_obs"] = finals, done
        infos["final_info"] = {name: infos[name] for name in ("distance_m", "time_s")} | {
            "_distance_m": done,
            "_time_s": done,
        }
        infos["_final_info"] = done


class PursuitEnv(gym.Env[Floats, Floats]):
    """One world; its parameters are those of `PursuitVectorEnv`."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(self, render_mode: str | None = None, **settings: Any) -> None:
        self._one = PursuitVectorEnv(1, autoreset_mode=AutoresetMode.DISABLED, render_mode=render_mode, **settings)
        self.render_mode = render_mode
        self.engine = self._one.engine
        self.observation_space = self._one.single_observation_space
        self.action_space = self._one.single_action_space

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begins a new episode; equal seeds give equal ones."""
        super().reset(seed=seed)
        seen, infos = self._one.reset(seed=seed)
        return seen[0], self._info(infos)

    def step(self, action: Floats) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """Makes one decision."""
        chosen = np.asarray(action)
        shape = self.action_space.shape
        if chosen.shape != shape:
            raise ValueError(f"action: expected a number of shape {shape}, got {chosen.dtype} of shape {chosen.shape}")
        seen, reward, terminated, truncated, infos = self._one.step(chosen[None, :])
        return seen[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), self._info(infos)

    def render(self) -> NDArray[np.uint8] | None:
        """A picture, (200, 200, 3), if ``render_mode`` is ``'rgb_array'``."""
        pictures = self._one.render()
        return None if pictures is None else pictures[0]

    def close(self) -> None:
        """Releases the environment."""
        self._one.close()

    def _info(self, infos: dict[str, Any]) -> dict[str, Any]:
        return {name: float(infos[name][0]) for name in ("distance_m", "time_s")}


def open_batch(settings: dict[str, Any], count: int, autoreset: AutoresetMode, backend: str) -> Backend:
    """Opens a batch with its shared memory; its settings are `learners` and parameters of `PursuitVectorEnv`."""
    own = {f"set.{name}": value for name, value in arguments.texts(settings.pop("settings")).items()}
    settings |= own | _starts(settings.pop("start_within_m", (0.0, 0.0)))
    altitude_m = settings.get("altitude_m")
    if altitude_m is not None and not altitude_m > 0:
        raise ValueError(f"altitude_m: expected more than 0 m, got {altitude_m!r}")
    scenario = settings["scenario"]
    if not isinstance(scenario, str):
        raise TypeError(f"scenario: expected a name, such as 'surround', got {shown(scenario)}")
    moves = settings.get("moves_in_flight")
    if moves is not None and (not isinstance(moves, (int, np.integer)) or isinstance(moves, bool)):
        raise ValueError(f"moves_in_flight: expected a whole number, got {moves!r}")
    settings = {"evader_rate_rad_per_s": settings.get("turn_rate_rad_per_s"), **settings}
    texts = {name: str(value) for name, value in settings.items() if value is not None}
    climbs = (settings.get("climb_mps") or 0) > 0
    number = [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED].index(autoreset)
    if backend == "process":
        return InProcess(texts, count, number, climbs)
    if backend == "socket" or backend.startswith("unix:"):
        return Served(texts, count, number, backend[5:] if backend.startswith("unix:") else None, climbs)
    raise ValueError(f"backend: expected 'process', 'socket' or 'unix:PATH', got {backend!r}")


def _starts(within_m: Any) -> dict[str, Any]:
    """The settings of ``start_within_m``."""
    try:
        least_m, most_m = within_m
    except (TypeError, ValueError):
        raise TypeError(
            f"start_within_m: expected the least and the greatest distance, such as (5, 30), got {within_m!r}"
        ) from None
    return {"start_least_m": least_m, "start_most_m": most_m}


def seeds_of(
    seed: int | Sequence[int | None] | None, count: int, is_reset: bool, random: np.random.Generator
) -> NDArray[np.int64]:
    """A seed for each environment; -1 continues its own sequence, where there is one."""
    if isinstance(seed, (int, np.integer)):
        return np.array([folded(int(seed) + number) for number in range(count)], dtype=np.int64)
    seeds = np.full(count, -1, dtype=np.int64) if is_reset else random.integers(0, 2**62, count)
    if seed is not None:
        if len(seed) != count:
            raise ValueError(f"seed: expected {count} of them, got {len(seed)}")
        for number, one in enumerate(seed):
            if one is not None:
                seeds[number] = folded(one)
    return seeds


def _mask(options: dict[str, Any] | None, count: int) -> Flags | None:
    if options is None or "reset_mask" not in options:
        return None
    mask = np.asarray(options["reset_mask"])
    if mask.shape != (count,) or mask.dtype != np.bool_:
        raise ValueError(f"reset_mask: expected bool of shape {(count,)}, got {mask.dtype} of shape {mask.shape}")
    return mask


for _name, _learner in (("Pursuit", "pursuer"), ("Evasion", "evader")):
    gym.register(
        f"skein_uav/{_name}-v0",
        entry_point="skein_uav.environments:PursuitEnv",
        vector_entry_point="skein_uav.environments:PursuitVectorEnv",
        kwargs={"learner": _learner},
    )
