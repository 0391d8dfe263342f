import json
import socket

import numpy as np
import pytest

from skein_uav.simulators import Body, EnvironmentSimulator


class Point:
    """Gymnasium's interface: a point that follows its velocity, and ends 3 m north of the origin."""

    def reset(self, seed=None):
        self.at = np.array([0.1 * seed, 0.0])
        return self.at.copy(), {}

    def step(self, action):
        self.at += 0.1 * action
        return self.at.copy(), -float(np.hypot(*self.at)) / 3, bool(self.at[0] >= 3), False, {}


class Pair:
    """PettingZoo's interface: two points, of which one leaves after a step."""

    possible_agents = ["a", "b"]

    def reset(self, seed=None):
        self.steps = 0
        return {agent: np.zeros(2) for agent in self.possible_agents}, {}

    def step(self, actions):
        self.steps += 1
        assert set(actions) == ({"a", "b"} if self.steps == 1 else {"a"})
        told = {agent: np.full(2, self.steps) for agent in actions}
        return told, dict.fromkeys(actions, 0.5), {"a": False, "b": True}, dict.fromkeys(actions, False), {}


def body(agent, seen):
    return Body((seen[0], seen[1], -2.0), (1.0, 0.0, 0.0), 0.5)


def action(agent, seen, velocity):
    return np.array(velocity[:2])


class Flight:
    def __init__(self, simulator):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(str(simulator.path))
        self.lines = self.socket.makefile("r")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lines.close()
        self.socket.close()

    def ask(self, **question):
        self.socket.sendall(json.dumps(question).encode() + b"\n")
        return json.loads(self.lines.readline())


def test_a_flight_steps_a_gymnasium_environment_until_it_ends():
    one = EnvironmentSimulator(Point(), step_s=0.1, vehicles={"One": None}, body=body, action=action, seed=3)
    with one as simulator, Flight(simulator) as flight:
        assert flight.ask() == {
            "stepS": 0.1,
            "vehicles": {
                "One": {"body": [0.1 * 3, 0, -2, 1, 0, 0, 0.5], "reward": 0, "terminated": False, "truncated": False}
            },
        }
        own = Point()
        own.reset(seed=3)
        for _ in range(20):
            told = flight.ask(velocities={"One": [7, 1.5, 0]})["vehicles"]["One"]
            if not own.at[0] >= 3:
                seen, reward, ended, _, _ = own.step(np.array([7, 1.5]))
                assert (told["reward"], told["terminated"], told["body"][:2]) == (reward, ended, list(seen))
        # It has ended, and stays unchanged.
        assert (told["reward"], told["terminated"], told["body"][0]) == (0, True, own.at[0])
        assert flight.ask()["vehicles"]["One"]["terminated"] is False


def test_an_agent_that_leaves_stays_where_it_was_while_the_other_goes_on():
    vehicles = {"A": "a", "B": "b"}
    pair = EnvironmentSimulator(Pair(), step_s=1, vehicles=vehicles, body=body, action=action)
    with pair as simulator, Flight(simulator) as flight:
        flight.ask()
        still = {"A": [0, 0, 0], "B": [0, 0, 0]}
        told = [flight.ask(velocities=still)["vehicles"] for _ in range(2)]
    assert [(one["A"]["body"][0], one["B"]["body"][0]) for one in told] == [(1, 1), (2, 1)]
    assert [(one["A"]["reward"], one["B"]["reward"], one["B"]["terminated"]) for one in told] == [
        (0.5, 0.5, True),
        (0.5, 0, True),
    ]


def test_mistakes_are_told_to_the_flight_and_to_who_begins():
    def lost(agent, seen):
        return Body((np.nan, 0, 0), (0, 0, 0))

    astray = EnvironmentSimulator(Point(), step_s=0.1, vehicles={"One": None}, body=lost, action=action)
    with astray as simulator, Flight(simulator) as flight:
        assert "expected finite numbers" in flight.ask()["error"]
    with pytest.raises(ValueError, match="step_s: expected more than 0"):
        EnvironmentSimulator(Point(), step_s=0, vehicles={"One": None}, body=body, action=action)
    with pytest.raises(ValueError, match="expected one, since a Gymnasium environment has one agent, got 2"):
        EnvironmentSimulator(Point(), step_s=1, vehicles={"One": None, "Two": None}, body=body, action=action)


def test_rewards_of_a_mujoco_environment_are_those_of_its_own_loop_to_the_digit():
    gymnasium = pytest.importorskip("gymnasium")
    pytest.importorskip("mujoco")

    def jacobian(seen):
        """The fingertip's position, differentiated by the two joints' angles: links of 10 and 11 cm."""
        cos_1, cos_2, sin_1, sin_2 = seen[0:4]
        cos, sin = cos_1 * cos_2 - sin_1 * sin_2, sin_1 * cos_2 + cos_1 * sin_2
        return np.array([[-0.1 * sin_1 - 0.11 * sin, -0.11 * sin], [0.1 * cos_1 + 0.11 * cos, 0.11 * cos]])

    def fingertip(agent, seen):
        (x, y), (vx, vy) = seen[4:6] + seen[8:10], jacobian(seen) @ seen[6:8]
        return Body((x, y, 0.0), (vx, vy, 0.0))

    def torques(agent, seen, velocity):
        error = np.array(velocity[:2]) - jacobian(seen) @ seen[6:8]
        return np.clip(3 * jacobian(seen).T @ error, -1, 1).astype(np.float32)

    served = EnvironmentSimulator(
        gymnasium.make("Reacher-v5"), step_s=0.02, vehicles={"Arm": None}, body=fingertip, action=torques, seed=11
    )
    own = gymnasium.make("Reacher-v5")
    seen, _ = own.reset(seed=11)
    rewards, ends = [], []
    with served as simulator, Flight(simulator) as flight:
        told = flight.ask()["vehicles"]["Arm"]
        for step in range(60):
            velocity = [0.2 * np.cos(0.1 * step), 0.2 * np.sin(0.1 * step), 0.0]
            told = flight.ask(velocities={"Arm": velocity})["vehicles"]["Arm"]
            if not any(ends):
                seen, reward, terminated, truncated, _ = own.step(torques(None, seen, velocity))
                assert (told["reward"], told["terminated"], told["truncated"]) == (reward, terminated, truncated)
                assert told["body"][:2] == list(fingertip(None, seen).position_ned[:2])
                rewards.append(reward)
                ends.append(truncated)
    # The environment's limit of steps ends the episode; the arm has moved.
    assert len(rewards) == 50 and ends[-1]
    assert len(set(rewards)) == 50
