import time
from pathlib import Path

import numpy as np
import pytest

import skein_uav as skein


def paper(seen):
    """The paper's pursuer."""
    return np.sign(seen[1]) if seen[1] != 0 else float(seen[0] < 0)


def test_a_policy_in_python_flies_as_the_same_policy_on_the_jvm(tmp_path):
    flights = [
        skein.fly(link="vpn", duration_s=15, out=tmp_path / "own"),
        skein.fly(link="vpn", duration_s=15, pursuer=paper, out=tmp_path / "python"),
    ]
    assert [len(one.recordings) for one in flights] == [1, 1]
    own, python = (next(iter(one.tables.values()))["last 10 s m"].iloc[0] for one in flights)
    # The request's floats are 32 bits wide, so a side differs only if the evader is almost straight ahead.
    assert python == pytest.approx(own, abs=0.05)


def test_each_policy_flies_alone_and_no_flight_that_nobody_asked_for(tmp_path):
    both = skein.fly(link="none", duration_s=3, pursuer=paper, evader=lambda seen: 0.0, out=tmp_path)
    assert len(both.recordings) == 2 and all("outside" in path.name for path in both.recordings)
    assert len(repr(both)) < 1000 and "recordings: " in repr(both)


def test_a_policy_flies_with_the_turn_rate_that_it_was_trained_with(tmp_path):
    for role, rate in (("pursuer", 2.5), ("evader", 0.5)):
        flights = skein.fly(link="none", duration_s=3, turn_rate_rad_per_s=rate, out=tmp_path / role, **{role: lambda _: 1.0})
        with flights.load() as recording:
            made = recording["decision"].query(f"vehicle == '{role.title()}'")
        turned = (made.headingRad - made.headingBeforeRad + np.pi) % (2 * np.pi) - np.pi
        assert len(made) > 20 and np.allclose(turned, rate * made.elapsedMs / 1000, atol=1e-6)
    with pytest.raises(TypeError, match="turn_rate_rad_per_s: expected with a pursuer or an evader"):
        skein.fly(turn_rate_rad_per_s=2.0)


def test_a_policy_that_fails_ends_the_flight_with_its_words(tmp_path):
    def broken(seen):
        raise ZeroDivisionError("no such luck")

    with pytest.raises(skein.SkeinError, match="ZeroDivisionError: no such luck"):
        skein.fly(link="none", duration_s=5, pursuer=broken, out=tmp_path)
    with pytest.raises(skein.SkeinError, match="expected a number from -1 to 1, got array.*nan"):
        skein.fly(link="none", duration_s=5, evader=lambda seen: np.nan, out=tmp_path / "nan")


def test_with_a_deadline_a_policy_that_fails_is_replaced_and_recorded(tmp_path):
    def moody(seen):
        if seen[0] < 15:
            raise ValueError("not in the mood")
        return paper(seen)

    flights = skein.fly(
        link="direct", duration_s=8, pursuer=moody, deadline_ms=20, fallback="paper-pursuer", out=tmp_path
    )
    own = next(number for number, path in enumerate(flights.recordings) if "outside" in path.name)
    with flights.load(own) as recording:
        missed = recording["event"]
        assert missed.detail.str.contains("not in the mood").any(), missed
        assert (recording["decision"].vehicle == "Pursuer").sum() > 60


@pytest.mark.parametrize("pause_s", [0.5, 3600])
def test_a_policy_that_is_slow_or_hangs_holds_no_flight_in_real_time_up(tmp_path, pause_s):
    def slow(seen):
        time.sleep(pause_s)
        return paper(seen)

    flights = skein.fly(link="none", duration_s=3, clock="real", twins=0, pursuer=slow, fallback="repeat", out=tmp_path)
    own = next(number for number, path in enumerate(flights.recordings) if "outside" in path.name)
    with flights.load(own) as recording:
        assert (recording["decision"].vehicle == "Pursuer").sum() >= 10
        assert recording["event"].detail.str.contains("by the fallback").sum() >= 10


def test_a_network_goes_to_onnx_and_flies_from_there_as_it_did(tmp_path: Path):
    conf = tmp_path / "policy.conf"
    conf.write_text(
        'family = "learned:"\nrole = pursuer\nparameters {\n'
        + "".join(f"  weight-1-1-{n} = {0.125 * n}\n" for n in range(1, 10))
        + "  bias-1-1 = 0.25\n  turnRateRadPerS = 1\n  turnRad = 0\n}\n"
    )
    onnx = skein.to_onnx(conf, tmp_path / "policy.onnx")
    flown = [
        skein.fly(link="vpn", duration_s=5, policy=policy, out=tmp_path / name)
        for name, policy in (("conf", conf), ("onnx", onnx))
    ]
    one, other = (next(iter(flights.tables.values())).iloc[0].tolist() for flights in flown)
    assert one == other
