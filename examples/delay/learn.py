"""Trains through a link whose delay comes and goes, with and without the ages of what is seen: by PPO of Stable-Baselines3,
or by SAC of SBX, its form in JAX."""

import argparse
import csv
from pathlib import Path

from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env

from skein_uav.delay import DelayEnv

# Delays of up to four steps each way, of two in InvertedPendulum. They hold for a second on the mean, so that a policy can make use of what it knows.
LINKS = {
    "Pendulum-v1": {"step_s": 0.05, "link": "correlated:1s,uniform:0ms..400ms"},
    "InvertedPendulum-v5": {"step_s": 0.04, "link": "correlated:1s,uniform:0ms..160ms"},
    "CartPole-v1": {"step_s": 0.02, "link": "correlated:1s,uniform:0ms..160ms"},
    "HalfCheetah-v5": {"step_s": 0.05, "link": "correlated:1s,uniform:0ms..400ms"},
}
LEARNING = {
    "Pendulum-v1": dict(n_steps=256, batch_size=128, gamma=0.9, learning_rate=1e-3, use_sde=True, sde_sample_freq=4),
    "InvertedPendulum-v5": dict(n_steps=64, batch_size=128, gamma=0.98, learning_rate=1e-3),
    "CartPole-v1": dict(n_steps=128, batch_size=256, n_epochs=8, gamma=0.98),
}
SAC_LEARNING = {
    "Pendulum-v1": dict(batch_size=128, learning_rate=1e-3, gamma=0.98, policy_kwargs=dict(net_arch=[64, 64])),
    "HalfCheetah-v5": dict(batch_size=128, learning_starts=2000, policy_kwargs=dict(net_arch=[128, 128])),
}
TOLD = {
    "no delay": None,
    "observation": {"ages": False},
    "observation, age": {},
    "observation, 8 pending actions": {"ages": False, "pending": 8},
    "observation, age, 8 pending actions": {"pending": 8},
}


def train(name, told, seed, steps, folder, by_sac):
    def delayed(env):
        return env if TOLD[told] is None else DelayEnv(env, **LINKS[name], **TOLD[told])

    path = folder / f"{name}-{told.replace(', ', '-').replace(' ', '_')}-{seed}"
    env = make_vec_env(name, 1 if by_sac else 8, seed=seed, wrapper_class=delayed)
    if by_sac:
        from sbx import SAC

        model = SAC("MlpPolicy", env, seed=seed, **SAC_LEARNING[name])
    else:
        model = PPO("MlpPolicy", env, seed=seed, **LEARNING[name])
    returns = []

    def note(values, _):
        for info in values["infos"]:
            if "episode" in info:
                returns.append((model.num_timesteps, info["episode"]["r"]))
        return True

    model.learn(steps, callback=note)
    with open(f"{path}.csv", "w", newline="") as file:
        csv.writer(file).writerows([("step", "return"), *returns])
    last = [one for _, one in returns[-len(returns) // 5 :]]
    print(f"{name}, {told}, seed {seed}: mean return of the last fifth of {len(returns)} episodes {sum(last) / len(last):.1f}")


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--environment", choices=LINKS, default="CartPole-v1")
    options.add_argument("--told", choices=TOLD, nargs="*", default=list(TOLD))
    options.add_argument("--seeds", type=int, nargs="*", default=[0])
    options.add_argument("--steps", type=int, default=60_000)
    options.add_argument("--sac", action="store_true", help="instead of PPO, in Pendulum; always in HalfCheetah")
    options.add_argument("--out", type=Path, default=Path("curves"))
    given = options.parse_args()
    given.out.mkdir(exist_ok=True)
    for seed in given.seeds:
        for told in given.told:
            by_sac = given.sac or given.environment not in LEARNING
            train(given.environment, told, seed, given.steps, given.out, by_sac)
