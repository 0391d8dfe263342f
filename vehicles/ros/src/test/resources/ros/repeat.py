"""Flies three vehicles to their goals by simulated time, and prints a digest of where they were.

usage: repeat.py DOMAIN STOPS NAME...   STOPS of the clock after which it ends
"""

import hashlib
import os
import struct
import sys
import time

os.environ["ROS_DOMAIN_ID"] = sys.argv[1]
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.parameter import Parameter

STOPS, NAMES = int(sys.argv[2]), sys.argv[3:]


class Pilot(Node):
    def __init__(self):
        super().__init__("pilot", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.places = {name: [] for name in NAMES}
        self.commands = {}
        for name in NAMES:
            self.create_subscription(Odometry, f"/{name}/odom", lambda m, n=name: self.see(n, m), 10)
            self.commands[name] = self.create_publisher(TwistStamped, f"/{name}/cmd_vel", 10)
        self.create_timer(0.1, self.fly)

    def see(self, name, message):
        at = message.pose.pose.position
        self.places[name].append((at.x, at.y, at.z))

    def fly(self):
        if not all(self.places.values()):
            return
        for number, name in enumerate(NAMES):
            goal = (5.0 * number, 10.0 - 4.0 * number, 6.0 + number)
            command = TwistStamped()
            command.header.stamp = self.get_clock().now().to_msg()
            command.header.frame_id = "map"
            v = command.twist.linear
            v.x, v.y, v.z = (max(-3.0, min(3.0, 0.5 * (g - p))) for g, p in zip(goal, self.places[name][-1]))
            self.commands[name].publish(command)

    def flown(self, name):
        """Its places from the last one at rest on."""
        places = self.places[name]
        moved = next((i for i, place in enumerate(places) if place != places[0]), len(places))
        return places[moved:]


rclpy.init()
pilot = Pilot()
until = time.monotonic() + 120
while time.monotonic() < until and any(len(pilot.flown(name)) < STOPS for name in NAMES):
    rclpy.spin_once(pilot, timeout_sec=0.5)
digest = hashlib.sha256()
for name in NAMES:
    places = pilot.flown(name)[:STOPS]
    assert len(places) == STOPS, f"{name}: {len(places)} of {STOPS} stops within two minutes"
    print(f"{name}: from {places[0]} to {places[-1]}")
    for place in places:
        digest.update(struct.pack("<3d", *place))
print(f"PASSED {digest.hexdigest()}")
pilot.destroy_node()
rclpy.shutdown()
