"""Reads vehicles d0, d1, … and commands each 20 times a second, to measure what that costs `serve --ros`.

usage: fly_many.py DOMAIN SECONDS VEHICLES
"""

import os
import sys
import time

os.environ["ROS_DOMAIN_ID"] = sys.argv[1]
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry

seconds, vehicles = float(sys.argv[2]), int(sys.argv[3])
rclpy.init()
node = rclpy.create_node("fly_many")
altitudes, received, publishers = {}, 0, []


def see(number, message):
    global received
    received += 1
    altitudes[number] = message.pose.pose.position.z


def fly():
    for number, publisher in enumerate(publishers):
        command = TwistStamped()
        command.header.frame_id = "map"
        command.header.stamp = node.get_clock().now().to_msg()
        command.twist.linear.z = max(-2.0, min(2.0, 5.0 - altitudes.get(number, 0.0)))
        publisher.publish(command)


for number in range(vehicles):
    node.create_subscription(Odometry, f"/d{number}/odom", lambda m, n=number: see(n, m), 1)
    publishers.append(node.create_publisher(TwistStamped, f"/d{number}/cmd_vel", 10))
node.create_timer(0.05, fly)
until = time.monotonic() + seconds
while time.monotonic() < until:
    rclpy.spin_once(node, timeout_sec=0.1)
print(f"{received / seconds:.0f} odometry messages a second, altitudes {min(altitudes.values()):.2f} to "
      f"{max(altitudes.values()):.2f} m")
