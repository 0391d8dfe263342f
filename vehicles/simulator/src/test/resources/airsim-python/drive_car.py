"""Drives the simulator at a port of this machine with the calls of AirSim's first car example, in our own words: forwards, to
the right, backwards by the gear lever, brakes; pictures; a reset.
"""

import sys
import time

import airsim
from checking import check, near, passed, refusal, waited

NAME = "Car"

client = airsim.CarClient(port=int(sys.argv[1]))
client.confirmConnection()
client.enableApiControl(True, NAME)
check("api control", client.isApiControlEnabled(NAME) is True)
check("arms", client.armDisarm(True, NAME) is True)
controls = airsim.CarControls()


def drive(until, **changes):
    """The car's state when it has come to be so, however long that takes on a busy machine; or after 20 s."""
    for key, value in changes.items():
        setattr(controls, key, value)
    client.setCarControls(controls, NAME)
    return waited(lambda: client.getCarState(NAME), until)


def turning(state):
    return state.kinematics_estimated.angular_velocity.z_val > 0.2


for lap in range(2):
    check("stands", near(client.getCarState(NAME).speed, 0, 0.05))
    ahead = drive(lambda state: state.speed > 4, throttle=0.5, steering=0)
    check("forwards", ahead.speed > 4 and ahead.gear == 1, f"{ahead.speed:.1f} m/s")
    before = airsim.to_eularian_angles(ahead.kinematics_estimated.orientation)[2]
    right = drive(turning, steering=1)
    turned = airsim.to_eularian_angles(right.kinematics_estimated.orientation)[2] - before
    check("to the right", turning(right) and turned != 0)
    back = drive(lambda state: state.speed < -1, throttle=-0.5, is_manual_gear=True, manual_gear=-1, steering=0)
    check("backwards", back.speed < 0 and back.gear == -1, f"{back.speed:.1f} m/s")
    told = client.getCarControls(NAME)
    check("told", (told.throttle, told.manual_gear, told.is_manual_gear) == (-0.5, -1, True))
    stood = drive(lambda state: near(state.speed, 0, 0.05), throttle=0, is_manual_gear=False, manual_gear=0, brake=1)
    check("brakes", near(stood.speed, 0, 0.05) and stood.timestamp > back.timestamp)
    controls.brake = 0
    pictures = client.simGetImages([
        airsim.ImageRequest("0", airsim.ImageType.DepthVis),
        airsim.ImageRequest("1", airsim.ImageType.DepthPerspective, True),
        airsim.ImageRequest("1", airsim.ImageType.Scene),
        airsim.ImageRequest("1", airsim.ImageType.Scene, False, False),
    ], NAME)
    check("pictures", [len(picture.image_data_uint8) > 0 for picture in pictures] == [True, False, True, True])

client.simPause(True)
controls.throttle = 1
client.setCarControls(controls, NAME)
time.sleep(0.1)
check("paused", client.simIsPause() and near(client.getCarState(NAME).speed, 0, 0.05))
client.simContinueForTime(1)
check("continued", client.getCarState(NAME).speed > 2)
client.simPause(False)

moving = client.simGetGroundTruthKinematics(NAME)
check("ground truth", moving.linear_velocity.get_length() > 2)
check("a multirotor has no wheels", "is a multirotor" in refusal(lambda: client.getCarState("Evader")))
client.reset()
state = client.getCarState(NAME)
check("reset", state.speed == 0 and state.kinematics_estimated.position.get_length() == 0)
client.enableApiControl(False, NAME)
check("given back", client.isApiControlEnabled(NAME) is False)
passed()
