"""PettingZoo's pursuit game as a simulator, flown by Skein's loops. Run it from the repository's root."""

import subprocess
import sys
import tempfile
from pathlib import Path

import duckdb
import numpy as np
from mpe2 import simple_tag_v3
from skein_uav.simulators import Body, EnvironmentSimulator

M = 10.0  # of one unit of the game: its agents then drive 10 and 13 m/s at most
VEHICLES = {"Evader": "agent_0", **{f"Pursuer{n + 1}": f"adversary_{n}" for n in range(3)}}


def game():
    return simple_tag_v3.parallel_env(
        num_good=1, num_adversaries=3, num_obstacles=0, max_cycles=10_000, continuous_actions=True
    )


def body(agent, seen):
    (ve, vn), (e, n) = seen[0:2] * M, seen[2:4] * M
    return Body((n, e, 0.0), (vn, ve, 0.0))


def action(agent, seen, velocity):
    """Pushes against the error of the velocity: nothing, left, right, down, up, each from 0 to 1."""
    east, north = (np.array([velocity[1], velocity[0]]) - seen[0:2] * M) / M
    return np.clip([0, -east, east, -north, north], 0, 1).astype(np.float32)


def simulator():
    return EnvironmentSimulator(game(), step_s=0.1, vehicles=VEHICLES, body=body, action=action, seed=7)


folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp(prefix="tag-"))
with simulator() as served:
    subprocess.run(["./sbtw", f"foreignEnvironment/run {served.path} {folder}"], check=True)

# The paused flight's commands, in the game's own loop.
with duckdb.connect(str(folder / "paused-none.duckdb"), read_only=True) as recording:
    sent = {
        name: recording.execute(
            "SELECT velocityNorthMps, velocityEastMps FROM command WHERE vehicle = ? ORDER BY sequence", [name]
        ).fetchall()
        for name in VEHICLES
    }
    recorded = recording.execute(
        "SELECT sequence, vehicle, numbers[1] FROM measurement WHERE sensor = 'environment' ORDER BY sequence"
    ).fetchall()
steps = len(sent["Evader"])
with simulator() as own:
    own.reset()
    rewards = [own.step({name: (*sent[name][step], 0.0) for name in VEHICLES}) for step in range(steps)]
flown = [(step, name, reward) for step, name, reward in recorded if step <= steps]
assert len(flown) == steps * len(VEHICLES)
assert all(rewards[step - 1][name] == reward for step, name, reward in flown)
print(f"paused: {len(flown)} rewards of {steps} steps are those of the game's own loop, to the digit")
