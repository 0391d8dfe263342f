import contextlib
import gc
import os
import subprocess
import sys

import numpy as np
import pytest

gym = pytest.importorskip("gymnasium")
pytest.importorskip("jpype")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

import skein_uav as skein  # noqa: E402
import skein_uav.environments  # noqa: E402, F401


def paper(seen):
    """The paper's pursuer."""
    ahead, right = seen[:, 0], seen[:, 1]
    return np.where(right != 0, np.sign(right), ahead < 0).astype(np.float32)[:, None]


@pytest.fixture
def make():
    made = []

    def one(count=4, name="Pursuit", **settings):
        made.append(gym.make_vec(f"skein_uav/{name}-v0", num_envs=count, **settings))
        return made[-1]

    yield one
    for env in made:
        env.close()


@pytest.mark.parametrize("name", ["Pursuit", "Evasion"])
def test_gymnasium_finds_nothing_wrong(name):
    check_env(gym.make(f"skein_uav/{name}-v0", render_mode="rgb_array").unwrapped, skip_render_check=False)


def test_the_papers_pursuer_comes_to_the_papers_distance(make):
    env = make(64)
    seen, _ = env.reset(seed=0)
    total = np.zeros(64)
    for _ in range(1000):
        seen, rewards, terminated, truncated, infos = env.step(paper(seen))
        total += rewards
        assert not terminated.any()
        if truncated.all():
            break
    mean = -total / 600 * 10
    assert truncated.all() and env.observation_space.contains(seen)
    # ./skein search over vpn: 10.69 m over the last 10 s; during the chase before, the distance falls from 21 m to 4 m.
    assert np.all((mean > 9) & (mean < 14)), mean


def test_seeds_repeat_episodes_and_others_differ(make):
    def flown(seed):
        env = make(8, start_within_m=(5, 30))
        seen = [env.reset(seed=seed)[0]]
        for step in range(30):
            seen.append(env.step(np.full((8, 1), np.sin(step), np.float32))[0])
        return np.stack(seen)

    assert np.array_equal(flown(5), flown(5))
    assert np.array_equal(flown([5, 6, 7, 8, 9, 10, 11, 12]), flown(5))
    assert not np.array_equal(flown(5), flown(6))


def test_seeds_of_any_size_repeat_episodes(make):
    large = np.random.SeedSequence().entropy  # of 128 bits
    env = make(2, start_within_m=(5, 30))
    for seed in (2**63, np.uint64(2**64 - 1), large, [large, 2**63 - 1]):
        first = env.reset(seed=seed)[0]
        assert np.array_equal(first, env.reset(seed=seed)[0])
        assert not np.array_equal(first, env.reset(seed=7)[0])
    one = gym.make("skein_uav/Pursuit-v0", episode_s=2.0)
    assert np.array_equal(one.reset(seed=large)[0], one.reset(seed=large)[0])
    with pytest.raises(ValueError, match="seed: expected a whole number from 0, got -1"):
        env.reset(seed=[-1, 2])


def test_a_seed_that_is_none_is_drawn_before_the_first_episode(make):
    def places(*seeds):
        return make(2, start_within_m=(5, 30)).reset(seed=list(seeds))[0][:, :2]

    drawn = places(None, 5)
    assert np.array_equal(drawn[1], places(0, 5)[1]) and not np.array_equal(drawn[0], places(0, 5)[0])
    assert not np.array_equal(drawn[0], places(None, 5)[0])


def test_ctrl_c_is_pythons_while_java_runs():
    script = """
import os, signal, time
import gymnasium, skein_uav.environments
gymnasium.make("skein_uav/Pursuit-v0").reset(seed=0)
try:
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(600)
except KeyboardInterrupt:
    print("interrupted")
"""
    ended = subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, timeout=300)
    assert (ended.returncode, ended.stdout) == (0, "interrupted\n")


