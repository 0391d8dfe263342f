"""Flies the simulator at a port of this machine as AirSim's multirotor examples do, in our own words, and works the scene,
the cameras and what only an eye would notice.
"""

import math
import os
import sys
import tempfile
import time

import airsim
import numpy
from checking import arrives, check, near, passed, refusal, stamped, where

client = airsim.MultirotorClient(port=int(sys.argv[1]))
client.confirmConnection()


def take_off(name=""):
    client.enableApiControl(True, name)
    client.armDisarm(True, name)
    if client.getMultirotorState(name).landed_state == airsim.LandedState.Landed:
        client.takeoffAsync(vehicle_name=name).join()
    check(f"takes off {name}", client.getMultirotorState(name).landed_state == airsim.LandedState.Flying)


def start_again():
    client.reset()
    time.sleep(0.2)


# A hello: sensors, takeoff, a place, hover; its pictures.
client.enableApiControl(True)
for read in (client.getImuData, client.getBarometerData, client.getMagnetometerData, client.getGpsData):
    check(f"hello: {read.__name__}", stamped(read) > 0)
take_off()
client.moveToPositionAsync(-10, 10, -10, 5).join()
arrives(client, "hello: arrives", (-10, 10, -10), 5, 2.5)
client.hoverAsync().join()
pictures = client.simGetImages([
    airsim.ImageRequest("0", airsim.ImageType.DepthVis),
    airsim.ImageRequest("1", airsim.ImageType.DepthPerspective, True),
    airsim.ImageRequest("3", airsim.ImageType.Scene),
    airsim.ImageRequest("3", airsim.ImageType.Scene, False, False),
])
depth = airsim.get_pfm_array(pictures[1])
check("hello: depth", depth.shape == (144, 256) and 9 < depth[143].min() < 40, depth[143].min())
check("hello: a PNG", pictures[2].image_data_uint8[:8] == b"\x89PNG\r\n\x1a\n")
raw = numpy.frombuffer(pictures[3].image_data_uint8, dtype=numpy.uint8).reshape(144, 256, 3)
check("hello: pixels", (raw == raw[0, 0]).all() and raw[0, 0, 1] > raw[0, 0, 0])
check("hello: stamped alike", len({picture.time_stamp for picture in pictures}) == 1)
check("hello: one picture", client.simGetImage("0", airsim.ImageType.Scene)[1:4] == b"PNG")
check("hello: no flow", "OpticalFlow" in refusal(lambda: client.simGetImage("0", airsim.ImageType.OpticalFlow)))
scan = client.getLidarData("Lidar", "Pursuer")
check("hello: a scan", len(scan.point_cloud) == 3 * len(scan.segmentation) > 20000, len(scan.point_cloud))
check("hello: a distance", near(client.getDistanceSensorData("Down", "Pursuer").distance, 0.2, 0.5))
start_again()

# A path of four corners, looking ahead.
take_off()
client.moveToZAsync(-20, 5).join()
corners = [airsim.Vector3r(x, y, -20) for x, y in ((40, 0), (40, -40), (0, -40), (0, 0))]
done = client.moveOnPathAsync(
    corners, 12, 120, airsim.DrivetrainType.ForwardOnly, airsim.YawMode(False, 0), 20, 1
).get()
check("path: is flown to its end", done is True and math.dist(where(client), (0, 0, -20)) < 8, where(client))
# Within 40 commands of its goal a move to a place ends at once, as AirSim's does: 2.4 m at 3 m/s, 0.8 m at 1 m/s.
arrives(client, "path: comes back", (0, 0, -20), 1, 3)
check("path: lands", client.landAsync().get() is True)
client.armDisarm(False)
start_again()

# A box by velocities, looking inwards.
take_off()
for vx, vy, yaw in ((1, 0, 90), (0, 1, 180), (-1, 0, 270), (0, -1, 0)):
    mode = airsim.YawMode(False, yaw)
    client.moveByVelocityZAsync(vx, vy, -7, 5, airsim.DrivetrainType.MaxDegreeOfFreedom, mode).join()
    heading = math.degrees(airsim.to_eularian_angles(client.simGetVehiclePose().orientation)[2]) % 360
    check(f"box: looks towards {yaw}", abs((heading - yaw + 180) % 360 - 180) < 5, f"{heading:.1f}")
check("box: at its altitude", near(where(client)[2], -7, 0.5), where(client))
start_again()

# An orbit: asks where it is and sends the next velocity, without waiting for the one before.
take_off()
client.moveToPositionAsync(0, 0, -20, 5).join()
radius, speed = 10, 3
x, y, _ = where(client)
centre = (x + radius, y)
turned, before = 0.0, None
off = 0.0
until = time.monotonic() + 60
while (abs(turned) < 2 * math.pi or off > 4) and time.monotonic() < until:
    position = client.getMultirotorState().kinematics_estimated.position
    angle = math.atan2(position.y_val - centre[1], position.x_val - centre[0])
    off = abs(math.dist((position.x_val, position.y_val), centre) - radius)
    if before is not None:
        turned += (angle - before + math.pi) % (2 * math.pi) - math.pi
    before = angle
    ahead = angle + speed / radius
    vx = centre[0] + radius * math.cos(ahead) - position.x_val
    vy = centre[1] + radius * math.sin(ahead) - position.y_val
    inwards = airsim.YawMode(False, math.degrees(angle - math.pi))
    client.moveByVelocityZAsync(vx, vy, -20, 1, airsim.DrivetrainType.MaxDegreeOfFreedom, inwards)
    time.sleep(0.02)
