import math
import re
from pathlib import Path

import numpy as np
import pytest

from skein_uav.delay import Delay, Trace, delays
from skein_uav.delay.schedule import Schedule

gym = pytest.importorskip("gymnasium")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode, SyncVectorEnv, VectorEnv  # noqa: E402
from gymnasium.wrappers import DelayObservation  # noqa: E402

from skein_uav.delay import DelayEnv, DelayVectorEnv  # noqa: E402

STEP_S = 0.05
LINKS = ["direct", "vpn", "correlated:250ms,vpn", "vpn-mixed", "uniform:0ms..300ms", 0.12]


class Counter(gym.Env):
    """Shows its number of episodes, its time, and the action that acted last; ends after ``length`` steps."""

    def __init__(self, length=1000, step=1.0):
        self.observation_space = gym.spaces.Box(-1e9, 1e9, (3,), np.float64)
        self.action_space = gym.spaces.Box(-1e9, 1e9, (1,), np.float64)
        self.length, self.step_length, self.episode = length, step, 0

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.episode, self.time, self.acted = self.episode + 1, 0.0, -1.0
        return self.seen(), {}

    def step(self, action):
        self.time += self.step_length
        self.acted = float(action[0])
        return self.seen(), self.acted, self.time >= self.length, False, {}

    def seen(self):
        return np.array([self.episode, self.time, self.acted])


def flown(env, actions, seed=7):
    """The first observation of an environment, then the results of its steps under these actions."""
    told = [env.reset(seed=seed)[0]]
    for action in actions:
        told.append(env.step(action)[:4])
    return told


def same(one, other):
    return all(np.array_equal(a, b) for x, y in zip(one, other, strict=True) for a, b in zip(x, y, strict=True))


def reference(count, step_s, back_s, to_s, rows):
    """The observed and the acting row at each row, computed one by one from delays in s of shape (rows, count)."""
    seen, acts = (np.full((rows, count), -1) for _ in range(2))
    for env in range(count):
        arrives = 0.0
        for sent in range(rows):
            at = sent * step_s + back_s[sent, env]
            for row in range(rows):
                if row * step_s >= at - 1e-9:
                    seen[row, env] = max(seen[row, env], sent)
            arrives = max(arrives, sent * step_s + to_s[sent, env])
            for row in range(rows):
                if row * step_s >= arrives - 1e-9:
                    acts[row, env] = sent
    return seen, acts


# Delays.


def test_profiles_have_the_quantiles_of_skeins_source():
    source = Path(__file__).parents[3] / "core/core/src/main/scala/skein/signal/LatencyDistribution.scala"
    if not source.exists():
        pytest.skip("not in a checkout")
    text = source.read_text()
    numbers = {name: [float(one) for one in re.findall(r"[\d.]+", values)] for name, values in re.findall(
        r"val (published|Direct|Vpn)\b[^=]*=[^V]*Vector\(([^)]*)\)", text)}
    from skein_uav.delay import profiles

    assert numbers["published"] == list(np.rint(profiles._PUBLISHED * 100))
    assert numbers["Direct"] == profiles._DIRECT_MS and numbers["Vpn"] == profiles._VPN_MS


@pytest.mark.parametrize(
    "text, mean_ms", [("none", 0), ("direct", 36.8), ("vpn", 102.8), ("constant:200ms", 200), ("uniform:10ms..40ms", 25),
                      ("lognormal:36ms,0.3", 36 * math.exp(0.045)), ("correlated:1s,vpn", 102.8)]
)
def test_one_direction_takes_half_of_a_round_trip(text, mean_ms):
    assert 2000 * delays(text).mean_of(lambda one: one) == pytest.approx(mean_ms, rel=0.01, abs=1e-9)


def test_files_hold_round_trips(tmp_path):
    path = tmp_path / "samples"
    path.write_text("# ms\n10\n\n30\n")
    assert delays(f"file:{path}").longest_s == pytest.approx(0.015, rel=1e-3)
    path.write_text("10\nmany\n")
    with pytest.raises(ValueError, match="link: expected a round trip in ms in line 2 of .*, got 'many'"):
        delays(f"file:{path}", "link")