def test_java_is_started_once_by_many_threads():
    import threading

    from skein_uav import jvm

    started = []
    threads = [threading.Thread(target=lambda: started.append(jvm.start())) for _ in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(started) == 16 and all(module.isJVMStarted() for module in started)


def test_python_ends_if_another_thread_started_java():
    script = """
import threading
from skein_uav import jvm
thread = threading.Thread(target=lambda: print(jvm.start().java.lang.Thread.currentThread().isDaemon()))
thread.start()
thread.join()
"""
    ended = subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, timeout=300)
    assert (ended.returncode, ended.stdout) == (0, "True\n")


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_episodes_end_and_begin_as_gymnasium_says(make, mode):
    env = make(16, autoreset_mode=mode, capture_radius_m=5, start_within_m=(7, 9), link="direct", episode_s=10)
    seen, _ = env.reset(seed=1)
    ended = begun = 0
    done = np.zeros(16, bool)
    for _ in range(300):
        if mode is AutoresetMode.DISABLED and done.any():
            with pytest.raises(skein.SkeinError, match="has ended; reset it"):
                env.step(paper(seen))
            seen, _ = env.reset(options={"reset_mask": done})
        before = done
        seen, rewards, terminated, truncated, infos = env.step(paper(seen))
        done = terminated | truncated
        ended += terminated.sum()
        if mode is AutoresetMode.NEXT_STEP and before.any():
            distance = np.hypot(seen[before, 0], seen[before, 1])
            assert np.all((distance > 6.5) & (distance < 9.5)) and np.all(rewards[before] == 0)
            begun += before.sum()
        if mode is AutoresetMode.SAME_STEP and done.any():
            assert infos["final_obs"][np.flatnonzero(done)[0]].shape == (9,)
            assert np.array_equal(infos["_final_obs"], done) and np.array_equal(infos["_final_info"], done)
    assert ended > 10 and (begun > 10 or mode is not AutoresetMode.NEXT_STEP)


def test_an_evader_that_runs_away_is_not_caught(make):
    env = make(2, "Evasion", link="direct", episode_s=20)
    seen, _ = env.reset(seed=0)
    for _ in range(150):
        bearing = np.arctan2(-seen[:, 1], -seen[:, 0]) / np.pi
        seen, rewards, *_ = env.step(bearing[:, None].astype(np.float32))
    assert np.all(rewards > 0)


def test_observations_are_as_old_as_the_link(make):
    env = make(2, link="constant:200ms", copy=False)
    seen, _ = env.reset(seed=0)
    for _ in range(20):
        seen, *_ = env.step(paper(seen))
    assert np.allclose(seen[:, 7], 0.1, atol=0.01)


def test_bad_actions_are_refused_and_change_nothing(make):
    env = make(2)
    seen, _ = env.reset(seed=0)
    for bad, told in [
        (np.full((2, 1), np.nan), "action of environment 0: expected a number"),
        (np.array([[0.0], [np.inf]]), "action of environment 1: expected a number"),
        (np.zeros(2), r"expected numbers of shape \(2, 1\), got float64 of shape \(2,\)"),
        (np.array([["left"], ["right"]]), "expected numbers of shape"),
        (None, "expected numbers of shape"),
    ]:
        with pytest.raises(ValueError, match=told):
            env.step(bad)
    after = env.step(paper(seen))[0]
    env.reset(seed=0)
    assert np.array_equal(env.step(paper(seen))[0], after)


def test_wrong_settings_and_a_closed_environment_are_told(make):
    for settings, told in [
        ({"link": "nowhere"}, "link: "),
        ({"loop": "plan"}, "loop: expected paused, .* which plans"),
        ({"learner": "nobody"}, "learners: expected one of evader, pursuer"),
        ({"learner": "all"}, "learner: expected one in a world, got Evader, Pursuer"),
        ({"opponent": "nobody"}, "opponent: "),
        ({"capture_radius_m": -1}, "capture_radius_m: expected"),
        ({"render_mode": "human"}, "render_mode: expected"),
        ({"backend": "cloud"}, "backend: expected"),
        ({"moves_in_flight": 2.9}, "moves_in_flight: expected a whole number, got 2.9"),
        ({"scenario": "surround", "settings": {"ring": 6}}, "no setting 'ring'"),
    ]:
        with pytest.raises(ValueError, match=told):
            make(2, **settings)
    with pytest.raises(TypeError, match=r"start_within_m: expected the least and the greatest distance, .* got 5"):
        make(2, start_within_m=5)
    with pytest.raises(TypeError, match="scenario: expected a name, such as 'surround', got Scenario"):
        make(2, scenario=skein.Scenario())
    env = make(2)
    with pytest.raises(skein.SkeinError, match=r"expected reset\(\) before"):
        env.step(np.zeros((2, 1)))
    env.close()
    with pytest.raises(skein.SkeinError, match="closed"):
        env.reset()


