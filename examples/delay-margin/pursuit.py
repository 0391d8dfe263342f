"""The paper's pursuit as a script with AirSim's Python client writes it: read both, decide, command both, sleep.

    ./skein margin --scenario duel -- python examples/delay-margin/pursuit.py {port}

Needs `pip install msgpack-rpc-python airsim`. Both vehicles hover at the scenario's starts when it begins, 21 m apart.
"""

import math
import sys
import time

import airsim

PERIOD_S = 0.1
# The evader's own frame has its origin where it starts, 21 m north of the pursuer's.
EVADER_STARTS_NORTH_M = 21.0


def pursuer_heading(to_evader, heading, elapsed_s):
    """Turns towards the side on which the evader is, at 1 rad/s."""
    dx, dy = to_evader
    x = dx * math.cos(heading) + dy * math.sin(heading)
    y = -dx * math.sin(heading) + dy * math.cos(heading)
    side = math.copysign(1, y) if y != 0 else (1 if x < 0 else 0)
    return heading + side * elapsed_s


def evader_heading(to_evader, pursuer, radius=8.0):
    """Into safety inside a turning circle of the pursuer; at a right angle near it; else straight away."""
    dx, dy = to_evader
    x = dx * math.cos(pursuer) + dy * math.sin(pursuer)
    y = -dx * math.sin(pursuer) + dy * math.cos(pursuer)
    if x * x + (y - radius) ** 2 < radius**2:
        return pursuer + math.atan2(y + radius, x)
    if x * x + (y + radius) ** 2 < radius**2:
        return pursuer + math.atan2(y - radius, x)
    if x * x + y * y < 4 * radius**2:
        return pursuer + math.atan2(y, x) + math.pi / 2
    return pursuer + math.atan2(y, x)


def main(port):
    client = airsim.MultirotorClient(port=port)
    headings = {"Evader": math.cos(0.5), "Pursuer": 0.0}
    before = None
    while True:
        evader = client.getMultirotorState("Evader").kinematics_estimated.position
        pursuer = client.getMultirotorState("Pursuer").kinematics_estimated.position
        now = time.monotonic()
        elapsed = 0.0 if before is None else now - before
        before = now
        to_evader = (
            evader.x_val + EVADER_STARTS_NORTH_M - pursuer.x_val,
            evader.y_val - pursuer.y_val,
        )
        old = dict(headings)
        headings["Evader"] = evader_heading(to_evader, old["Pursuer"])
        headings["Pursuer"] = pursuer_heading(to_evader, old["Pursuer"], elapsed)
        for name, speed in (("Evader", 5), ("Pursuer", 10)):
            heading = headings[name]
            client.moveByVelocityZAsync(
                speed * math.cos(heading), speed * math.sin(heading), -20, 10, vehicle_name=name
            )
        time.sleep(PERIOD_S)


if __name__ == "__main__":
    main(int(sys.argv[1]))