@pytest.mark.parametrize(
    "given, told",
    [
        ({"link": "wifi"}, "link: expected none, direct, .*, got 'wifi'"),
        ({"link": "rate:50mbit,vpn"}, "link: expected a link without a rate"),
        ({"link": "constant:2h"}, "link: expected a time such as 200ms"),
        ({"link": "uniform:40ms..10ms"}, "link: expected the smaller time first"),
        ({"link": "lognormal:36ms,x"}, "link: expected a standard deviation"),
        ({"link": "correlated:0s,vpn"}, "link: expected a time constant of more than 0"),
        ({"link": 0.1}, "link: expected a profile, .* got 0.1; delays of one direction in s are observation_delay"),
        ({"link": "vpn", "observation_delay": 0.1, "action_delay": 0.1}, "link: expected none beside"),
        ({"action_delay": -0.1}, r"action_delay: expected delays in s from 0 .*, got -0.1"),
        ({"action_delay": [0.1, math.nan]}, "action_delay: expected delays in s"),
        ({"action_delay": lambda: 0.1}, "action_delay: expected a profile, a number or array of s, or a Trace, got <function"),
        ({"link": "correlated:vpn,250ms"}, "link: expected a time such as 200ms, of at most an hour, got 'vpn'"),
        ({"action_delay": np.ones((10, 3))}, r"expected delays of shape \(times,\) or \(times, environments = 4\), got \(10, 3\)"),
        ({"observation_delay": Trace(np.ones(3), 0.0)}, "observation_delay: expected more than 0 s from one"),
        ({"observation_delay": 60.0, "action_delay": 60.0}, "expected delays of at most 1000 steps of 0.05 s, got up to 60 s"),
        ({"step_s": 0}, "step_s: expected more than 0 s, got 0"),
        ({"dropout": 1}, "dropout: expected a share from 0 to 0.9, got 1"),
        ({"moves_in_flight": 1}, "moves_in_flight: expected None or at least 2, got 1"),
        ({"moves_in_flight": 2, "dropout": 0.1}, "dropout: expected 0 beside moves_in_flight"),
        ({"arrival": "soon"}, "arrival: expected 'next' or 'share', got 'soon'"),
        ({"first": "ones"}, "first: expected 'known' or 'zeros', got 'ones'"),
        ({"pending": -1}, "pending: expected from 0 to 1000, got -1"),
    ],
)
def test_wrong_settings_are_told(given, told):
    with pytest.raises(ValueError, match=told):
        Delay(4, **{"step_s": STEP_S, **given})


def test_times_that_seem_to_be_in_ms_are_doubted_and_a_step_before_reset_refused():
    with pytest.warns(UserWarning, match="step_s is 20 s, and delays are of at most 0.103 s: is it in s?"):
        Delay(4, 20, link="vpn")
    with pytest.warns(UserWarning, match="delays are of up to 40 s: are they in s?"):
        Delay(4, STEP_S, observation_delay=40)
    with pytest.raises(RuntimeError, match="expected reset, .* before the first step"):
        DelayEnv(Counter(10), STEP_S, link="vpn").step(0)


# The schedule.


def test_the_schedule_is_what_arrivals_one_by_one_give():
    random = np.random.default_rng(3)
    back, to = random.uniform(0, 0.4, (2, 1500, 3))
    back[::7], to[::5] = 2 * STEP_S, STEP_S
    schedule = Schedule(3, STEP_S, delays(back), delays(to))
    schedule.seed(np.random.SeedSequence(0).spawn(3))
    seen, acts = reference(3, STEP_S, back[:700], to[:700], 700)
    for row in range(700):
        at = schedule.row(row)
        assert np.array_equal(np.maximum(row - schedule.seen[at], -1), seen[row]), row
        assert np.array_equal(np.maximum(row - schedule.acts[at], -1), acts[row]), row


@pytest.mark.parametrize("rows", [0, 3, 700])
@pytest.mark.parametrize("every", [1, 3])
def test_constant_delays_are_those_of_a_trace_of_them(rows, every):
    constant, trace = (
        Schedule(2, STEP_S, delays(back), delays(to), every=every)
        for back, to in ((rows * STEP_S, 2 * STEP_S), ([rows * STEP_S], [2 * STEP_S]))
    )
    for one in (constant, trace):
        one.seed(np.random.SeedSequence(0).spawn(2))
    for row in range(0, 5 * constant.rows, 7):
        at = constant.row(row)
        assert trace.row(row) == at
        assert np.array_equal(constant.seen[at], trace.seen[at]) and np.array_equal(constant.acts[at], trace.acts[at]), row


@pytest.mark.parametrize("link", LINKS)
@pytest.mark.parametrize("settings", [{}, {"dropout": 0.3}, {"moves_in_flight": 2}, {"shares": True}, {"every": 3}])
def test_no_schedule_is_older_than_it_says(link, settings):
    one = delays(link)
    schedule = Schedule(8, STEP_S, one, one, compute_s=0.013, **settings)
    schedule.seed(np.random.SeedSequence(1).spawn(8))
    for _ in range(5):
        schedule.row(schedule.first + schedule.rows)
        assert schedule.seen.max() <= schedule.oldest_seen and schedule.acts.max() <= schedule.oldest_acting
        assert schedule.seen.min() >= 0 and schedule.acts.min() >= 0
        # Observations and acting actions age at most by the time that passes: only newer ones replace them.
        assert np.all(np.diff(schedule.seen.astype(int), axis=0) <= 1)
        if settings.get("shares"):
            assert np.allclose(schedule.weights.sum(1), 1)


