"""Flies the simulator at a port of this machine with the official AirSim client, and checks what it answers."""

import sys
import time

import airsim
from checking import arrives, check, comes_to, near, passed, refusal


def place(vector):
    return f"{vector.x_val:.2f} {vector.y_val:.2f} {vector.z_val:.2f}"


client = airsim.MultirotorClient(port=int(sys.argv[1]))

# Connection
client.confirmConnection()
check("ping", client.ping() is True)
check("versions suit", (client.getServerVersion(), client.getMinRequiredClientVersion()) == (4, 1))
check("vehicles", client.listVehicles() == ["Evader", "Pursuer"], client.listVehicles())
check("settings string", "Evader" in client.getSettingsString())
home = client.getHomeGeoPoint()
check("home", near(home.latitude, 47.641468, 1e-6) and near(home.longitude, -122.140165, 1e-6) and home.altitude == 122)

# Control
check("no api control at first", client.isApiControlEnabled() is False)
client.enableApiControl(True)
check("api control", client.isApiControlEnabled() is True)
check("arms", client.armDisarm(True) is True)
check("landed at first", client.getMultirotorState().landed_state == airsim.LandedState.Landed)

# Takeoff and a square
client.takeoffAsync().join()
state = client.getMultirotorState()
check("takes off", state.landed_state == airsim.LandedState.Flying)
up = state.kinematics_estimated.position
check("climbs as AirSim does", near(up.z_val, -1.6, 0.3), place(up))
for x, y in [(5, 0), (5, 5), (0, 5), (0, 0)]:
    check("a move to a place ends well", client.moveToPositionAsync(x, y, -5, 3).get() is True)
    arrives(client, f"flies to corner {x} {y}", (x, y, -5), 3, 1.5)

# State and sensors
client.hoverAsync().join()
comes_to(
    "stands in the air",
    lambda: client.simGetGroundTruthKinematics().linear_velocity.get_length() < 0.05,
)
state = client.getMultirotorState()
truth = client.simGetGroundTruthKinematics()
pose = client.simGetVehiclePose()
check("estimate is the truth", state.kinematics_estimated.position.distance_to(truth.position) < 0.1)
check("pose is the truth", pose.position.distance_to(truth.position) < 0.1)
check("orientation is a rotation", near(pose.orientation.get_length(), 1, 1e-5))
check("time stamp is an integer of nanoseconds", isinstance(state.timestamp, int) and state.timestamp > 10**18)
check("rc data", state.rc_data.is_valid is False)
check("gps location", near(state.gps_location.altitude, 122 - truth.position.z_val, 0.1))
imu = client.getImuData()
check("IMU feels its weight", near(imu.linear_acceleration.z_val, -9.8, 0.5), f"{imu.linear_acceleration.z_val:.3f}")
check("IMU time stamp", imu.time_stamp >= state.timestamp)
gps = client.getGpsData()
check("GPS", gps.is_valid is True and gps.gnss.fix_type == 3 and near(gps.gnss.geo_point.latitude, home.latitude, 1e-4))
barometer = client.getBarometerData()
check("barometer", near(barometer.altitude, 127, 2) and near(barometer.qnh, 1013.25, 0.1), f"{barometer.altitude:.1f} m")
magnetometer = client.getMagnetometerData()
check("magnetometer points north and down", magnetometer.magnetic_field_body.x_val > 0 < magnetometer.magnetic_field_body.z_val)
rotors = client.getRotorStates().rotors
lift = sum(rotor["thrust"] for rotor in rotors)
check("four rotors carry the vehicle", len(rotors) == 4 and near(lift, 9.8, 0.5), f"{lift:.2f} N")
surroundings = client.simGetGroundTruthEnvironment()
check("environment", near(surroundings.gravity.z_val, 9.80665, 1e-4) and near(surroundings.air_density, 1.21, 0.01))
check("collision info", client.simGetCollisionInfo().has_collided is False)
elsewhere = client.simGetGroundTruthKinematics("Pursuer").position
check("the other vehicle stands at its own origin", elsewhere.get_length() == 0)

