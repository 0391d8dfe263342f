"""One client, blocking: a picture in each turn of the control loop."""

import sys
import time

import airsim

import inside

client = airsim.MultirotorClient(port=int(sys.argv[1]))
until = time.monotonic() + float(sys.argv[2])
while time.monotonic() < until:
    state = client.getMultirotorState("Evader1")
    client.simGetImages([airsim.ImageRequest("0", airsim.ImageType.Scene, False, False)], "Evader1")
    inside.commanded(state)
    client.moveByVelocityZAsync(3, 0, -20, 5, vehicle_name="Evader1")
    time.sleep(0.02)
client.hoverAsync("Evader1").join()
inside.told()
