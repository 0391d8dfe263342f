"""Sees a camera, with depths and segmentation, and two lidars of the vehicle `a`, as anybody would with rclpy."""
import math
import struct
import sys
import time

import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

domain, wanted = int(sys.argv[1]), int(sys.argv[2])
rclpy.init(domain_id=domain)
node = rclpy.create_node("see_sensors")
seen = {"image": [], "info": [], "depth": [], "segmentation": [], "own": [], "world": []}
for name, kind, topic in [
    ("image", Image, "/a/front/image_raw"),
    ("info", CameraInfo, "/a/front/camera_info"),
    ("depth", Image, "/a/front/depth/image_raw"),
    ("segmentation", Image, "/a/front/segmentation/image_raw"),
    ("own", PointCloud2, "/a/spin/points"),
    ("world", PointCloud2, "/a/fixed/points"),
]:
    node.create_subscription(kind, topic, seen[name].append, qos_profile_sensor_data)
until = time.monotonic() + 60
while time.monotonic() < until and any(len(got) < wanted for got in seen.values()):
    rclpy.spin_once(node, timeout_sec=0.1)
for name, got in seen.items():
    assert len(got) >= wanted, f"{name}: expected {wanted} messages within 60 s, got {len(got)}"


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


for got in seen.values():
    stamps = [stamp(one) for one in got]
    assert stamps == sorted(set(stamps)), stamps
image, info = seen["image"][-1], seen["info"][-1]
assert (image.width, image.height, image.step, image.encoding) == (64, 48, 192, "bgr8"), image
assert len(image.data) == 64 * 48 * 3 and len(set(image.data)) > 1, "one colour"
assert image.header.frame_id == info.header.frame_id == "a/front/optical", image.header
focal = 32 / math.tan(math.radians(45))
assert abs(info.k[0] - focal) < 1e-6 and info.k[2] == 31.5 and info.k[5] == 23.5, info.k
assert {stamp(one) for one in seen["info"]} & {stamp(one) for one in seen["image"]}
depth, parts = seen["depth"][-1], seen["segmentation"][-1]
assert (depth.width, depth.height, depth.step, depth.encoding) == (64, 48, 256, "32FC1"), depth
# The wall is 30 m before the camera, wherever in the image: depth is along the camera's axis.
metres = [d for (d,) in struct.iter_unpack("<f", bytes(depth.data))]
assert abs(metres[24 * 64 + 32] - 30) < 0.1 and math.inf in metres, (metres[24 * 64 + 32], max(metres))
assert (parts.step, parts.encoding) == (192, "bgr8") and len(set(bytes(parts.data))) > 1, parts
assert {stamp(one) for one in seen["depth"]} & {stamp(one) for one in seen["image"]}


def points(cloud):
    assert [(f.name, f.offset, f.datatype) for f in cloud.fields] == [("x", 0, 7), ("y", 4, 7), ("z", 8, 7)]
    assert cloud.point_step == 12 and len(cloud.data) == 12 * cloud.width * cloud.height
    return list(struct.iter_unpack("<fff", bytes(cloud.data)))


own, world = seen["own"][-1], seen["world"][-1]
assert own.header.frame_id == "a/spin" and world.header.frame_id == "map", (own.header, world.header)
# The wall is 30 m before the vehicle, which starts 3 m north of the origin, 2 m west of it, and heads north.
front = [p for p in points(own) if p[0] > 1 and abs(p[1]) < 5]
north = [p for p in points(world) if p[1] > 4 and abs(p[0] + 2) < 5]
assert front and all(abs(p[0] - 30) < 0.4 for p in front), front[:3]
assert north and all(abs(p[1] - 33) < 0.4 for p in north), north[:3]
print(f"PASSED: {', '.join(f'{len(got)} of {name}' for name, got in seen.items())}")