@pytest.mark.parametrize("over_s", [0.25, 1.0])
def test_correlated_delays_forget_as_they_say_and_hold_in_both_directions(over_s):
    one = delays(f"correlated:{over_s}s,vpn")
    schedule = Schedule(64, 0.05, one, one, shares=True)
    schedule.seed(np.random.SeedSequence(5).spawn(64))
    held = []
    for _ in range(20):
        held.append(schedule._back._held)
        schedule.row(schedule.first + schedule.rows)
    held = np.concatenate(held) - 511.5
    for lag in (1, 5):
        correlation = (held[lag:] * held[:-lag]).mean() / (held**2).mean()
        assert correlation == pytest.approx(math.exp(-lag * 0.05 / over_s), abs=0.02)
    assert held.mean() == pytest.approx(0, abs=15)


def test_vpn_mixed_is_busy_393_of_935_times_for_40_s_on_the_mean():
    one = delays("vpn-mixed")
    schedule = Schedule(256, 1.0, one, one)
    schedule.seed(np.random.SeedSequence(5).spawn(256))
    busy = []
    for _ in range(8):
        busy.append(schedule._back._is_busy)
        schedule.row(schedule.first + schedule.rows)
    busy = np.concatenate(busy)
    assert busy.mean() == pytest.approx(393 / 935, abs=0.01)
    # The share of busy stretches, whose lengths are exponential, that end within a second.
    assert (busy[:-1] & ~busy[1:]).sum() / busy.sum() == pytest.approx(1 - math.exp(-1 / 40), rel=0.06)


def test_dropout_loses_its_share():
    one = delays(0.0)
    schedule = Schedule(64, 1.0, one, one, dropout=0.25)
    schedule.seed(np.random.SeedSequence(5).spawn(64))
    assert (schedule.seen > 0).mean() == pytest.approx(0.25, abs=0.01)
    assert (schedule.acts > 0).mean() == pytest.approx(0.25, abs=0.01)
    assert np.corrcoef((schedule.seen > 0).ravel(), (schedule.acts > 0).ravel())[0, 1] == pytest.approx(0, abs=0.02)


def test_with_two_moves_in_flight_an_action_leaves_once_a_round_trip():
    schedule = Schedule(1, 0.1, delays(0.1), delays(0.1), moves_in_flight=2)
    schedule.seed([np.random.SeedSequence(0)])
    # 0 and 1 leave immediately. 1 arrives at 2, so 0 is answered at 3: then 3 leaves, and 2 is superseded.
    newest = np.arange(12) - schedule.acts[:12, 0]
    assert list(newest[2:]) == [1, 1, 3, 3, 5, 5, 7, 7, 9, 9]


# Actions and observations under delay.


def test_an_action_acts_for_the_rest_of_the_step_in_which_it_arrives():
    delay = Delay(1, 0.1, action_delay=0.03, arrival="share", idle_action=5.0)
    delay.begin(np.zeros((1, 1)))
    assert delay.acting(np.array([[1.0]]))[0, 0] == pytest.approx(0.3 * 5 + 0.7 * 1)
    delay.seen(np.zeros((1, 1)))
    assert delay.acting(np.array([[2.0]]))[0, 0] == pytest.approx(0.3 * 1 + 0.7 * 2)
    whole = Delay(1, 0.1, action_delay=0.03, idle_action=5.0)
    whole.begin(np.zeros((1, 1)))
    assert whole.acting(np.array([[1.0]]))[0, 0] == 5
    whole.seen(np.zeros((1, 1)))
    assert whole.acting(np.array([[2.0]]))[0, 0] == 1
    with pytest.raises(ValueError, match="arrival: expected 'next', since there is no mean of actions of int64"):
        Delay(1, 0.1, arrival="share").begin(np.zeros((1, 1)), actions=np.zeros(1, dtype=np.int64))


