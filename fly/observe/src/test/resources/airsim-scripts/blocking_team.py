"""One client, blocking: four vehicles, read one after the other."""

import sys
import time

import airsim

import inside

NAMES = ["Evader1", "Pursuer1", "Evader2", "Pursuer2"]

client = airsim.MultirotorClient(port=int(sys.argv[1]))
until = time.monotonic() + float(sys.argv[2])
while time.monotonic() < until:
    states = {name: client.getMultirotorState(name) for name in NAMES}
    for name in NAMES:
        if name == "Evader1":
            inside.commanded(states[name])
        client.moveByVelocityZAsync(3, 0, -20, 5, vehicle_name=name)
    time.sleep(0.05)
for name in NAMES:
    client.hoverAsync(name).join()
inside.told()
