"""Gymnasium and PettingZoo environments as simulators that flights step."""

from __future__ import annotations

import json
import math
import tempfile
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from socketserver import StreamRequestHandler, ThreadingUnixStreamServer
from typing import Any, NamedTuple

#: Maximum size of a line that a flight sends: a line has at most a velocity for each vehicle.
_LONGEST_LINE = 1 << 20


class Body(NamedTuple):
    """A vehicle's position, velocity and heading: north, east, down, m and m/s; heading from north towards east, rad."""

    position_ned: tuple[float, float, float]
    velocity_ned: tuple[float, float, float]
    heading_rad: float = 0.0


class EnvironmentSimulator:
    """Serves an environment to one flight after another; each begins with a reset with `seed`.

    The flight steps the environment: so it can be paused, stepped, or run by the clock.

    Parameters
    ----------
    env : gymnasium.Env or pettingzoo.ParallelEnv
    step_s : float
        Simulated time of one step of the environment, s.
    vehicles : mapping
        Maps names of the flight's vehicles to the environment's agents; a Gymnasium environment has one, None.
    body : callable
        Maps an agent and its observation to a `Body`.
    action : callable
        Maps an agent, its observation and its commanded velocity, (north, east, down), m/s, to its action.
    seed : int
        Seed of every reset.

    Attributes
    ----------
    path : Path
        The socket.

    Examples
    --------
    ``examples/foreign-environment/tag.py``.
    """

    def __init__(
        self,
        env: Any,
        *,
        step_s: float,
        vehicles: Mapping[str, Any],
        body: Callable[[Any, Any], Body],
        action: Callable[[Any, Any, tuple[float, float, float]], Any],
        seed: int = 0,
    ) -> None:
        if not step_s > 0:
            raise ValueError(f"step_s: expected more than 0, got {step_s}")
        self.env, self.step_s, self.vehicles, self.seed = env, step_s, dict(vehicles), seed
        self._single = not hasattr(env, "possible_agents")
        if self._single and len(self.vehicles) != 1:
            raise ValueError(f"vehicles: expected one, since a Gymnasium environment has one agent, got {len(self.vehicles)}")
        self._body, self._action = body, action
        self._folder = tempfile.TemporaryDirectory(prefix="skein-")
        self.path = Path(self._folder.name) / "environment"
        busy = threading.Lock()
        simulator = self

        class Flight(StreamRequestHandler):
            def handle(self) -> None:
                # A second flight would step the first one's world.
                with busy:
                    while line := self.rfile.readline(_LONGEST_LINE):
                        try:
                            self.wfile.write(simulator._answer(line))
                        except OSError:  # the flight has ended
                            return

        self._server = ThreadingUnixStreamServer(str(self.path), Flight)
        self._server.daemon_threads = True
        self._server.block_on_close = False
        threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True).start()

    def __enter__(self) -> EnvironmentSimulator:
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._folder.cleanup()

    def reset(self) -> None:
        """Begins an episode."""
        seen, _ = self.env.reset(seed=self.seed)
        self._seen = {None: seen} if self._single else dict(seen)
        self._ended: dict[Any, tuple[bool, bool]] = {agent: (False, False) for agent in self.vehicles.values()}
        self._rewards = dict.fromkeys(self.vehicles.values(), 0.0)

    def step(self, velocities_ned: Mapping[str, tuple[float, float, float]]) -> dict[str, float]:
        """Steps the environment once, each vehicle with its commanded velocity; a vehicle that has ended stays in place.

        Returns
        -------
        dict
            The vehicles' rewards.
        """
        flying = {name: agent for name, agent in self.vehicles.items() if not any(self._ended[agent])}
        self._rewards = dict.fromkeys(self.vehicles.values(), 0.0)
        if flying:
            actions = {agent: self._action(agent, self._seen[agent], velocities_ned[name]) for name, agent in flying.items()}
            if self._single:
                told = [{None: one} for one in self.env.step(actions[None])]
            else:
                told = list(self.env.step(actions))
            seen, rewards, terminated, truncated = told[:4]
            self._seen.update(seen)
            for agent in flying.values():
                self._rewards[agent] = float(rewards.get(agent, 0.0))
                self._ended[agent] = (bool(terminated.get(agent, True)), bool(truncated.get(agent, False)))
        return {name: self._rewards[agent] for name, agent in self.vehicles.items()}

    def _answer(self, line: bytes) -> bytes:
        try:
            asked = json.loads(line)
            if "velocities" in asked:
                self.step({name: tuple(asked["velocities"][name]) for name in self.vehicles})
            else:
                self.reset()
            told: dict[str, Any] = {"stepS": self.step_s, "vehicles": {name: self._told(agent) for name, agent in self.vehicles.items()}}
        except Exception as mistake:
            told = {"error": f"{type(mistake).__name__}: {mistake}"}
        return json.dumps(told).encode() + b"\n"

    def _told(self, agent: Any) -> dict[str, Any]:
        body = self._body(agent, self._seen[agent])
        numbers = [*map(float, body.position_ned), *map(float, body.velocity_ned), float(body.heading_rad)]
        if len(numbers) != 7 or not all(map(math.isfinite, numbers)):
            raise ValueError(f"body: expected finite numbers, three, three and one, got {body}")
        terminated, truncated = self._ended[agent]
        return {"body": numbers, "reward": self._rewards[agent], "terminated": terminated, "truncated": truncated}