def test_substeps_are_as_fine_as_steps_and_add_rewards():
    env = DelayEnv(Counter(), 0.025, observation_delay=0.05, action_delay=0.05, substeps=4)
    told, _ = env.reset(seed=1)
    assert told[1] == 0 and told[3] == 0
    told, reward, *_ = env.step(np.array([10.0]))
    assert reward == 0 + 0 + 10 + 10  # on its way for two of the four
    assert list(told) == [1, 2, 0, 0.05]
    told, reward, *_ = env.step(np.array([20.0]))
    assert reward == 10 + 10 + 20 + 20
    assert list(told) == [1, 6, 10, 0.05]


def test_shares_last_however_long_the_episode():
    env = DelayEnv(Counter(2000), STEP_S, observation_delay=0.07, action_delay=0.07, substeps=5, arrival="share")
    env.reset()
    for decision in range(1, 300):
        _, reward, *_ = env.step(np.array([float(decision)]))
        assert reward == pytest.approx(1.4 * (decision - 1) + 3.6 * decision)


@pytest.mark.parametrize("length", [3, 6])
def test_an_episode_that_ends_between_two_decisions_leaves_nothing_behind(length):
    env = DelayEnv(Counter(length), 0.025, observation_delay=0.05, action_delay=0.05, substeps=4, pending=2)
    for _ in range(3):
        told, _ = env.reset()
        assert list(told[1:]) == [0, -1, 0, 0, 0]
        ended = False
        rewards = 0
        while not ended:
            told, reward, ended, *_ = env.step(np.array([10.0]))
            rewards += reward
        assert rewards == 10 * (length - 2) and told[1] == length - 2


def test_with_no_delay_everything_is_as_without_the_wrapper():
    for name, count in (("CartPole-v1", 300), ("Pendulum-v1", 250)):
        for settings in ({}, {"moves_in_flight": 2}, *([{"arrival": "share"}] if name[0] == "P" else [])):
            bare, wrapped = gym.make(name), DelayEnv(gym.make(name), STEP_S, ages=False, **settings)
            bare.action_space.seed(3)
            for seed in range(8):
                (one, _), (other, _) = bare.reset(seed=seed), wrapped.reset(seed=seed)
                assert np.array_equal(one, other)
                for _ in range(count):
                    action = bare.action_space.sample()
                    one, other = bare.step(action), wrapped.step(action)
                    assert same([one[:4]], [other[:4]])
                    if one[2] or one[3]:
                        break


@pytest.mark.parametrize("steps", [0, 1, 2, 5])
@pytest.mark.parametrize("step_s", [0.05, 1 / 30, 1 / 60, 0.02])
def test_whole_steps_are_gymnasiums_delay_observation(steps, step_s):
    theirs = DelayObservation(gym.make("Pendulum-v1"), steps)
    ours = DelayEnv(
        gym.make("Pendulum-v1"), step_s, observation_delay=steps * step_s, action_delay=0, first="zeros", ages=False
    )
    actions = np.random.default_rng(2).uniform(-2, 2, (60, 1)).astype(np.float32)
    for seed in range(3):
        assert same([flown(theirs, [], seed)[0][None]], [flown(ours, [], seed)[0][None]])
        assert same(flown(theirs, actions, seed)[1:], flown(ours, actions, seed)[1:])


def test_ages_tell_when_what_is_seen_was():
    env = DelayEnv(Counter(), STEP_S, link="vpn", pending=3)
    for seed in range(5):
        told, _ = env.reset(seed=seed)
        for step in range(1, 400):
            told, *_ = env.step(np.array([float(step)]))
            assert told[3] == pytest.approx(step * STEP_S - told[1] * STEP_S, abs=1e-12)
            assert told in env.observation_space
            assert list(told[4:]) == [max(one, 0) for one in (step - 2, step - 1, step)]


@pytest.mark.parametrize("settings", [{}, {"action_delay": 0.02, "compute_s": 0.03}, {"substeps": 2}, {"arrival": "share"}])
def test_a_true_model_predicts_where_the_action_acts(settings):
    class Leaky(Counter):
        def step(self, action):
            self.time, self.acted = self.time + 1, 0.5 * self.acted + float(action[0])
            return self.seen(), self.acted, False, False, {}

    def model(observation, action):
        later = observation.copy()
        later[:, 1] += 1
        later[:, 2] = 0.5 * later[:, 2] + action[:, 0]
        return later

    settings = {"observation_delay": 0.1, "action_delay": 0.15, **settings}
    if settings.get("arrival") == "share":
        settings["action_delay"] = 0.15
    env = DelayEnv(Leaky(), STEP_S, predict=model, ages=False, **settings)
    told, _ = env.reset(seed=0)
    ahead, random, predicted = env._delay._ahead, np.random.default_rng(4), []
    for _ in range(50):
        predicted.append(told)
        told, *_ = env.step(random.normal(size=1))
        now = env.unwrapped.seen()
        for one in predicted:
            if one[1] == now[1]:
                assert np.array_equal(one, now)
    assert predicted[10][1] == 10 * settings.get("substeps", 1) + ahead


