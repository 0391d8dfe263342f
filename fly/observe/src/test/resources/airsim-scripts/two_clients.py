"""Two clients, one to read and one to command; it leaves without an end of its last move."""

import sys
import time

import airsim

import inside

reading = airsim.MultirotorClient(port=int(sys.argv[1]))
flying = airsim.MultirotorClient(port=int(sys.argv[1]))
flying.ping()
until = time.monotonic() + float(sys.argv[2])
while time.monotonic() < until:
    state = reading.getMultirotorState("Evader1")
    inside.commanded(state)
    flying.moveByVelocityZAsync(3, 0, -20, 60, vehicle_name="Evader1")
    time.sleep(0.1)
inside.told()
