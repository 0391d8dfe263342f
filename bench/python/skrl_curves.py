"""A learner that is not ours on our environment: SAC and PPO of skrl, by JAX, learn the pursuer's side as ./skein learn
does, with networks as wide, from as many steps of as many environments. Writes the learning curve as a table like
learning-curve.csv of ./skein learn, for

    ./sbtw "bench/runMain skein.bench.LearningCurves OUT.png 'NAME=FILE.csv' …"

Needs skrl[jax] beside the package: python bench/python/skrl_curves.py sac skrl-sac.csv"""

import argparse
import csv
import time

import flax.linen as nn
import jax
import numpy as np
from gymnasium.vector import AutoresetMode
from skrl import config
from skrl.agents.jax.ppo import PPO
from skrl.agents.jax.sac import SAC
from skrl.memories.jax import RandomMemory
from skrl.models.jax import DeterministicMixin, GaussianMixin, Model

from skein_uav.environments import PursuitVectorEnv

#: What is seen is divided by, as ./skein learn does.
SCALES = np.array([20, 20, 10, 10, 1, 1, 0.2, 0.2, 0.2], np.float32)
#: Rewards are multiplied by, as there.
REWARD = 0.1
GROUP = 128  # environments that share a link, and here all else: one of each is looked at


class Actor(GaussianMixin, Model):
    """tanh of two hidden layers of 32, and how widely it draws: everywhere equally, or where it says so."""

    wide: bool = True

    def __init__(self, wide=True, **spaces):
        Model.__init__(self, **spaces)
        self.wide = wide
        GaussianMixin.__init__(self, clip_actions=wide, min_log_std=-5)

    @nn.compact
    def __call__(self, inputs, role):
        hidden = inputs["observations"]
        for _ in range(2):
            hidden = nn.relu(nn.Dense(32)(hidden))
        if self.wide:
            both = nn.Dense(2)(hidden)
            return nn.tanh(both[:, :1]), {"log_std": both[:, 1:]}
        spread = self.param("log_std", lambda _: np.full(1, np.log(0.6), np.float32))
        return nn.tanh(nn.Dense(1, kernel_init=nn.initializers.variance_scaling(1e-4, "fan_in", "normal"))(hidden)), {"log_std": spread}


class Critic(DeterministicMixin, Model):
    """What an action is worth where something is seen, or what is seen alone."""

    of_actions: bool = False

    def __init__(self, of_actions=False, **spaces):
        Model.__init__(self, **spaces)
        self.of_actions = of_actions
        DeterministicMixin.__init__(self)

    @nn.compact
    def __call__(self, inputs, role):
        hidden = inputs["observations"]
        if self.of_actions:
            hidden = jax.numpy.concatenate([hidden, inputs["taken_actions"]], axis=-1)
        for _ in range(2):
            hidden = nn.relu(nn.Dense(32)(hidden))
        return nn.Dense(1)(hidden), {}