def test_a_vectors_environments_are_single_ones():
    settings = {"link": "correlated:300ms,vpn", "action_delay": "vpn", "pending": 2, "dropout": 0.1}
    vector = DelayVectorEnv(SyncVectorEnv([Counter for _ in range(5)]), STEP_S, **settings)
    singles = [DelayEnv(Counter(), STEP_S, **settings) for _ in range(5)]
    for _ in range(2):
        told, _ = vector.reset(seed=11)
        alone = [env.reset(seed=11 + number)[0] for number, env in enumerate(singles)]
        assert np.array_equal(told, alone)
        for step in range(700):
            actions = np.random.default_rng(step).normal(size=(5, 1))
            told, rewards, *_ = vector.step(actions)
            alone = [env.step(action)[:2] for env, action in zip(singles, actions)]
            assert np.array_equal(told, [one[0] for one in alone])
            assert np.array_equal(rewards, [one[1] for one in alone])


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_no_episode_sees_or_feels_the_one_before(mode):
    lengths = [3, 5, 8, 40]
    env = DelayVectorEnv(
        SyncVectorEnv([lambda one=one: Counter(one) for one in lengths], autoreset_mode=mode),
        STEP_S,
        link="vpn",
        pending=2,
    )
    told, _ = env.reset(seed=3)
    episode, time, idle = np.ones(4), np.zeros(4), np.zeros(4, bool)
    for step in range(1, 120):
        told, rewards, terminated, _, infos = env.step(np.full((4, 1), float(step)))
        begun = idle if mode is AutoresetMode.NEXT_STEP else np.zeros(4, bool)
        time = np.where(begun, 0, time + 1)
        episode = episode + begun
        assert np.array_equal(terminated, (time == lengths) & ~begun)
        # The action that acted was chosen in this episode, or none acted.
        assert np.all((rewards == 0) | (rewards > step - time) | begun)
        if mode is AutoresetMode.SAME_STEP and terminated.any():
            for at in np.flatnonzero(terminated):
                final = infos["final_obs"][at]
                assert final[0] == episode[at] and final[3] == pytest.approx((time[at] - final[1]) * STEP_S)
            assert all(infos["final_obs"][at] is None for at in np.flatnonzero(~terminated))
            time, episode = np.where(terminated, 0, time), episode + terminated
        if mode is AutoresetMode.DISABLED and terminated.any():
            told, _ = env.reset(options={"reset_mask": terminated})
            time, episode = np.where(terminated, 0, time), episode + terminated
        assert np.array_equal(told[:, 0], episode)
        assert told[:, 3] == pytest.approx((time - told[:, 1]) * STEP_S)
        assert np.all(told[time == 0][:, 4:] == 0) and np.array_equal(told[time > 0][:, 5], np.full((time > 0).sum(), step))
        assert told in env.observation_space
        idle = terminated


class Plain:
    """A delayed vector of environments, computed from lists, one environment and one step at a time."""

    def __init__(self, back_rows, to_rows, pending, is_zero):
        sent = np.arange(len(back_rows))[:, None]
        self.comes, self.arrives = sent + back_rows, np.maximum.accumulate(sent + to_rows)  # in their order
        self.pending, self.is_zero, self.row = pending, is_zero, 0
        self.episodes = [None] * back_rows.shape[1]

    def begin(self, env, observation):
        self.episodes[env] = {"began": self.row, "seen": {self.row: observation}, "decided": {}}

    def act(self, actions):
        """Takes the decisions of a step; returns the actions that act in it."""
        acting = []
        for env, action in enumerate(actions):
            decided = self.episodes[env]["decided"]
            decided[self.row] = action
            arrived = [sent for sent in decided if self.arrives[sent, env] <= self.row]
            acting.append(decided[max(arrived)] if arrived else np.zeros_like(action))
        self.row += 1
        return np.array(acting)

    def told(self, env):
        episode = self.episodes[env]
        arrived = [taken for taken in episode["seen"] if self.comes[taken, env] <= self.row]
        newest = max(arrived, default=episode["began"])
        observation = episode["seen"][newest] * (0 if self.is_zero and not arrived else 1)
        last = [episode["decided"].get(row, np.zeros(1)) for row in range(self.row - self.pending, self.row)]
        return np.concatenate([observation, [(self.row - newest) * STEP_S], *last])


