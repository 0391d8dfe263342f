"""Sends what nobody should: garbage as messages, a frame that is none, another type on a topic.

usage: disturb.py DOMAIN COUNT
"""

import os
import random
import sys
import time

os.environ["ROS_DOMAIN_ID"] = sys.argv[1]
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import rclpy
from geometry_msgs.msg import PoseStamped, Twist, TwistStamped
from rclpy.serialization import serialize_message

COUNT = int(sys.argv[2])
random.seed(1)
rclpy.init()
node = rclpy.create_node("disturber")
velocity = node.create_publisher(TwistStamped, "/a/cmd_vel", 10)
pose = node.create_publisher(PoseStamped, "/b/setpoint_pose", 10)
foreign = node.create_publisher(Twist, "/c/cmd_vel", 10)
patience = time.monotonic() + 20
while velocity.get_subscription_count() + pose.get_subscription_count() < 2 and time.monotonic() < patience:
    rclpy.spin_once(node, timeout_sec=0.1)
intact = serialize_message(TwistStamped())
for number in range(COUNT):
    velocity.publish(intact[:4] + random.randbytes(random.randrange(64)))
    if number % 50 == 0:
        elsewhere = PoseStamped()
        elsewhere.header.frame_id = "elsewhere"
        pose.publish(elsewhere)
        foreign.publish(Twist())
        time.sleep(0.02)
time.sleep(3)
print("PASSED")
node.destroy_node()
rclpy.shutdown()