def test_pictures_show_both(make):
    env = make(2, render_mode="rgb_array")
    env.reset(seed=0)
    pictures = env.render()
    assert len(pictures) == 2 and pictures[0].shape == (200, 200, 3)
    colours = {tuple(colour) for colour in pictures[0].reshape(-1, 3)}
    assert {(31, 119, 180), (214, 39, 40)} < colours


def test_a_forked_process_is_told_that_java_does_not_live_on_there(make):
    env = make(2)
    env.reset(seed=0)
    reading, writing = os.pipe()
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that this process has threads is the point; JAX warns of it, too
        child = os.fork()
    if child == 0:
        try:
            env.step(np.zeros((2, 1)))
            os.write(writing, b"stepped")
        except skein.SkeinError as mistake:
            collecting = [one for one in gc.callbacks if getattr(one, "__module__", None) == "_jpype"]
            os.write(writing, f"{mistake}; {len(collecting)} collect Java's objects".encode())
        finally:
            os._exit(0)
    os.waitpid(child, 0)
    told = os.read(reading, 1000)
    assert b"before this process was forked" in told and b"; 0 collect" in told


def test_pettingzoo_finds_nothing_wrong():
    pytest.importorskip("pettingzoo")
    from pettingzoo.test import parallel_api_test, parallel_seed_test

    from skein_uav.parallel import TeamParallelEnv

    parallel_api_test(TeamParallelEnv(start_within_m=(5, 30), episode_s=5), num_cycles=200)
    parallel_seed_test(lambda: TeamParallelEnv(start_within_m=(5, 30)), num_cycles=50)


@pytest.mark.parametrize("backend", ["process", "socket"])
def test_several_of_a_team_learn_in_one_world(backend):
    pytest.importorskip("pettingzoo")
    from pettingzoo.test import parallel_api_test

    from skein_uav.parallel import TeamParallelEnv

    team = {"scenario": "surround", "settings": {"vehicles": 4}, "backend": backend, "episode_s": 3}
    with contextlib.closing(TeamParallelEnv(learners="pursuers", objective="off-ring", **team)) as env:
        assert env.engine.startswith("SIMD, ")
        assert env.possible_agents == ["pursuer1", "pursuer2", "pursuer3"]
        parallel_api_test(env, num_cycles=200)
        env.reset(seed=1)
        _, rewards, *_ = env.step(dict.fromkeys(env.agents, np.zeros(1, np.float32)))
        assert len(set(rewards.values())) == 1
    team["settings"] |= {"ring_m": 6}
    with contextlib.closing(TeamParallelEnv(learners="Pursuer2,Evader", **team)) as env:
        assert env.possible_agents == ["evader", "pursuer2"]
        infos = env.reset(seed=1)[1]
        assert infos["evader"]["distance_m"] > 20


def test_names_that_differ_in_case_alone_stay_apart(monkeypatch):
    pytest.importorskip("pettingzoo")
    from types import SimpleNamespace

    from skein_uav import parallel

    def agents(*names):
        batch = SimpleNamespace(learners=list(names), block=None, engine=lambda: "")
        monkeypatch.setattr(parallel, "open_batch", lambda *_: batch)
        return parallel.TeamParallelEnv().possible_agents

    assert agents("Red", "red", "Blue") == ["Red", "red", "Blue"]
    assert agents("Red", "Blue") == ["red", "blue"]


def test_the_spaces_of_both_sides_are_told_by_name_too():
    pytest.importorskip("pettingzoo")
    from skein_uav.parallel import TeamParallelEnv

    with contextlib.closing(TeamParallelEnv()) as env:
        for agent in env.possible_agents:
            assert env.observation_spaces[agent] is env.observation_space(agent)
            assert env.action_spaces[agent] is env.action_space(agent)


