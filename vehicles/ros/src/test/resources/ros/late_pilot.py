"""A pilot that thinks for too long: it reads odometry, sleeps, and sends a command that is based on that reading.

usage: late_pilot.py DOMAIN SECONDS DELAY_MS STAMPED UNSTAMPED

Commands to the vehicle STAMPED repeat the stamp of the reading in their header, those to UNSTAMPED have none. Prints
the median age of STAMPED's readings when their commands were sent, ms, by simulated time.
"""

import os
import sys

os.environ["ROS_DOMAIN_ID"] = sys.argv[1]
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import threading
import time
from statistics import median

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.qos import qos_profile_sensor_data
from rosgraph_msgs.msg import Clock

LASTS, DELAY, NAMES = float(sys.argv[2]), float(sys.argv[3]) * 1e-3, sys.argv[4:6]

rclpy.init()
node = rclpy.create_node("late_pilot")
readings, clock = {}, {}


def ns(stamp):
    return stamp.sec * 10**9 + stamp.nanosec


def tick(message):
    now, before = ns(message.clock), clock.get("now", ns(message.clock))
    clock.update(now=now, step=now - before or clock.get("step", 0), at=time.monotonic_ns())


def simulated():
    """The simulated time, known to within a step of it."""
    first = clock.setdefault("first", (clock["at"], clock["now"]))
    wall, passed = clock["at"] - first[0], clock["now"] - first[1]
    rate = passed / wall if wall else 0.0
    return clock["now"] + min(rate * (time.monotonic_ns() - clock["at"]), clock["step"])


node.create_subscription(Clock, "/clock", tick, qos_profile_sensor_data)
publishers = []
for name in NAMES:
    node.create_subscription(
        Odometry, f"/{name}/odom", lambda m, n=name: readings.__setitem__(n, m), qos_profile_sensor_data
    )
    publishers.append(node.create_publisher(TwistStamped, f"/{name}/cmd_vel", 10))
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()

patience = time.monotonic() + 20
while not (len(readings) == 2 and clock and all(p.get_subscription_count() >= 2 for p in publishers)):
    if time.monotonic() > patience:
        sys.exit(f"nobody to fly and to be measured by: {list(readings)}, {clock}")
    time.sleep(0.05)

ages = []
end = time.monotonic() + LASTS
while time.monotonic() < end:
    reading = readings[NAMES[0]]
    time.sleep(DELAY)
    for publisher, stamp in zip(publishers, (reading.header.stamp, None)):
        command = TwistStamped()
        command.header.frame_id = "map"
        command.twist.linear.z = 0.2
        if stamp:
            command.header.stamp = stamp
        publisher.publish(command)
        if stamp:
            ages.append((simulated() - ns(stamp)) * 1e-6)
print(f"{len(ages)} commands")
print(f"PASSED {median(ages):.3f}")
os._exit(0)
