"""Steps a second, beside Gymnasium's own: python bench/python/environments.py. With a number, how long that many
steps take; the engine alone, without Python: ./sbtw 'bench/runMain skein.bench.EnvironmentSteps NUMBER'."""

import os
import resource
import sys
import time

import gymnasium as gym
import numpy as np

import skein_uav.environments  # noqa: F401

STRETCH_S, WARM_S = 0.3, 4.0  # of processor time


def rates(env):
    """Step calls a second, with actions that are always the same: by the clock, and by the processors' time; the best of
    ten stretches each, after one that does not count."""
    env.reset(seed=0)
    actions = np.zeros(env.action_space.shape, env.action_space.dtype)
    by_clock = by_processor = 0.0
    for number in range(11):
        calls, start, used = 0, time.perf_counter(), time.process_time()
        while time.process_time() - used < (STRETCH_S if number else WARM_S):
            for _ in range(20):
                env.step(actions)
            calls += 20
        if number:
            by_clock = max(by_clock, calls / (time.perf_counter() - start))
            by_processor = max(by_processor, calls / (time.process_time() - used))
    env.close()
    return by_clock, by_processor


def many(steps, count=4096):
    """What so many steps take, as `bench/runMain skein.bench.EnvironmentSteps` says it of the JVM."""
    env = gym.make_vec("skein_uav/Pursuit-v0", num_envs=count, link="vpn", copy=False, autoreset_mode="SameStep")
    env.reset(seed=0)
    actions = np.zeros((count, 1), np.float32)
    ends, distance, start = 0, 0.0, time.perf_counter()
    for _ in range(steps // count):
        _, _, _, truncated, infos = env.step(actions)
        if truncated[0]:
            ends, distance = ends + 1, distance + infos["distance_m"][0]
    print(
        f"{steps // count * count:,} steps in {time.perf_counter() - start:.1f} s, {time.process_time():.1f} s of processor time "
        f"with start and compilation; most memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024} MB; the first "
        f"environment ended {ends} times, at {distance / max(ends, 1):.3f} m"
    )


if __name__ == "__main__":
    if sys.argv[1:]:
        many(int(sys.argv[1]))
        sys.exit()
    print(f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors")
    for name, settings, sizes in (
        ("skein_uav/Pursuit-v0", {"link": "vpn"}, (1, 64, 1024, 4096)),
        ("skein_uav/Pursuit-v0", {"link": "vpn", "copy": False}, (64, 4096)),
        ("CartPole-v1", {"vectorization_mode": "vector_entry_point"}, (64, 4096)),
        ("CartPole-v1", {"vectorization_mode": "sync"}, (64,)),
    ):
        for size in sizes:
            clock, processor = rates(gym.make_vec(name, num_envs=size, **settings))
            print(
                f"{name} {settings} n={size}: {clock:,.0f} calls/s, {clock * size / 1e6:.1f} M steps/s; "
                f"a second of processor time {processor:,.0f} calls, {processor * size / 1e6:.1f} M steps"
            )