check("orbit: comes round", abs(turned) >= 2 * math.pi, f"{math.degrees(turned):.0f} degrees")
check("orbit: on its circle", off <= 4, f"{off:.1f} m off")
client.moveToPositionAsync(x, y, -20, 2).join()
start_again()

# Navigating: forwards by the own heading, which pictures would choose.
take_off()
for turn in (0, math.pi / 10, -math.pi / 5):
    yaw = airsim.to_eularian_angles(client.simGetVehiclePose().orientation)[2] + turn
    mode = airsim.YawMode(False, 0)
    forwards = airsim.DrivetrainType.ForwardOnly
    client.moveByVelocityZAsync(math.cos(yaw), math.sin(yaw), -6, 1, forwards, mode).join()
check("navigate: goes on north", where(client)[0] > 0.5, where(client))
start_again()

# Two vehicles at once, and a third one added.
for name in ("Evader", "Pursuer"):
    client.enableApiControl(True, name)
    client.armDisarm(True, name)
rising = [client.takeoffAsync(vehicle_name=name) for name in ("Evader", "Pursuer")]
for move in rising:
    move.join()
moves = [
    client.moveToPositionAsync(-5, 5, -10, 5, vehicle_name="Evader"),
    client.moveToPositionAsync(5, -5, -10, 5, vehicle_name="Pursuer"),
]
for move in moves:
    move.join()
arrives(client, "two: the first arrives", (-5, 5, -10), 5, 2.5, "Evader")
arrives(client, "two: the second arrives in its own frame", (5, -5, -10), 5, 2.5, "Pursuer")
added = client.simAddVehicle("Third", "simpleflight", airsim.Pose(airsim.Vector3r(3, 4, 0), airsim.to_quaternion(0, 0, 0)))
check("a third is added", added is True and "Third" in client.listVehicles(), client.listVehicles())
take_off("Third")
there = client.simGetObjectPose("Third").position
check("the third is where it was put", near(there.x_val, 3, 0.2) and near(there.y_val, 4, 0.2))
start_again()

# Gains: a lower one answers more slowly; the defaults put it back.
def speed_after_half_a_second():
    take_off()
    client.moveToPositionAsync(0, 0, -10, 5).join()
    client.hoverAsync().join()
    time.sleep(1)
    client.simPause(True)
    client.moveByVelocityAsync(5, 0, 0, 10)
    client.simContinueForTime(0.5)
    speed = client.simGetGroundTruthKinematics().linear_velocity.x_val
    client.simPause(False)
    client.cancelLastTask()
    start_again()
    return speed


default = speed_after_half_a_second()
slow = airsim.VelocityControllerGains(x_gains=airsim.PIDGains(0.08, 0, 0))
client.setVelocityControllerGains(slow)
tuned = speed_after_half_a_second()
client.setVelocityControllerGains(airsim.VelocityControllerGains())
again = speed_after_half_a_second()
check("gains: a lower one is slower", tuned < 0.7 * default, f"{tuned:.2f} of {default:.2f} m/s")
check("gains: the defaults put it back", near(again, default, 0.3), f"{again:.2f} m/s")
client.setAngleRateControllerGains(airsim.AngleRateControllerGains())
client.setAngleLevelControllerGains(airsim.AngleLevelControllerGains())
client.setPositionControllerGains(airsim.PositionControllerGains())

# Kinematics as they are told.
client.simPause(True)
state = client.simGetGroundTruthKinematics()
state.position = airsim.Vector3r(3, 4, -30)
state.linear_velocity = airsim.Vector3r(5, -2, 1)
client.simSetKinematics(state, True)
seen = client.simGetGroundTruthKinematics()
check("kinematics: are set", seen.linear_velocity == state.linear_velocity or seen.linear_velocity.x_val == 5)
client.simContinueForTime(0.1)
check("kinematics: go on from there", near(where(client)[0], 3.5, 0.05), where(client))
client.simPause(False)
start_again()

