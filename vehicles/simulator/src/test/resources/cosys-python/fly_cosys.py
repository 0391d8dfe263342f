"""Flies the simulator at a port of this machine with Cosys-AirSim's client, and checks what it answers."""

import sys

import cosysairsim as airsim

checks = 0


def check(what, holds, found=None):
    global checks
    if not holds:
        sys.exit(f"FAILED: {what}; found {found}")
    checks += 1
    print(f"ok: {what}" + ("" if found is None else f" ({found})"))


client = airsim.MultirotorClient(port=int(sys.argv[1]))
client.confirmConnection()
check("the server is new enough", client.getServerVersion() >= client.getMinRequiredServerVersion())
check("the client is new enough", client.getClientVersion() >= client.getMinRequiredClientVersion())
client.enableApiControl(True)
check("arms", client.armDisarm(True) is True)
client.takeoffAsync().join()
check("moves", client.moveToPositionAsync(3, 0, -4, 3).join() is not False)
position = client.getMultirotorState().kinematics_estimated.position
check("is up", position.z_val < -2, round(position.z_val, 1))

(image,) = client.simGetImages([airsim.ImageRequest("0", airsim.ImageType.Scene, False, False)])
check("images", len(image.image_data_uint8) == 3 * image.width * image.height, (image.width, image.height))
png = client.simGetImage("0", airsim.ImageType.Scene)
check("an image", png[:4] == b"\x89PNG", len(png))
client.simAddDetectionFilterMeshName("0", airsim.ImageType.Scene, "*")
check("detections", isinstance(client.simGetDetections("0", airsim.ImageType.Scene), list))
client.simClearDetectionMeshNames("0", airsim.ImageType.Scene)
client.simSetCameraFov("0", 60)
check("a camera's field of view", abs(client.simGetCameraInfo("0").fov - 60) < 0.1)
check("a focal length", client.simGetFocalLength("0") > 0)
client.simSetCameraPose("0", airsim.Pose(airsim.Vector3r(0.3, 0, 0)))
check("an object's pose", abs(client.simGetObjectPose("Drone").position.z_val - position.z_val) < 3)
check("objects", client.simListInstanceSegmentationObjects() == ["Ground", "Drone"])
check("poses of objects", len(client.simListInstanceSegmentationPoses()) == 2)
check("IMU", client.getImuData().time_stamp > 0)
check("kinematics", client.simGetPhysicsRawKinematics().position.z_val < -2)
print(f"PASSED {checks} checks")