def test_both_sides_rewards_add_up_to_nothing():
    pytest.importorskip("pettingzoo")
    from skein_uav.parallel import TeamParallelEnv

    env = TeamParallelEnv(episode_s=5)
    env.reset(seed=1)
    with pytest.raises(ValueError, match="expected one of evader"):
        env.step({})
    steps = 0
    while env.agents:
        _, rewards, _, truncated, infos = env.step(dict.fromkeys(env.agents, np.zeros(1, np.float32)))
        assert rewards["evader"] == -rewards["pursuer"]
        steps += 1
    assert truncated["pursuer"] and 50 <= steps <= 100 and infos["pursuer"]["time_s"] > 4.9
    env.close()


def _walk(env):
    seen = [env.reset(seed=3)[0]]
    for step in range(20):
        seen.append(env.step(np.full((3, 1), np.cos(step), np.float32))[0])
    return np.stack(seen)


def test_a_server_ends_though_a_forked_process_still_lives():
    from skein_uav.served import Server

    server = Server()
    # It keeps the server's input open, as a fork of this process does.
    living = subprocess.Popen(["sleep", "600"], pass_fds=[server._process.stdin.fileno()])
    try:
        server.close()
        assert not server.path.exists()
    finally:
        living.kill()
        living.wait()


def test_behind_a_socket_it_is_the_same_in_forked_processes_too(make):
    from skein_uav.served import Server

    with contextlib.closing(make(3, backend="socket")) as env:
        assert env.engine.startswith("SIMD, ")

    expected = _walk(make(3))
    with Server() as server:
        backend = f"unix:{server.path}"
        assert np.array_equal(_walk(make(3, backend=backend)), expected)
        with pytest.raises(ValueError, match="link: "):
            make(3, backend=backend, link="nowhere")
        env = make(3, backend=backend)
        env.reset(seed=0)
        with pytest.raises(ValueError, match="action of environment 0"):
            env.step(np.full((3, 1), np.nan))
        reading, writing = os.pipe()
        import warnings

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            child = os.fork()
        if child == 0:
            try:
                own = gym.make_vec("skein_uav/Pursuit-v0", num_envs=3, backend=backend)
                os.write(writing, b"same" if np.array_equal(_walk(own), expected) else b"other")
            except BaseException as mistake:
                os.write(writing, repr(mistake).encode())
            finally:
                os._exit(0)
        os.waitpid(child, 0)
        assert os.read(reading, 1000) == b"same"
    with pytest.raises(skein.SkeinError, match="server of environments has ended"):
        env.step(np.zeros((3, 1)))
    with pytest.raises(skein.SkeinError, match="expected a server of environments at /nowhere"):
        make(3, backend="unix:/nowhere")


def test_another_scenario_is_learned_in_by_one_of_its_pursuers():
    settings = {"scenario": "surround", "settings": {"vehicles": 4}, "objective": "off-ring", "episode_s": 3.0}
    with contextlib.closing(gym.make_vec("skein_uav/Pursuit-v0", num_envs=3, link="vpn", **settings)) as env:
        assert env.unwrapped.engine.startswith("SIMD, ")
        seen, _ = env.reset(seed=1)
        assert len({tuple(row[:2]) for row in seen}) == 3
        rewards = np.zeros(3)
        for _ in range(20):
            _, now, _, truncated, infos = env.step(np.zeros((3, 1), np.float32))
            rewards += now
        assert (rewards < -1).all() and (infos["distance_m"] > 5).all()
    with contextlib.closing(gym.make("skein_uav/Pursuit-v0", scenario="surround", settings={"ring_m": 6})) as env:
        env.reset(seed=1)
    with pytest.raises(ValueError, match="learners: expected one of leader, follower"):
        gym.make_vec("skein_uav/Pursuit-v0", num_envs=1, scenario="formation")
    with contextlib.closing(gym.make("skein_uav/Pursuit-v0", plant="quadrotor", altitude_m=3.0)) as env:
        assert env.unwrapped.engine.startswith("scalar: SIMD simulates no ground")


