"""What of a vector's rate is left behind the delay wrapper: python bench/python/delay_rates.py [ROUNDS].

The environment and its wrappers take 512 steps in turns, by processor time; printed are medians of the rounds' ratios, and
their quartiles. The witness is the mean age that was told."""

import os
import sys
import time
from statistics import median, quantiles

import gymnasium as gym
import numpy as np

from skein_uav.delay import DelayVectorEnv

STEPS = 512
CASES = (
    ("CartPole-v1", "vector_entry_point", 0.02, (64, 256, 1024, 4096)),
    ("CartPole-v1", "sync", 0.02, (64, 256, 1024)),
    ("Pendulum-v1", "sync", 0.05, (64, 256, 1024)),
    ("HalfCheetah-v5", "sync", 0.05, (64, 256, 1024)),
)
WRAPPERS = {
    "age": {"link": "vpn"},
    "age, 4 pending": {"link": "vpn", "pending": 4},
    "age, link none": {"link": "none"},
}


def seconds(env, actions, steps):
    """Processor time of so many steps, and the mean age told."""
    age, begin = 0.0, time.process_time()
    for number in range(steps):
        told = env.step(actions[number % len(actions)])[0]
        age += told[0, -1]
    return time.process_time() - begin, age / steps


def main(rounds, only):
    versions = f"NumPy {np.__version__}, Gymnasium {gym.__version__}"
    print(f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors, {versions}")
    for name, mode, step_s, counts in CASES:
        for count in counts if only in f"{name} {mode}" else ():
            def made():
                return gym.make_vec(name, num_envs=count, vectorization_mode=mode)

            envs = [made(), *(DelayVectorEnv(made(), step_s, **settings) for settings in WRAPPERS.values())]
            envs[0].action_space.seed(1)
            actions = [envs[0].action_space.sample() for _ in range(64)]
            for env in envs:
                env.reset(seed=1)
            steps = STEPS if mode != "sync" else max(STEPS * 64 // count // 4, 16)
            for env in envs:
                seconds(env, actions, steps // 4)
            took = [[seconds(env, actions, steps) for env in envs] for _ in range(rounds)]
            own = median(row[0][0] for row in took) / steps
            line = f"{name} {mode} {count}: own step {own * 1e6:.0f} us"
            for place, what in enumerate(WRAPPERS, 1):
                ratios = [row[0][0] / row[place][0] for row in took]
                low, _, high = quantiles(ratios, n=4)
                line += f"; {what} {median(ratios):.2f} ({low:.2f} to {high:.2f})"
            print(f"{line}; witness {took[0][1][1]:.6f}", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if sys.argv[1:] else 9, sys.argv[2] if sys.argv[2:] else "")
