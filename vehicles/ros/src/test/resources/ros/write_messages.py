"""Writes sample messages as CDR: by rclpy, and by rosbags what rclpy's packages lack, and big-endian.

pip install 'ros-kilted-rclpy[fastrtps]' ros-kilted-geometry-msgs ros-kilted-sensor-msgs ros-kilted-nav-msgs \
    ros-kilted-rosgraph-msgs rosbags
python write_messages.py > messages.txt
"""

import array

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from rosbags.typesys import Stores, get_typestore
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import (CameraInfo, CompressedImage, Image, Imu, LaserScan, NavSatFix, PointCloud2,
                             PointField)

store = get_typestore(Stores.ROS2_JAZZY)


def stamped(message, frame="map"):
    message.header.stamp.sec = 1700000000
    message.header.stamp.nanosec = 123456789
    message.header.frame_id = frame
    return message


def vector(v, x, y, z):
    v.x, v.y, v.z = x, y, z


def turned(q):
    q.x, q.y, q.z, q.w = 0.5, -0.5, 0.5, 0.5


def twist(t):
    vector(t.linear, 1.5, -2.25, 0.125)
    vector(t.angular, 0.0, -1e-3, 3.0)


def row(count):
    return [0.5 * i for i in range(count)]


def say(message):
    print(type(message).__name__, serialize_message(message).hex())


clock = Clock()
clock.clock = Time(sec=-5, nanosec=999999999)
say(clock)

pose = stamped(PoseStamped())
vector(pose.pose.position, 1.0, -2.0, 3.0)
turned(pose.pose.orientation)
say(pose)

transform = stamped(TransformStamped(), "world frame")
transform.child_frame_id = "drone_1/base_link"
vector(transform.transform.translation, 1.0, -2.0, 3.0)
turned(transform.transform.rotation)
say(transform)

plain = Twist()
twist(plain)
say(plain)

velocity = stamped(TwistStamped(), "")
twist(velocity.twist)
say(velocity)

odometry = stamped(Odometry(), "odom")
odometry.child_frame_id = "a"
vector(odometry.pose.pose.position, 1.0, -2.0, 3.0)
turned(odometry.pose.pose.orientation)
odometry.pose.covariance = row(36)
twist(odometry.twist.twist)
odometry.twist.covariance = row(36)
say(odometry)

imu = stamped(Imu(), "größe")
turned(imu.orientation)
imu.orientation_covariance = row(9)
vector(imu.angular_velocity, 0.1, 0.2, 0.3)
vector(imu.linear_acceleration, 0.0, 0.0, 9.81)
say(imu)

fix = stamped(NavSatFix(), "gps")
fix.status.status = -1
fix.status.service = 9
fix.latitude, fix.longitude, fix.altitude = 47.5, -122.25, 120.0
fix.position_covariance_type = 2
say(fix)

image = stamped(Image(), "camera")
image.height, image.width, image.encoding, image.step = 2, 3, "rgb8", 9
image.data = array.array("B", range(238, 256))
say(image)

png = stamped(CompressedImage(), "camera")
png.format = "png"
png.data = array.array("B", [1, 2, 255])
say(png)

info = stamped(CameraInfo(), "camera")
info.height, info.width, info.distortion_model = 480, 640, "plumb_bob"
info.d = array.array("d", [0.1, -0.2])
info.k, info.r, info.p = row(9), row(9), row(12)
info.binning_x, info.binning_y = 1, 2
info.roi.x_offset, info.roi.y_offset, info.roi.height, info.roi.width = 3, 4, 5, 6
info.roi.do_rectify = True
say(info)

cloud = stamped(PointCloud2(), "lidar")
cloud.height, cloud.width = 1, 2
cloud.fields = [PointField(name=n, offset=4 * i, datatype=7, count=1) for i, n in enumerate("xyz")]
cloud.point_step, cloud.row_step = 12, 24
cloud.data = array.array("B", range(24))
cloud.is_dense = True
say(cloud)

scan = stamped(LaserScan(), "laser")
scan.angle_min, scan.angle_max, scan.angle_increment = -1.5, 1.5, 0.25
scan.time_increment, scan.scan_time, scan.range_min, scan.range_max = 0.0, 0.125, 0.5, 30.0
scan.ranges = array.array("f", [1.0, float("inf"), 2.5])
scan.intensities = array.array("f", [])
say(scan)


def of(kind, **fields):
    return store.types[kind](**fields)


frame = of(
    "geometry_msgs/msg/TransformStamped",
    header=of("std_msgs/msg/Header", stamp=of("builtin_interfaces/msg/Time", sec=7, nanosec=8), frame_id="map"),
    child_frame_id="b",
    transform=of(
        "geometry_msgs/msg/Transform",
        translation=of("geometry_msgs/msg/Vector3", x=1.0, y=-2.0, z=3.0),
        rotation=of("geometry_msgs/msg/Quaternion", x=0.5, y=-0.5, z=0.5, w=0.5),
    ),
)
frames = of("tf2_msgs/msg/TFMessage", transforms=[frame, frame])
for little in (True, False):
    data = bytes(store.serialize_cdr(frames, "tf2_msgs/msg/TFMessage", little_endian=little))
    print("TFMessage", data.hex())
big = store.deserialize_cdr(serialize_message(info), "sensor_msgs/msg/CameraInfo")
print("CameraInfo", bytes(store.serialize_cdr(big, "sensor_msgs/msg/CameraInfo", little_endian=False)).hex())
big = store.deserialize_cdr(serialize_message(cloud), "sensor_msgs/msg/PointCloud2")
print("PointCloud2", bytes(store.serialize_cdr(big, "sensor_msgs/msg/PointCloud2", little_endian=False)).hex())
