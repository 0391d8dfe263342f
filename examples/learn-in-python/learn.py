"""Teaches a pursuer by the cross-entropy method: a linear policy of what it sees, against the paper's evader over `vpn`."""

import gymnasium as gym
import numpy as np

import skein_uav.environments  # noqa: F401

env = gym.make_vec("skein_uav/Pursuit-v0", num_envs=512, link="vpn", episode_s=30)
random, mean, deviation = np.random.default_rng(1), np.zeros(9), np.ones(9)
scale = np.array([20, 20, 10, 10, 1, 1, 0.1, 0.1, 0.1])
for generation in range(20):
    weights = mean + deviation * random.normal(size=(512, 9))
    (seen, _), scores, flies = env.reset(seed=generation), np.zeros(512), np.full(512, True)
    while flies.any():
        seen, rewards, _, truncated, _ = env.step(np.tanh((seen / scale * weights).sum(1, keepdims=True)))
        scores += flies * rewards
        flies &= ~truncated
    best = weights[np.argsort(scores)[-50:]]
    mean, deviation = best.mean(0), best.std(0) + 0.02
    print(f"generation {generation}: mean distance {-scores.mean() / 30:.2f} m, best {-scores.max() / 30:.2f} m")
