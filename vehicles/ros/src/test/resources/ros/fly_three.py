"""A node of rclpy as anybody would write it: a P controller by simulated time flies vehicles to their goals.

usage: fly_three.py DOMAIN SECONDS NAME...   SECONDS by the simulator's clock
"""

import math
import os
import sys

os.environ["ROS_DOMAIN_ID"] = sys.argv[1]
os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import time

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Imu, NavSatFix

LASTS, NAMES = float(sys.argv[2]), sys.argv[3:]


class Pilot(Node):
    def __init__(self):
        super().__init__("pilot", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.odometry, self.counts, self.ages = {}, {}, []
        self.commands, self.started = {}, None
        for number, name in enumerate(NAMES):
            self.create_subscription(Odometry, f"/{name}/odom", lambda m, n=name: self.see(n, m), 10)
            for kind, topic in ((Imu, "imu"), (NavSatFix, "fix")):
                self.create_subscription(
                    kind, f"/{name}/{topic}", lambda m, t=f"{name}/{topic}": self.count(t, m), qos_profile_sensor_data
                )
            self.commands[name] = self.create_publisher(TwistStamped, f"/{name}/cmd_vel", 10)
        self.create_timer(0.05, self.fly)

    def see(self, name, message):
        self.odometry[name] = message
        self.count(f"{name}/odom", message)

    def count(self, topic, message):
        self.counts[topic] = self.counts.get(topic, 0) + 1

    def goal(self, number):
        return (5.0 * number, 10.0 - 4.0 * number, 6.0 + number)

    def error(self, number):
        at = self.odometry[NAMES[number]].pose.pose.position
        return [g - p for g, p in zip(self.goal(number), (at.x, at.y, at.z))]

    def fly(self):
        if len(self.odometry) < len(NAMES):
            return
        now = self.get_clock().now()
        self.started = self.started or now
        for number, name in enumerate(NAMES):
            stamp = self.odometry[name].header.stamp
            self.ages.append(now.nanoseconds - stamp.sec * 10**9 - stamp.nanosec)
            command = TwistStamped()
            command.header.stamp = now.to_msg()
            command.header.frame_id = "map"
            v = command.twist.linear
            v.x, v.y, v.z = (max(-3.0, min(3.0, 0.5 * e)) for e in self.error(number))
            self.commands[name].publish(command)

    def flown(self):
        return (self.get_clock().now() - self.started).nanoseconds * 1e-9 if self.started else 0.0


rclpy.init()
pilot = Pilot()
by_wall = time.monotonic()
while pilot.flown() < LASTS and time.monotonic() - by_wall < 120:
    rclpy.spin_once(pilot, timeout_sec=0.5)
if not pilot.started:
    sys.exit(f"no odometry, saw {pilot.counts}")
wall = time.monotonic() - by_wall
worst = max(math.hypot(*pilot.error(number)) for number in range(len(NAMES)))
ages = sorted(pilot.ages)
print(f"flew {pilot.flown():.2f} s in {wall:.2f} s; counts {dict(sorted(pilot.counts.items()))}")
print(f"age of odometry at use: median {ages[len(ages) // 2] * 1e-6:.1f} ms, most {ages[-1] * 1e-6:.1f} ms")
for number, name in enumerate(NAMES):
    message = pilot.odometry[name]
    position, speed = message.pose.pose.position, message.twist.twist.linear
    print(f"{name}: {position.x:.3f} {position.y:.3f} {position.z:.3f}, frames {message.header.frame_id} "
          f"{message.child_frame_id}, speed {math.hypot(speed.x, speed.y, speed.z):.3f}")
print(f"PASSED worst error {worst:.3f} m" if worst < 0.5 else f"FAILED worst error {worst:.3f} m")
pilot.destroy_node()
rclpy.shutdown()
sys.exit(0 if worst < 0.5 else 1)