@pytest.mark.parametrize("backend", ["process", "socket"])
def test_a_learner_climbs_and_sees_how_high_vehicles_are(make, backend):
    env = make(2, climb_mps=2.0, link="none", backend=backend)
    assert env.engine.startswith("SIMD, ")
    assert env.single_observation_space.shape == (13,) and env.single_action_space.shape == (2,)
    seen, infos = env.reset(seed=1)
    assert env.observation_space.contains(seen)
    np.testing.assert_allclose(seen[:, 9:], [[0, 0, 20, 0]] * 2, atol=1e-4)
    for _ in range(60):
        seen, *_, infos = env.step(np.array([[0, 1], [0, -0.5]], np.float32))
    height, relative, altitude, own = seen[:, 9:].T
    np.testing.assert_allclose(own, [2, -1], atol=0.1)
    np.testing.assert_allclose(altitude + height, 20, atol=0.1)
    np.testing.assert_allclose(relative, -own, atol=0.4)
    assert altitude[0] > altitude[1] + 12
    np.testing.assert_allclose(infos["distance_m"], np.hypot(np.hypot(seen[:, 0], seen[:, 1]), height), rtol=0.1)
    with pytest.raises(ValueError, match=r"expected numbers of shape \(2, 2\)"):
        env.step(np.zeros((2, 1), np.float32))
    with pytest.raises(ValueError, match="plant: expected tilt or quadrotor, got drag: learners climb"):
        make(1, climb_mps=2.0, plant="drag")


def test_frameworks_find_nothing_wrong_with_a_learner_that_climbs():
    check_env(gym.make("skein_uav/Evasion-v0", climb_mps=3.0).unwrapped, skip_render_check=True)
    pytest.importorskip("pettingzoo")
    from pettingzoo.test import parallel_api_test

    from skein_uav.parallel import TeamParallelEnv

    with contextlib.closing(TeamParallelEnv("surround", "all", climb_mps=1.0, episode_s=3)) as env:
        parallel_api_test(env, num_cycles=100)
        assert env.action_space(env.possible_agents[0]).shape == (2,)


def test_both_sides_may_turn_by_a_rate():
    def seen(name, action, **settings):
        with contextlib.closing(gym.make(f"skein_uav/{name}-v0", link="none", **settings)) as env:
            env.reset(seed=1)
            return np.array([env.step(np.array([action], np.float32))[0] for _ in range(20)])

    np.testing.assert_array_equal(seen("Pursuit", 0.5, turn_rate_rad_per_s=2.0), seen("Pursuit", 1.0))
    straight = seen("Evasion", 0.0)
    np.testing.assert_allclose(seen("Evasion", 1.0, turn_rate_rad_per_s=0.001), straight, atol=0.05)
    assert np.abs(seen("Evasion", 1.0) - straight).max() > 1

    def turned(**settings):
        from skein_uav.parallel import TeamParallelEnv

        actions = {"evader": np.ones(1, np.float32), "pursuer": np.zeros(1, np.float32)}
        with contextlib.closing(TeamParallelEnv(link="none", **settings)) as env:
            env.reset(seed=1)
            sines = [env.step(actions)[0]["evader"][5] for _ in range(20)]
        return max(sines) - min(sines)

    assert turned(turn_rate_rad_per_s=0.001) < 0.05 < turned(turn_rate_rad_per_s=1.0)
    with pytest.raises(ValueError, match="turn_rate_rad_per_s: expected"):
        gym.make("skein_uav/Pursuit-v0", turn_rate_rad_per_s=100.0)


def test_stable_baselines3_gets_the_distance_and_the_last_observation_of_an_episode():
    pytest.importorskip("stable_baselines3")
    from skein_uav.stable_baselines3 import PursuitVecEnv

    environments = PursuitVecEnv(3, episode_s=1.0)
    environments.seed(1)
    environments.reset()
    while True:
        environments.step_async(np.zeros((3, *environments.action_space.shape), np.float32))
        _, _, done, infos = environments.step_wait()
        assert all(info["distance_m"] > 0 and info["time_s"] > 0 for info in infos)
        if done.any():
            break
    assert done.all() and all(info["TimeLimit.truncated"] for info in infos)
    assert all(info["terminal_observation"].shape == environments.observation_space.shape for info in infos)
    environments.close()