def agent_of(algorithm, environments, spaces):
    quiet = {"experiment": {"write_interval": 0, "checkpoint_interval": 0}}
    models = {"policy": Actor(algorithm == "sac", **spaces)}
    if algorithm == "sac":
        for name in ("critic_1", "critic_2", "target_critic_1", "target_critic_2"):
            models[name] = Critic(True, **spaces)
        memory = RandomMemory(memory_size=300_000 // environments, num_envs=environments, replacement=True)
        settings = {
            "gradient_steps": environments // 8,
            "batch_size": 256,
            "discount_factor": 0.98,
            "learning_rate": 1e-3,
            "random_timesteps": 4096 // environments,
            "learning_starts": 4096 // environments,
            "initial_entropy_value": 0.1,
        }
    else:
        models["value"] = Critic(False, **spaces)
        memory = RandomMemory(memory_size=100, num_envs=environments)
        settings = {
            "rollouts": 100,
            "learning_epochs": 10,
            "mini_batches": 100 * environments // 256,
            "discount_factor": 0.99,
            "learning_rate": 3e-4,
            "grad_norm_clip": 0.5,
            "value_clip": 0,
            "value_loss_scale": 0.5,
            # Episodes end by their time alone.
            "time_limit_bootstrap": True,
        }
    for role, model in models.items():
        model.init_state_dict(role=role)
    kind = SAC if algorithm == "sac" else PPO
    agent = kind(
        models=models,
        memory=memory,
        observation_space=spaces["observation_space"],
        action_space=spaces["action_space"],
        cfg={**settings, **quiet},
    )
    agent.init()
    agent.enable_training_mode(True)
    return agent


def judged(env, actor):
    """Distances over the last 10 s of an episode over each link, m, without anything tried out."""
    layers = [jax.device_get(layer) for name, layer in sorted(actor.state_dict.params["params"].items()) if name.startswith("Dense")]
    seen, infos = env.reset(seed=1)
    distances = []
    while True:
        hidden = seen[::GROUP] / SCALES
        for layer in layers[:-1]:
            hidden = np.maximum(hidden @ layer["kernel"] + layer["bias"], 0)
        action = np.tanh((hidden @ layers[-1]["kernel"] + layers[-1]["bias"])[:, :1])
        seen, _, _, truncated, infos = env.step(np.repeat(action, GROUP, axis=0))
        late = infos["time_s"][::GROUP] > 50
        distances.append(np.where(late, infos["distance_m"][::GROUP], np.nan))
        if truncated.any():
            return np.nanmean(distances, axis=0)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("algorithm", choices=["sac", "ppo"])
    options.add_argument("out")
    options.add_argument("--steps", type=int, default=600_000, help="of all environments together")
    options.add_argument("--environments", type=int, default=64)
    options.add_argument("--seed", type=int, default=1)
    asked = options.parse_args()

    config.jax.key = asked.seed
    np.random.seed(asked.seed)
    task = {"link": "vpn", "loop": "stream", "turn_rate_rad_per_s": 3.0}
    env = PursuitVectorEnv(
        asked.environments, **task, episode_s=20, start_within_m=(3, 30), autoreset_mode=AutoresetMode.SAME_STEP
    )
    judge = PursuitVectorEnv(20 * GROUP, **task, episode_s=60)
    spaces = {"observation_space": env.single_observation_space, "action_space": env.single_action_space}
    agent = agent_of(asked.algorithm, asked.environments, spaces)

    calls = asked.steps // asked.environments
    seen, _ = env.reset(seed=asked.seed)
    with open(asked.out, "w", newline="") as file:
        curve = csv.writer(file)
        curve.writerow(["steps", "mean", "sd"])
        for call in range(calls):
            at = {"timestep": call, "timesteps": calls}
            agent.pre_interaction(**at)
            actions, _ = agent.act(seen / SCALES, None, **at)
            reached, rewards, terminated, truncated, infos = env.step(np.asarray(actions))
            came = reached.copy()
            for number in np.flatnonzero(infos.get("_final_obs", [])):
                came[number] = infos["final_obs"][number]
            agent.record_transition(
                observations=seen / SCALES,
                states=None,
                actions=actions,
                rewards=(rewards * REWARD)[:, None],
                next_observations=came / SCALES,
                next_states=None,
                terminated=terminated[:, None],
                truncated=truncated[:, None],
                infos={},
                **at,
            )
            agent.post_interaction(**at)
            seen = reached
            if (call + 1) % (calls // 30) == 0:
                distances = judged(judge, agent.models["policy"])
                steps = (call + 1) * asked.environments
                curve.writerow([steps, distances.mean(), distances.std(ddof=1)])
                file.flush()
                print(f"{steps} steps: {distances.mean():.2f} m; {time.process_time():.0f} s of processor time", flush=True)


if __name__ == "__main__":
    main()
