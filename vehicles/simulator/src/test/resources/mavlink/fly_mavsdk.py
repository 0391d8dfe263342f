"""Flies three vehicles at once with MAVSDK's C++ library: arguments are their UDP ports. Prints PASSED at the end."""

import math
import sys
import threading
import time
import traceback

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.mission import Mission
from mavsdk.plugins.mission.mission import MissionItem, MissionPlan
from mavsdk.plugins.offboard import Offboard
from mavsdk.plugins.offboard.offboard import PositionNedYaw, VelocityNedYaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import Telemetry

ports = [int(port) for port in sys.argv[1:]]
checks = []
failures = []


def check(ok, what):
    checks.append(what)
    if not ok:
        raise AssertionError(what)


def until(condition, seconds, what):
    end = time.time() + seconds
    while time.time() < end:
        if condition():
            return check(True, what)
        time.sleep(0.05)
    check(False, f"{what}, within {seconds} s")


def fly(port, index):
    try:
        sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        system = sdk.first_autopilot(15.0)
        check(system is not None, f"vehicle {index} is found")
        action, telemetry = Action(system), Telemetry(system)
        offboard, mission, param = Offboard(system), Mission(system), Param(system)
        texts = []
        telemetry.subscribe_status_text(lambda text, *_: texts.append(text.text))
        until(telemetry.health_all_ok, 20, "all sensors are well")
        where = lambda: telemetry.position_velocity_ned().position
        how = lambda: telemetry.position_velocity_ned().velocity

        check(abs(param.get_param_float("MIS_TAKEOFF_ALT") - 2.5) < 1e-6, "a parameter is read")
        action.set_takeoff_altitude(5.0)
        check(abs(action.get_takeoff_altitude() - 5.0) < 1e-6, "a parameter is set")
        check(param.get_param_int("SYS_AUTOSTART") == 4001, "an integer parameter is read")
        try:
            action.takeoff()
            check(False, "a takeoff without arming is refused")
        except Exception:
            check(True, "a takeoff without arming is refused")
        until(lambda: any("disarmed" in text for text in texts), 5, "and says why")

        action.arm()
        until(telemetry.armed, 5, "armed")
        action.takeoff()
        until(lambda: abs(where().down_m + 5) < 0.4, 30, "took off to 5 m")
        until(lambda: telemetry.in_air(), 5, "is told to be in the air")
        try:
            action.disarm()
            check(False, "disarming in the air is refused")
        except Exception:
            check(True, "disarming in the air is refused")

        offboard.set_velocity_ned(VelocityNedYaw(2.0 + index, 1.0, -0.5, 90.0))
        offboard.start()
        until(lambda: abs(how().north_m_s - 2 - index) < 0.15 and abs(how().east_m_s - 1) < 0.15, 15, "flies a velocity")
        until(lambda: abs(telemetry.attitude_euler().yaw_deg - 90) < 5, 15, "and a yaw")
        offboard.set_position_ned(PositionNedYaw(5.0, 3.0 * index, -10.0, 0.0))
        until(
            lambda: math.dist((where().north_m, where().east_m, where().down_m), (5, 3 * index, -10)) < 0.3,
            40,
            "flies to a position",
        )
        offboard.stop()

        home = telemetry.home()
        north, east = 1 / 111194.9, 1 / (111194.9 * math.cos(math.radians(home.latitude_deg)))
        def item(n, e, up, through):
            return MissionItem(
                latitude_deg=home.latitude_deg + n * north,
                longitude_deg=home.longitude_deg + e * east,
                relative_altitude_m=up,
                speed_m_s=5.0,
                is_fly_through=through,
            )
        plan = MissionPlan(mission_items=[item(20, 0, 8, True), item(20, 15, 10, True), item(0, 5, 8, False)])
        mission.upload_mission(plan)
        back = mission.download_mission()
        check(len(back.mission_items) == 3, "a mission is read back")
        check(abs(back.mission_items[1].latitude_deg - plan.mission_items[1].latitude_deg) < 2e-7, "as it was")
        farthest = [0.0]
        mission.start_mission()
        def done():
            farthest[0] = max(farthest[0], where().north_m)
            return mission.is_mission_finished()
        until(done, 60, "a mission is flown")
        check(farthest[0] > 17, "by its waypoints")

        action.hold()
        action.land()
        until(lambda: not telemetry.in_air(), 60, "landed")
        until(lambda: not telemetry.armed(), 15, "disarmed itself")
        until(lambda: abs(where().down_m) < 0.3, 5, "on the ground")
    except BaseException as error:
        failures.append(f"vehicle {index}: {''.join(traceback.format_exception(error))}")


start = time.time()
threads = [threading.Thread(target=fly, args=(port, index)) for index, port in enumerate(ports)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
for failure in failures:
    print(failure)
print(f"PASSED {len(checks)} checks in {time.time() - start:.0f} s" if not failures else "FAILED", flush=True)
import os

os._exit(1 if failures else 0)
