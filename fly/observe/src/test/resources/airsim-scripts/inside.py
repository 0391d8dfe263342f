"""What a script knows of its own loop: how old the state was that it decided by, whenever it commanded."""

import json
import os
import time

# The simulator's clock is this machine's monotonic one, set to the epoch once.
OFFSET_NS = int(os.environ["SIMULATOR_CLOCK_NS"])

ages_ms = []


def commanded(state):
    ages_ms.append((time.monotonic_ns() + OFFSET_NS - state.timestamp) * 1e-6)


def told():
    """The last line of the script: ages in ms, in the order of the commands."""
    print(json.dumps([round(age, 3) for age in ages_ms]), flush=True)
