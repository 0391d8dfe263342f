"""Two threads: one reads, one commands a hundred times a second and looks at no answer."""

import sys
import threading
import time

import airsim

import inside

port, seconds = int(sys.argv[1]), float(sys.argv[2])
until = time.monotonic() + seconds
newest = None


def read():
    global newest
    client = airsim.MultirotorClient(port=port)
    while time.monotonic() < until:
        newest = client.getMultirotorState("Evader1")
        time.sleep(0.02)


def command():
    client = airsim.MultirotorClient(port=port)
    client.ping()
    while time.monotonic() < until:
        if newest is not None:
            inside.commanded(newest)
            client.moveByVelocityZAsync(3, 0, -20, 5, vehicle_name="Evader1")
        time.sleep(0.01)


# It does not wait for them: so many moves can freeze the simulator.
for work in (read, command):
    threading.Thread(target=work, daemon=True).start()
time.sleep(seconds)
inside.told()
