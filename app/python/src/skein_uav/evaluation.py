"""Policies written with arrays, evaluated in many episodes together under a loop's timing."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from .errors import needed
from .places import plainly

#: Environments that share a link, and so one draw of its delays.
_GROUP = 128
#: Different draws that environments know, of which each is one.
_DRAWS = 128
_REWARD_M = 10.0
#: Quantiles of Student's distribution, two-sided 95 %, for 1 to 30 degrees of freedom.
_T95 = (
    *(12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131),
    *(2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042),
)


@plainly
def evaluate(
    policy: Callable[..., Any],
    candidates: ArrayLike | None = None,
    *,
    draws: int = 8,
    last_s: float = 10.0,
    seed: int = 1,
    learner: str = "pursuer",
    period_ms: float = 100.0,
    episode_s: float = 60.0,
    **settings: Any,
) -> pd.DataFrame:
    """Evaluates a policy, or each of many candidates, in many episodes of the duel by forward simulation.

    The policy is called once per step for all episodes together, so it may use NumPy, PyTorch or JAX, at a rate of
    hundreds of thousands of decisions per second. 128 episodes share a draw of the link's delays; all candidates have
    equal draws and equal starts, so that they can be compared.

    Parameters
    ----------
    policy : callable
        ``policy(seen)``, with an observation of `skein_uav.environments` in the last axis, returns a number from -1 to 1
        for each, or with ``climb_mps`` two in the last axis. With candidates ``policy(seen, candidates)``: seen of shape
        (episodes, candidates, 9).
    candidates : array, shape (candidates, parameters), optional
        Parameters of the policy, one row for each candidate.
    draws : int
        Number of draws of the link's delays.
    last_s : float
        The score is the mean distance over this time before the end, s.
    seed : int
        Seed of the first draw; equal seeds give equal results.
    learner, period_ms, episode_s, **settings
        As in `skein_uav.environments.PursuitVectorEnv`: ``link``, ``loop``, ``start_within_m``, ``backend``, …, without
        ``autoreset_mode`` and ``capture_radius_m``, and without ``scenario`` and ``objective``, for which there is
        `search`. From the paper's start, all episodes of one policy and one draw are identical, so set
        ``start_within_m`` there.

    Returns
    -------
    DataFrame
        A row for each candidate: ``mean m``, its 95 % interval ``± 95 %`` over the draws, ``episodes``. Its ``attrs``
        have ``decisions``, ``decisions_per_s`` and ``engine``.

    Raises
    ------
    ValueError
        If the policy returns anything but finite numbers of that shape, or a setting is invalid.
    TypeError
        If a setting would end episodes early or score something else.
    """
    needed("gymnasium", "learn")
    from .environments import PursuitVectorEnv

    refused: list[str] = [name for name in ("capture_radius_m", "autoreset_mode", "objective") if name in settings]
    if (scenario := settings.get("scenario", "duel")) != "duel":
        refused.append(f"scenario {scenario!r}")
    if refused:
        named = " and no ".join(refused)
        raise TypeError(f"evaluate() scores distances in whole episodes of the duel; it takes no {named}")
    if draws < 2:
        raise ValueError(f"draws: expected at least 2, got {draws}")
    if not 0 < last_s <= episode_s:
        raise ValueError(f"last_s: expected more than 0 s and at most {episode_s:g} s, got {last_s:g}")
    rows = None if candidates is None else np.asarray(candidates)
    if rows is not None and (rows.ndim != 2 or not len(rows)):
        raise ValueError(f"candidates: expected shape (candidates, numbers), got {rows.shape}")
    places, seeds = _layout(1 if rows is None else len(rows), draws, seed)
    asked = places[:, 0] if rows is None else places
    with_candidates = () if rows is None else (rows,)
    environments = PursuitVectorEnv(
        len(seeds), learner=learner, period_ms=period_ms, episode_s=episode_s, copy=False, **settings
    )
    try:
        began = time.perf_counter()
        seen, infos = environments.reset(seed=seeds)
        actions = np.zeros(environments.action_space.shape, np.float32)
        climbs = environments.single_action_space.shape != (1,)
        shape = (*asked.shape, actions.shape[1]) if climbs else asked.shape
        flying = np.ones(len(seeds), np.bool_)
        before, total, count = infos["time_s"], np.zeros(len(seeds)), np.zeros(len(seeds))
        steps = 0
        while flying.any():
            chosen = _numbers(policy(np.moveaxis(seen.T[:, asked], 0, -1), *with_candidates), shape)
            actions[asked] = chosen.reshape(*asked.shape, -1)
            seen, rewards, _, truncated, infos = environments.step(actions)
            now = infos["time_s"]
            counts = flying & (now > episode_s - last_s + 1e-3)
            total += np.where(counts, abs(rewards) * _REWARD_M, 0.0)
            count += np.where(counts, np.rint((now - before) * (1000 / period_ms)), 0.0)
            before, flying = now, flying & ~truncated
            steps += 1
        took_s = time.perf_counter() - began
        engine = environments.engine
    finally:
        environments.close()
    scores = (total / count)[places].reshape(draws, -1, places.shape[1]).mean(1)
    frame = pd.DataFrame(
        {
            "mean m": scores.mean(0),
            # Draws may be equal, and the known ones are a sample of the link themselves.
            "± 95 %": _student95(draws - 1) * scores.std(0, ddof=1) * np.sqrt(1 / draws + 1 / _DRAWS),
            "episodes": len(places),
        }
    )
    frame.attrs.update(decisions=steps * asked.size, decisions_per_s=steps * asked.size / took_s, engine=engine)
    return frame


def _student95(degrees: int) -> float:
    """Student's 97.5 % quantile: the table's, above it by Abramowitz and Stegun, 26.7.5."""
    if degrees <= len(_T95):
        return _T95[degrees - 1]
    z = 1.959964
    return z + z * (z**2 + 1) / (4 * degrees) + z * (5 * z**4 + 16 * z**2 + 3) / (96 * degrees**2)


def _layout(candidates: int, draws: int, seed: int) -> tuple[np.ndarray[Any, Any], list[int]]:
    """The environments of each candidate, shape (episodes, candidates), and the environments' seeds.

    A draw is a group of 128 environments, or several with equal seeds if there are more candidates.
    """
    groups = -(-candidates // _GROUP)
    starts = max(_GROUP // candidates, 1)
    worlds = groups * _GROUP
    places = np.arange(draws)[:, None] * worlds + np.arange(starts * candidates)
    start = np.minimum(np.arange(worlds) // candidates, starts - 1)
    seeds = [seed + draw * starts + int(one) for draw in range(draws) for one in start]
    return places.reshape(draws * starts, candidates), seeds


def _numbers(answer: Any, shape: tuple[int, ...]) -> np.ndarray[Any, Any]:
    numbers = np.asarray(answer)
    if numbers.shape != shape or numbers.dtype.kind not in "fiu":
        raise ValueError(f"policy: expected numbers of shape {shape}, got {numbers.dtype} of shape {numbers.shape}")
    return numbers