@pytest.mark.parametrize("mode", list(AutoresetMode))
@pytest.mark.parametrize("case", range(6))
def test_a_vector_is_told_what_lists_of_messages_tell(mode, case):
    random = np.random.default_rng([case, list(AutoresetMode).index(mode)])
    count, steps, pending = int(random.integers(1, 9)), 200, int(random.integers(0, 4))
    most, is_zero = int(random.integers(0, 90 if case else 1)), bool(random.integers(2))
    back, to = random.integers(0, most + 1, (2, 1024, count))
    lengths = random.integers(2, 60, count)
    env = DelayVectorEnv(
        SyncVectorEnv([lambda one=one: Counter(one) for one in lengths], autoreset_mode=mode),
        STEP_S,
        observation_delay=back * STEP_S,
        action_delay=to * STEP_S,
        first="zeros" if is_zero else "known",
        pending=pending,
    )
    bare = SyncVectorEnv([lambda one=one: Counter(one) for one in lengths], autoreset_mode=mode)
    plain = Plain(back, to, pending, is_zero)

    def begin(mask, observations):
        for one in np.flatnonzero(mask):
            plain.begin(one, observations[one])

    begin(np.ones(count, bool), bare.reset()[0])
    told, began = env.reset(seed=case)[0], np.zeros(count, bool)
    for _ in range(steps):
        assert np.array_equal(told, [plain.told(one) for one in range(count)])
        actions = random.normal(size=(count, 1))
        told, rewards, ended, _, infos = env.step(actions)
        observations, expected, _, _, finals = bare.step(plain.act(actions))
        assert np.array_equal(rewards, expected)
        for one in range(count):
            is_final = mode is AutoresetMode.SAME_STEP and ended[one]
            plain.episodes[one]["seen"][plain.row] = finals["final_obs"][one] if is_final else observations[one]
            if is_final:
                assert np.array_equal(infos["final_obs"][one], plain.told(one))
        if mode is AutoresetMode.NEXT_STEP:
            begin(began, observations)
            began = ended
        elif mode is AutoresetMode.SAME_STEP:
            begin(ended, observations)
        elif ended.any():
            begin(ended, bare.reset(options={"reset_mask": ended})[0])
            told, _ = env.reset(options={"reset_mask": ended})


def test_ends_may_be_numbers():
    class Numbers(gym.vector.VectorWrapper):
        def step(self, actions):
            seen, rewards, terminated, truncated, infos = self.env.step(actions)
            return seen, rewards, terminated.astype(np.uint8), truncated.astype(np.uint8), infos

    def made():
        return SyncVectorEnv([lambda one=one: Counter(one) for one in (3, 5)])

    envs = [DelayVectorEnv(one, STEP_S, link="vpn", pending=2) for one in (made(), Numbers(made()))]
    assert same(*(flown(env, np.ones((20, 2, 1)))[1:] for env in envs))


def test_what_was_told_stays_as_it_was():
    env = DelayVectorEnv(SyncVectorEnv([Counter] * 3), STEP_S, link="vpn", pending=2)
    told = [env.reset(seed=1)[0]]
    copies = [told[0].copy()]
    for step in range(1100):
        told.append(env.step(np.full((3, 1), float(step)))[0])
        copies.append(told[-1].copy())
    assert all(np.array_equal(one, other) for one, other in zip(told, copies))


def test_observations_may_be_of_another_kind_of_float_than_their_space_says():
    class Careless(Counter):
        def step(self, action):
            seen, *others = super().step(action)
            return np.float64(seen) + 1e-9, *others

        def reset(self, **options):
            return np.float32(super().reset(**options)[0]), {}

    env = DelayEnv(Careless(), STEP_S, observation_delay=0.1, action_delay=0)
    env.reset(seed=1)
    told = [env.step(np.zeros(1))[0] for _ in range(5)]
    assert told[-1][1] == 3 + 1e-9 and told[-1][3] == 0.1


def test_seeds_repeat_and_are_not_the_environments():
    def ages(reset, **settings):
        env = DelayVectorEnv(SyncVectorEnv([Counter] * 3), STEP_S, link="vpn", **settings)
        env.reset(seed=reset)
        return np.array([env.step(np.zeros((3, 1)))[0][:, 3] for _ in range(50)])

    assert np.array_equal(ages(1), ages(1)) and not np.array_equal(ages(1), ages(2))
    assert np.array_equal(ages(None, seed=4), ages(None, seed=4))
    assert not np.array_equal(ages(1)[:, 0], ages(1)[:, 1])
    assert np.array_equal(ages(1)[:, 1], ages(2)[:, 0])
    bare, wrapped = gym.make("Pendulum-v1"), DelayEnv(gym.make("Pendulum-v1"), STEP_S, link="vpn")
    for seed in (5, None):
        assert np.array_equal(bare.reset(seed=seed)[0], wrapped.reset(seed=seed)[0][:3])


