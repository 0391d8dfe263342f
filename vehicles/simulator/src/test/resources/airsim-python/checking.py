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


def waited(read, holds, within_s=20):
    """What is read as soon as it holds; else what was read last."""
    until = time.monotonic() + within_s
    value = read()
    while not holds(value) and time.monotonic() < until:
        time.sleep(0.02)
        value = read()
    return value


def comes_to(what, holds, within_s=20):
    """Checks what is so after a while, however busy the machine is."""
    check(what, waited(holds, bool, within_s))


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
    return waited(lambda: read().time_stamp, lambda stamp: stamp > 0, within_s)
