"""Asks a vehicle at a UDP port for all that it can tell, and decodes every datagram by pymavlink. Prints PASSED at the end."""

import os
import socket
import sys
import time

os.environ["MAVLINK20"] = "1"
from pymavlink.dialects.v20 import common as m

EXPECTED = set(
    "HEARTBEAT SYS_STATUS SYSTEM_TIME GPS_RAW_INT ATTITUDE ATTITUDE_QUATERNION LOCAL_POSITION_NED GLOBAL_POSITION_INT "
    "MISSION_CURRENT GPS_GLOBAL_ORIGIN BATTERY_STATUS HOME_POSITION EXTENDED_SYS_STATE ODOMETRY AUTOPILOT_VERSION "
    "COMMAND_ACK STATUSTEXT TIMESYNC PARAM_VALUE MISSION_COUNT MISSION_REQUEST_INT MISSION_ITEM_INT MISSION_ACK "
    "MISSION_ITEM_REACHED".split()
)

at = ("127.0.0.1", int(sys.argv[1]))
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
link.settimeout(0.2)
reader = m.MAVLink(None)
reader.robust_parsing = False  # what cannot be read raises
writer = m.MAVLink(None, srcSystem=245, srcComponent=190)
seen = {}
count = 0


def send(message):
    link.sendto(message.pack(writer), at)
    writer.seq = (writer.seq + 1) % 256


def command(number, *numbers):
    send(m.MAVLink_command_long_message(1, 1, number, 0, *(list(numbers) + [0] * 7)[:7]))


def hear(seconds, until=lambda: False):
    global count
    end = time.time() + seconds
    while time.time() < end and not until():
        try:
            datagram = link.recv(65536)
        except socket.timeout:
            continue
        messages = reader.parse_buffer(datagram)
        assert messages and sum(one.get_msgbuf().__len__() for one in messages) == len(datagram), datagram.hex()
        for one in messages:
            count += 1
            assert one.get_srcSystem() == 1 and one.get_type() != "BAD_DATA", one
            seen.setdefault(one.get_type(), []).append(one)


def last(kind):
    return seen[kind][-1]


def has(kind):
    return kind in seen


send(m.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))
hear(2)
hear(8, lambda: has("HEARTBEAT") and has("HOME_POSITION"))
command(22, 0, 0, 0, 0, 0, 0, float("nan"))  # a takeoff without arming
command(512, 148)
send(m.MAVLink_timesync_message(0, 77))
send(m.MAVLink_param_request_list_message(1, 1))
hear(2)
hear(8, lambda: has("TIMESYNC") and has("PARAM_VALUE") and last("PARAM_VALUE").param_count == len(seen["PARAM_VALUE"]))
assert last("TIMESYNC").ts1 == 77
assert any(one.param_id == "MIS_TAKEOFF_ALT" for one in seen["PARAM_VALUE"]), seen["PARAM_VALUE"]
assert last("PARAM_VALUE").param_count == len(seen["PARAM_VALUE"])

home = last("HOME_POSITION")
items = [(22, home.latitude, home.longitude, 4.0), (16, home.latitude + 500, home.longitude, 4.0)]
send(m.MAVLink_mission_count_message(1, 1, len(items), 0))
for number, (kind, latitude, longitude, height) in enumerate(items):
    hear(10, lambda: any(one.seq == number for one in seen.get("MISSION_REQUEST_INT", [])))
    send(m.MAVLink_mission_item_int_message(1, 1, number, 6, kind, 0, 1, 0, 1, 0, float("nan"), latitude, longitude, height, 0))
hear(10, lambda: has("MISSION_ACK"))
send(m.MAVLink_mission_request_list_message(1, 1, 0))
hear(10, lambda: has("MISSION_COUNT"))
send(m.MAVLink_mission_request_int_message(1, 1, 1, 0))
hear(10, lambda: has("MISSION_ITEM_INT"))
item = last("MISSION_ITEM_INT")
assert (item.command, item.x, item.y, item.z) == (16, items[1][1], items[1][2], 4.0), item

command(400, 1)
hear(10, lambda: last("HEARTBEAT").base_mode & 128)
assert last("HEARTBEAT").base_mode & 128, last("HEARTBEAT")
command(300, 0, 1)
hear(30, lambda: any(one.seq == 1 for one in seen.get("MISSION_ITEM_REACHED", [])))
local, odometry, globe = last("LOCAL_POSITION_NED"), last("ODOMETRY"), last("GLOBAL_POSITION_INT")
assert abs(local.x - 5.6) < 1.5 and abs(local.z + 4) < 1, local
assert abs(odometry.x - local.x) < 1 and abs(globe.relative_alt / 1000 + local.z) < 1, (odometry, local, globe)

missing = EXPECTED - seen.keys()
assert not missing, f"never came: {missing}"
assert seen.keys() <= EXPECTED, f"unexpected: {seen.keys() - EXPECTED}"
print(f"PASSED {count} messages of {len(seen)} kinds")