def test_a_trace_plays_in_its_order_from_anywhere():
    trace = np.arange(1, 11) * STEP_S
    env = DelayEnv(Counter(), STEP_S, observation_delay=Trace(trace), action_delay=0)
    env.reset(seed=0)
    ages = [round(env.step(np.zeros(1))[0][3] / STEP_S) for _ in range(100)]
    assert ages[30:40] == ages[40:50] and len(set(ages[30:40])) > 3
    halved = DelayEnv(Counter(), STEP_S, observation_delay=Trace(np.array([[0.0], [0.1]]), every_s=0.2), action_delay=0)
    halved.reset(seed=0)
    assert [round(halved.step(np.zeros(1))[0][3] / STEP_S) for _ in range(12)][:9] == [0, 0, 0, 1, 2, 2, 2, 0, 0]


# Spaces.

# The checker warns about wrappers, and about faults of the wrapped environments.
a_wrapper = pytest.mark.filterwarnings("ignore::UserWarning")


@pytest.mark.parametrize("name", ["CartPole-v1", "Pendulum-v1"])
@pytest.mark.parametrize(
    "settings", [{}, {"pending": 3}, {"ages": False}, {"first": "zeros"}, {"substeps": 3}, {"moves_in_flight": 2}]
)
@a_wrapper
def test_gymnasium_finds_nothing_wrong(name, settings):
    env = DelayEnv(gym.make(name), STEP_S, link="vpn", **settings)
    check_env(env, skip_render_check=True)
    again = gym.make(env.spec)
    actions = [env.action_space.sample() for _ in range(5)]
    assert same(flown(env, actions)[1:], flown(again, actions)[1:])


@a_wrapper
def test_observations_that_are_no_vectors_become_dicts():
    class Odd(gym.Env):
        observation_space = gym.spaces.Dict(
            {"picture": gym.spaces.Box(0, 255, (4, 4, 3), np.uint8), "place": gym.spaces.Tuple([gym.spaces.Discrete(7)] * 2)}
        )
        action_space = gym.spaces.Discrete(3, start=2)

        def reset(self, *, seed=None, options=None):
            super().reset(seed=seed)
            self.observation_space.seed(seed)
            self.steps = 0
            return self.observation_space.sample(), {}

        def step(self, action):
            assert action in self.action_space
            self.steps += 1
            return self.observation_space.sample(), 0.0, self.steps == 9, False, {}

    env = DelayEnv(Odd(), STEP_S, link="vpn", pending=2)
    check_env(env, skip_render_check=True)
    told, _ = env.reset(seed=1)
    assert list(told) == ["observation", "age_s", "pending"] and list(told["pending"]) == [2, 2]
    vector = DelayVectorEnv(SyncVectorEnv([Odd] * 3), STEP_S, link="vpn", pending=2)
    told, _ = vector.reset(seed=1)
    for _ in range(30):
        assert told in vector.observation_space
        told, *_ = vector.step(vector.action_space.sample())


def test_a_vector_needs_a_mode_and_no_substeps():
    with pytest.raises(ValueError, match="substeps: wrap each environment in DelayEnv"):
        DelayVectorEnv(SyncVectorEnv([Counter] * 2), STEP_S, substeps=2)
    env = SyncVectorEnv([Counter] * 2)
    del env.metadata["autoreset_mode"]
    with pytest.raises(ValueError, match="env: expected metadata.'autoreset_mode'."):
        DelayVectorEnv(env, STEP_S)


# Other arrays.