# Moves
older = client.moveByVelocityAsync(2, 0, 0, 20)
time.sleep(0.2)
newer = client.moveByVelocityZAsync(0, 2, -5, 1, airsim.DrivetrainType.MaxDegreeOfFreedom, airsim.YawMode(True, 0))
check("a newer move cancels the older", older.get() is False)
check("a move answers when it ends", newer.get() is True)
path = [airsim.Vector3r(3, 3, -5), airsim.Vector3r(0, 0, -5)]
check("flies a path", client.moveOnPathAsync(path, 3, 60, airsim.DrivetrainType.ForwardOnly, airsim.YawMode(False, 0)).get() is True)
client.hoverAsync().join()
time.sleep(1)
for _ in range(6):  # like AirSim's takeoff it may stop half a metre short and answer False, and it flies on after that
    client.moveToZAsync(-9, 3).join()
    height = client.simGetGroundTruthKinematics().position.z_val
    if near(height, -9, 0.8):
        break
check("moves to an altitude", near(height, -9, 0.8), f"{height:.2f} m")
check("moves by angles", client.moveByRollPitchYawZAsync(0.05, 0, 0, -9, 1).get() is True)
check("moves in its body frame", client.moveByVelocityBodyFrameAsync(1, 0, 0, 1).get() is True)
check("rotates to a yaw", client.rotateToYawAsync(90, 30, 5).get() is True)
check("rotates at a rate", client.rotateByYawRateAsync(30, 1).get() is True)
last = client.moveByVelocityAsync(1, 0, 0, 60)
time.sleep(0.1)
client.cancelLastTask()
check("cancels", last.get() is False)
client.simSetWind(airsim.Vector3r(1, 0, 0))
client.simSetWind(airsim.Vector3r(0, 0, 0))

# Time
client.simPause(True)
check("pauses", client.simIsPause() is True)
before = client.getMultirotorState().timestamp
time.sleep(0.1)
check("stands still while paused", client.getMultirotorState().timestamp == before)
waiting = client.moveByVelocityZAsync(0, 3, -9, 0.5)
for step in range(1, 6):
    client.simContinueForTime(0.1)
    now = client.getMultirotorState().timestamp
    check(f"step {step} continues by exactly 0.1 s", now - before == 100_000_000, f"{now - before} ns")
    before = now
check("a command given while paused is flown by the steps", waiting.get() is True)
client.simContinueForFrames(10)
frames = client.getMultirotorState().timestamp - before
check("continues for frames of 60 Hz", near(frames, 1e10 / 60, 1), frames)
client.simPause(False)

# Errors
wrong = refusal(lambda: client.getMultirotorState("Nope"))
check("a vehicle that is not there", "Vehicle API for 'Nope' is not available" in wrong, wrong)
wrong = refusal(lambda: client.client.call("nosuch"))
check("a function that is not there", wrong == "rpclib: server could not find function 'nosuch' with argument count 0.", wrong)
wrong = refusal(lambda: client.client.call("ping", 1))
check("too many arguments", "Expected: 1, got: 0" in wrong, wrong)
wrong = refusal(lambda: client.getLidarData())
check("a sensor that is not there", "No lidar with name  exist on vehicle" in wrong, wrong)

# Pose, landing, reset
client.simPause(True)
client.simSetVehiclePose(airsim.Pose(airsim.Vector3r(4, 2, -2), airsim.Quaternionr()), True)
here = client.simGetVehiclePose().position
check("is put elsewhere", near(here.x_val, 4, 0.01) and near(here.y_val, 2, 0.01) and near(here.z_val, -2, 0.01), place(here))
client.simPause(False)
# One that still rises would be taken for landed: AirSim looks only whether it sinks.
client.hoverAsync().join()
comes_to(
    "hangs still",
    lambda: client.getMultirotorState().kinematics_estimated.linear_velocity.get_length() < 0.02,
)
check("lands", client.landAsync().get() is True)
touch = client.simGetCollisionInfo()
check("touched the ground", touch.has_collided is True and touch.object_name == "Ground")
check("disarms", client.armDisarm(False) is True)
comes_to(
    "is landed", lambda: client.getMultirotorState().landed_state == airsim.LandedState.Landed
)
client.reset()
check("reset: at its start", client.simGetVehiclePose().position.get_length() == 0)
check("reset: no api control", client.isApiControlEnabled() is False)

passed()
