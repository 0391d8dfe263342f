import numpy as np
import pytest

import skein_uav as skein

pytest.importorskip("gymnasium")


def paper(seen):
    """The paper's pursuer: turns as sharply as it can to the side at which the evader was seen."""
    return np.where(seen[..., 1] != 0, np.sign(seen[..., 1]), seen[..., 0] < 0)


def lead(seen, candidates):
    ahead = seen[..., 0] + candidates[:, 0] * seen[..., 2]
    right = seen[..., 1] + candidates[:, 0] * seen[..., 3]
    return np.clip(np.arctan2(right, ahead) / np.maximum(seen[..., 6], 0.05), -1, 1)


def test_the_papers_pursuer_in_numpy_scores_as_in_the_search():
    found = skein.evaluate(paper, link="none", draws=2)
    assert found["mean m"][0] == pytest.approx(8.10744, abs=1e-4)  # as `./skein search --link none` says
    assert found["episodes"][0] == 256 and found.attrs["decisions"] >= 256 * 590
    assert "SIMD" in found.attrs["engine"]


def test_a_policy_that_climbs_returns_two_numbers():
    def climb(up):
        return lambda seen: np.stack([paper(seen), np.full(seen.shape[:-1], up)], -1)

    given = dict(link="none", draws=2, episode_s=15.0, climb_mps=2.0)
    level, high = (skein.evaluate(climb(up), **given)["mean m"][0] for up in (0.0, 1.0))
    assert high > level + 5
    with pytest.raises(ValueError, match=r"policy: expected numbers of shape \(256, 2\)"):
        skein.evaluate(paper, **given)


def test_equal_seeds_score_equally_and_other_seeds_do_not():
    given = dict(link="vpn", draws=2, episode_s=15.0, start_within_m=(5, 30))
    one, again, other = (skein.evaluate(paper, seed=seed, **given)["mean m"][0] for seed in (1, 1, 50))
    assert one == again != other


def test_candidates_meet_the_same_draws_and_starts():
    rows = np.array([[0.5], [0.0], [0.5]])
    found = skein.evaluate(lead, rows, link="vpn", draws=2, episode_s=15.0, start_within_m=(5, 30))
    assert found["mean m"][0] == found["mean m"][2] != found["mean m"][1]
    assert found["episodes"].tolist() == [2 * 42] * 3


def test_more_candidates_than_share_a_group_meet_them_as_well():
    rows = np.full((130, 1), 0.5)
    found = skein.evaluate(lead, rows, link="vpn", draws=2, last_s=2.0, episode_s=5.0, start_within_m=(5, 30))
    assert len(found) == 130 and found["mean m"].nunique() == 1


def test_the_policy_is_called_once_for_all_episodes():
    shapes = set()

    def noted(seen, candidates):
        shapes.add((seen.shape, candidates.shape))
        return lead(seen, candidates)

    skein.evaluate(noted, np.zeros((5, 1)), link="none", draws=3, last_s=1.0, episode_s=2.0)
    assert shapes == {((3 * 25, 5, 9), (5, 1))}


def test_what_a_policy_or_a_caller_gets_wrong_is_told():
    short = dict(link="none", draws=2, episode_s=1.0, last_s=1.0)
    with pytest.raises(ValueError, match=r"policy: expected numbers of shape \(256,\), got .* of shape \(\)"):
        skein.evaluate(lambda seen: 0.0, **short)
    with pytest.raises(ValueError, match="action of environment 0: expected a number"):
        skein.evaluate(lambda seen: np.full(len(seen), np.nan), **short)
    with pytest.raises(ValueError, match=r"candidates: expected shape \(candidates, numbers\), got \(3,\)"):
        skein.evaluate(lead, [1, 2, 3], **short)
    with pytest.raises(ValueError, match="draws: expected at least 2, got 1"):
        skein.evaluate(paper, draws=1)
    with pytest.raises(ValueError, match="last_s: expected more than 0 s and at most 5 s, got 10"):
        skein.evaluate(paper, episode_s=5.0)
    with pytest.raises(TypeError, match="takes no capture_radius_m"):
        skein.evaluate(paper, capture_radius_m=1.0)


@pytest.mark.parametrize("given", [{"objective": "last10s"}, {"scenario": "surround"}, {"autoreset_mode": "NextStep"}])
def test_what_would_score_something_else_is_refused(given):
    (name,) = given
    with pytest.raises(TypeError, match=f"distances in whole episodes of the duel; it takes no {name}"):
        skein.evaluate(paper, link="none", draws=2, episode_s=1.0, last_s=1.0, **given)