# The scene, cameras, and what only an eye would see.
objects = client.simListSceneObjects()
check("scene: lists what there is", {"Ground", "Evader", "Pursuer"} <= set(objects), objects)
check("scene: no assets", client.simListAssets() == [])
check("scene: moves an object", client.simSetObjectPose("Pursuer", airsim.Pose(airsim.Vector3r(9, 0, -3)), True) is True)
check("scene: scales", client.simSetObjectScale("Pursuer", airsim.Vector3r(2, 2, 2)) and client.simGetObjectScale("Pursuer").x_val == 2)
check("scene: ids", client.simSetSegmentationObjectID(".*", 7, True) and client.simGetSegmentationObjectID("Ground") == 7)
check("scene: nothing to destroy", client.simDestroyObject("Pursuer") is False)
check("scene: one level", client.simLoadLevel("Blocks") is False)
check("scene: no meshes", client.simGetMeshPositionVertexBuffers() == [])
low, high = client.simGetWorldExtents()
check("scene: extents", low.latitude < client.getHomeGeoPoint().latitude < high.latitude)
above = client.getHomeGeoPoint()
above.altitude += 50
below = client.getHomeGeoPoint()
below.altitude -= 50
check("scene: sees what is above", client.simTestLineOfSightToPoint(above) is True)
check("scene: sees nothing below", client.simTestLineOfSightToPoint(below) is False)
check("scene: between points", client.simTestLineOfSightBetweenPoints(above, below) is False)
wrong = refusal(lambda: client.simSpawnObject("One", "Cube", airsim.Pose(), airsim.Vector3r(1, 1, 1)))
check("scene: what cannot be spawned is named", "There were no objects with name Cube" in wrong, wrong)
with tempfile.TemporaryDirectory() as folder:
    grid = os.path.join(folder, "map.binvox")
    check("scene: no file is written", client.simCreateVoxelGrid(airsim.Vector3r(0, 0, 0), 10, 10, 10, 0.5, grid) is False and not os.path.exists(grid))

down = airsim.Pose(airsim.Vector3r(0, 0, 0.1), airsim.to_quaternion(-math.pi / 2, 0, 0))
client.simSetCameraPose("0", down)
client.simSetCameraFov("0", 60)
info = client.simGetCameraInfo("front_center")
pitch = airsim.to_eularian_angles(info.pose.orientation)[0]
check("camera: pose and view are told back", near(pitch, -math.pi / 2, 1e-2) and near(info.fov, 60, 1e-3), info.fov)
check("camera: a matrix", len(info.proj_mat.matrix) == 4)
client.simSetDistortionParams("0", {"K1": 0.1, "P2": 0.2})
told = client.simGetDistortionParams("0")
check("camera: distortion", near(told[0], 0.1, 1e-6) and near(told[4], 0.2, 1e-6), told)
check("camera: lenses", len(client.simGetPresetLensSettings("0")) > 1 and "Name" in client.simGetLensSettings("0"))
client.simSetPresetLensSettings("50mm Prime f/1.8", "0")
check("camera: focal length", client.simGetFocalLength("0") == 50)
client.simSetFocalLength(20, "0")
check("camera: films", len(client.simGetPresetFilmbackSettings("0")) > 1 and "Name" in client.simGetFilmbackSettings("0"))
client.simSetPresetFilmbackSettings("Full Frame DSLR", "0")
check("camera: film", near(client.simSetFilmbackSettings(36, 24, "0"), 1.5, 1e-6))
client.simEnableManualFocus(True, "0")
client.simSetFocusDistance(300, "0")
client.simSetFocusAperture(4, "0")
client.simEnableFocusPlane(False, "0")
check("camera: focus", (client.simGetFocusDistance("0"), client.simGetFocusAperture("0")) == (300, 4))
check("camera: view in words", "Horizontal" in client.simGetCurrentFieldOfView("0"))
client.simAddDetectionFilterMeshName("0", airsim.ImageType.Scene, "Car*")
client.simSetDetectionFilterRadius("0", airsim.ImageType.Scene, 2000)
client.simClearDetectionMeshNames("0", airsim.ImageType.Scene)
check("camera: finds nothing that it does not look for", client.simGetDetections("0", airsim.ImageType.Scene) == [])

points = [airsim.Vector3r(0, 0, -1), airsim.Vector3r(1, 0, -1)]
poses = [airsim.Pose(), airsim.Pose()]
client.simPlotPoints(points)
client.simPlotLineStrip(points)
client.simPlotLineList(points)
client.simPlotArrows(points, points, is_persistent=True)
client.simPlotStrings(["a", "b"], points)
client.simPlotTransforms(poses)
client.simPlotTransformsWithNames(poses, ["a", "b"])
client.simFlushPersistentMarkers()
client.simSetTraceLine([1.0, 0.0, 0.0, 1.0], 5)
client.simEnableWeather(True)
client.simSetWeatherParameter(airsim.WeatherParameter.Fog, 0.25)
client.simSetTimeOfDay(True, "2018-02-12 15:20:00")
client.simPrintLogMessage("Iteration: ", "1")
check("eye: markers, weather, sun and messages are taken", client.ping())
check("eye: console", client.simRunConsoleCommand("stat fps") is True)
check("eye: no lights", client.simSetLightIntensity("Sun", 2.0) is False)
check("eye: no textures", client.simSwapTextures("tag") == [])
check("eye: no materials", not client.simSetObjectMaterial("Ground", "wood") and not client.simSetObjectMaterialFromTexture("Ground", "a.png"))
client.startRecording()
check("eye: records", client.isRecording() is True)
client.stopRecording()
check("eye: stops recording", client.isRecording() is False)

passed()
