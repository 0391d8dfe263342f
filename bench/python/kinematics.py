"""Kinematics requests in sequence by the official AirSim client. Arguments: port, vehicle, seconds.

Prints requests per second, p50 and p99 in microseconds, and as a witness the last altitude read.
"""

import sys
import time

import airsim

port, vehicle, seconds = int(sys.argv[1]), sys.argv[2], float(sys.argv[3])
client = airsim.MultirotorClient(port=port)
for _ in range(500):
    client.simGetGroundTruthKinematics(vehicle)
took = []
end = time.perf_counter() + seconds
while time.perf_counter() < end:
    started = time.perf_counter()
    state = client.simGetGroundTruthKinematics(vehicle)
    took.append(time.perf_counter() - started)
took.sort()
rate = len(took) / sum(took)
print(f"{rate:.0f} {took[len(took) // 2] * 1e6:.0f} {took[len(took) * 99 // 100] * 1e6:.0f} {state.position.z_val:.3f}")
