"""What the scripts that fly with the official client share: checks that end the script at the first that fails."""

import math
import sys
import time

from msgpackrpc.error import RPCError

checks = 0
started = time.monotonic()


def check(what, holds, found=None):
    global checks
    if not holds:
        sys.exit(f"FAILED: {what}; found {found}")
    checks += 1
    print(f"ok: {what}" + ("" if found is None else f" ({found})"))


def comes_to(what, holds, within_s=20):
    """Checks what is so after a while, however busy the machine is."""
    until = time.monotonic() + within_s
    while not holds() and time.monotonic() < until:
        time.sleep(0.02)
    check(what, holds())


def passed():
    print(f"PASSED {checks} checks in {time.monotonic() - started:.1f} s")


def near(a, b, tolerance):
    return abs(a - b) <= tolerance


def refusal(call):
    try:
        call()
    except RPCError as error:
        return str(error.args[0])
    return "no error"


def where(client, name=""):
    position = client.simGetGroundTruthKinematics(name).position
    return position.x_val, position.y_val, position.z_val


def arrives(client, what, goal, speed, within_m, name=""):
    """A move has ended: was it at its goal? The simulator does not wait, and a vehicle flies on while this process is told;
    so it is sent back, which takes it past its goal by less each time.
    """
    for _ in range(6):
        here = where(client, name)
        if math.dist(here, goal) < within_m:
            break
        client.moveToPositionAsync(*goal, speed, vehicle_name=name).join()
    check(what, math.dist(here, goal) < within_m, here)


def stamped(read, within_s=10):
    """The time stamp of a sensor's first reading, which comes up to a second after the start; 0 where none comes."""
    until = time.monotonic() + within_s
    while read().time_stamp == 0 and time.monotonic() < until:
        time.sleep(0.02)
    return read().time_stamp