@pytest.mark.parametrize("kind", ["torch", "jax"])
@pytest.mark.parametrize(
    "settings", [{}, {"arrival": "share", "pending": 2}, {"moves_in_flight": 2}, {"first": "zeros"}, {"predict": True}]
)
def test_arrays_of_other_kinds_stay_so_and_are_as_numpys(kind, settings):
    xp = pytest.importorskip("jax.numpy" if kind == "jax" else "torch")
    own = (lambda one: xp.asarray(one)) if kind == "jax" else (lambda one: xp.as_tensor(one))

    class Drift(VectorEnv):
        metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP}
        single_observation_space = gym.spaces.Box(-9, 9, (2,), np.float32)
        single_action_space = gym.spaces.Box(-1, 1, (2,), np.float32)
        num_envs = 300

        def __init__(self, own):
            self.observation_space = gym.vector.utils.batch_space(self.single_observation_space, 300)
            self.action_space = gym.vector.utils.batch_space(self.single_action_space, 300)
            self.own = own

        def reset(self, *, seed=None, options=None):
            self.steps, self.state = 0, self.own(np.zeros((300, 2), np.float32))
            return self.state, {}

        def step(self, actions):
            self.steps += 1
            self.state = self.state * 0.5 + actions * 0.25
            ends = self.own((np.arange(300) + self.steps) % 20 == 0)
            return self.state, self.state[:, 0], ends, ends & False, {}

    if settings.get("predict"):
        settings = {"predict": lambda observation, action: observation * 0.5 + action * 0.25}
    theirs = DelayVectorEnv(Drift(own), STEP_S, link="vpn", **settings)
    numpys = DelayVectorEnv(Drift(np.asarray), STEP_S, link="vpn", **settings)
    one, other = theirs.reset(seed=1)[0], numpys.reset(seed=1)[0]
    for step in range(30):
        assert type(one) is type(own(np.zeros(1)))
        assert np.allclose(np.asarray(one), other, atol=1e-6)
        actions = np.random.default_rng(step).uniform(-1, 1, (300, 2)).astype(np.float32)
        one, other = theirs.step(own(actions))[0], numpys.step(actions)[0]


# The guide.


def test_the_guides_code_runs():
    guide = Path(__file__).parents[3] / "docs/guides/delay.md"
    if not guide.exists():
        pytest.skip("not in a checkout")
    names = {}
    for code in re.findall(r"```python\n(.*?)```", guide.read_text(), re.DOTALL):
        exec(code, names)
    envs = names["envs"]
    assert names["env"].observation_space.shape == (4,) and names["seen"].shape == (64, 13)

    class Batch:
        num_envs, step = 64, staticmethod(lambda actions: envs.env.step(actions)[:3])

    names["rollout"](Batch, lambda observation, age_s: (age_s > 0.05).astype(np.int64), envs.env.reset(seed=1)[0], 50)


# PettingZoo and Stable-Baselines3.


def parallel(length=30):
    pettingzoo = pytest.importorskip("pettingzoo")

    class Pair(pettingzoo.ParallelEnv):
        """Two agents, of which the second leaves earlier."""

        metadata = {"name": "pair"}
        possible_agents = ["one", "two"]
        render_mode = None

        def observation_space(self, agent):
            return self.spaces[agent][0]

        def action_space(self, agent):
            return self.spaces[agent][1]

        spaces = {
            "one": (gym.spaces.Box(-100, 100, (2,), np.float32), gym.spaces.Discrete(3)),
            "two": (gym.spaces.Discrete(101), gym.spaces.Box(-1, 1, (2,), np.float32)),
        }

        def reset(self, seed=None, options=None):
            self.agents, self.time = list(self.possible_agents), 0
            return self.seen(), {agent: {} for agent in self.agents}

        def step(self, actions):
            assert set(actions) == set(self.agents)
            self.time += 1
            ends = {agent: self.time >= (length if agent == "one" else length // 2) for agent in self.agents}
            told = self.seen(), dict.fromkeys(self.agents, 1.0), ends, dict.fromkeys(ends, False), {a: {} for a in ends}
            self.agents = [agent for agent in self.agents if not ends[agent]]
            return told

        def seen(self):
            seen = {"one": np.full(2, self.time, np.float32), "two": self.time}
            return {agent: seen[agent] for agent in self.agents}

    return Pair()


def test_pettingzoo_finds_nothing_wrong():
    env = parallel()
    from pettingzoo.test import parallel_api_test

    from skein_uav.delay import DelayParallelEnv

    parallel_api_test(DelayParallelEnv(env, STEP_S, link="vpn", pending=2), num_cycles=200)
    with pytest.raises(ValueError, match="substeps: expected none"):
        DelayParallelEnv(env, STEP_S, every=2)
    env = DelayParallelEnv(parallel(), STEP_S, link="correlated:10s,uniform:0ms..500ms")
    for seed in (4, None, None):
        told, _ = env.reset(seed=seed)
        for step in range(1, 31):
            told, *_ = env.step({agent: env.action_space(agent).sample() for agent in env.agents})
            assert all(one in env.observation_space(agent) for agent, one in told.items())
            age = told["one"][2]
            assert age == pytest.approx((step - told["one"][0]) * STEP_S, abs=1e-6)
            if "two" in told:
                # With one link, both agents have its correlated delay.
                assert told["two"]["age_s"][0] == pytest.approx(age)


def test_stable_baselines3_finds_nothing_wrong():
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    for name in ("CartPole-v1", "Pendulum-v1"):
        checker.check_env(DelayEnv(gym.make(name), STEP_S, link="vpn", pending=2), warn=False)
