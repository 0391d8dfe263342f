"""Reads a bag by `rosbags`, or writes one.

usage: bags.py read BAG   prints each topic with its type, its number of messages, and the mean of log time - stamp, ms
       bags.py write BAG  200 readings of /uav1/odom, 50 a second, each 30 ms old; after every fifth a command, 4 ms later
"""

import sys
from pathlib import Path

from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore


def read(bag):
    late = {}
    with AnyReader([bag]) as reader:
        for connection, at, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            header = message.transforms[0].header if connection.topic == "/tf" else message.header
            stamp = header.stamp.sec * 1_000_000_000 + header.stamp.nanosec
            late.setdefault((connection.topic, connection.msgtype), []).append((at - stamp) * 1e-6)
    for (topic, kind), all in sorted(late.items()):
        print(topic, kind, len(all), f"{sum(all) / len(all):.3f}")


def write(bag):
    types = get_typestore(Stores.ROS2_JAZZY)
    with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:

        def topic(name, kind):
            return writer.add_connection(name, kind, typestore=types), kind

        odometry, twist = topic("/uav1/odom", "nav_msgs/msg/Odometry"), topic("/uav1/cmd_vel", "geometry_msgs/msg/Twist")

        def put(connection, at, value):
            writer.write(connection[0], at, types.serialize_cdr(value, connection[1]))

        kinds = {name.rpartition("/")[2]: kind for name, kind in types.types.items()}
        import numpy

        vector = lambda: kinds["Vector3"](0.0, 0.0, 0.0)
        for number in range(200):
            stamp = 1_700_000_000_000_000_000 + number * 20_000_000
            time = kinds["Time"](stamp // 1_000_000_000, stamp % 1_000_000_000)
            pose = kinds["Pose"](kinds["Point"](1.0, 2.0, 3.0), kinds["Quaternion"](0.0, 0.0, 0.0, 1.0))
            motion = kinds["Twist"](vector(), vector())
            zero = numpy.zeros(36)
            put(
                odometry,
                stamp + 30_000_000,
                kinds["Odometry"](
                    kinds["Header"](time, "map"),
                    "base",
                    kinds["PoseWithCovariance"](pose, zero),
                    kinds["TwistWithCovariance"](motion, zero),
                ),
            )
            if number % 5 == 0:
                put(twist, stamp + 34_000_000, motion)


{"read": read, "write": write}[sys.argv[1]](Path(sys.argv[2]))
