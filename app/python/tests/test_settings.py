"""Settings of scenarios whose classes compute from them. None of these tests needs Java."""

import functools
import random
import re
from dataclasses import InitVar, dataclass, field, replace

import pytest
from test_scenario import inputs_of, interpreted

from skein_uav.formula import Untraceable
from skein_uav.scenario import Known, Observation, Scenario, Vehicle, hover, setting


def listed(made):
    """Settings of a file and their defaults."""
    return {name: float(value) for name, value in re.findall(r"^setting (\S+) (\S+)", made.text(), re.MULTILINE)}


def speed(made, **settings):
    """The speed at which the first vehicle flies, by the scenario's file with other settings."""
    text = made.text()
    values = listed(made) | {name.replace("_", "-"): value for name, value in settings.items()}
    inputs = inputs_of(Observation(0, [Known()]), None) | {f"setting {name}": one for name, one in values.items()}
    does = next(line for line in text.splitlines() if line.startswith("does along"))
    return interpreted(text)(inputs)[int(does.split()[3])]


class Straight(Scenario):
    """Flies at `mps`."""

    def vehicles(self):
        yield Vehicle("A", self.fly, speed_mps=self.pace_mps)

    def fly(self, seen):
        return seen.along(0.0, self.mps)


@dataclass
class Halved(Straight):
    pace_mps: float = setting(6.0, "speed, m/s")
    names: list = field(default_factory=list)

    def __post_init__(self):
        self.mps = self.pace_mps / 2
        self.names.append("one")


@dataclass
class Optional(Straight):
    pace_mps: float = 6.0
    mps: float | None = None

    def __post_init__(self):
        if self.mps is None:
            self.mps = self.pace_mps / 2


@dataclass
class Doubled(Straight):
    pace_mps: float = 6.0
    mps: float = field(default=0.0, init=False)
    share: InitVar[float] = 0.5

    def __post_init__(self, share):
        self.pace_mps *= 2
        self.mps = self.pace_mps * share


@dataclass(frozen=True)
class Frozen(Straight):
    pace_mps: float = 6.0

    def __post_init__(self):
        object.__setattr__(self, "mps", self.pace_mps / 2)


@dataclass
class Written(Straight):
    pace_mps: float = 6.0

    def __init__(self, pace_mps=6.0):
        self.pace_mps, self.mps = pace_mps, pace_mps / 2


@dataclass
class Cached(Straight):
    pace_mps: float = 6.0

    @functools.cached_property
    def mps(self):
        return self.pace_mps / 2


@dataclass
class Listed(Straight):
    pace_mps: float = 6.0

    def __post_init__(self):
        self.mps = self.pace_mps / 2
        self.team = [Vehicle("A", self.fly)]

    def vehicles(self):
        return self.team


@pytest.mark.parametrize("kind", [Halved, Optional, Doubled, Frozen, Written, Cached, Listed])
def test_a_setting_changes_what_a_scenario_computes_from_it(kind):
    for made in (kind(), kind(8.0), kind(pace_mps=9.0)):
        assert made.mps == speed(made) == kind(listed(made)["pace-mps"]).mps
        assert speed(made, pace_mps=4.0) == kind(pace_mps=4.0).mps
        assert list(listed(made)) == ["pace-mps"]


def test_a_scenario_that_computes_is_not_changed_and_is_written_alike():
    made = Halved(names=["zero"])
    before = made.text()
    assert made.text() == before and made.names == ["zero", "one"] and made.mps == 3.0


def test_a_field_that_is_changed_afterwards_or_given_is_a_setting_of_that_value():
    made = Halved()
    made.pace_mps = 7.0
    assert speed(made) == 3.5 and listed(replace(made, pace_mps=5.0)) == {"pace-mps": 5.0}
    assert listed(Optional(mps=2.0)) == {"pace-mps": 6.0, "mps": 2.0} and speed(Optional(mps=2.0), mps=1.0) == 1.0
    assert speed(Doubled(share=0.25)) == 3.0


def test_what_does_not_depend_on_settings_stays():
    @dataclass
    class Drawn(Straight):
        pace_mps: float = 6.0
        count: int = 1

        def __post_init__(self):
            self.count += 1
            self.mps = self.pace_mps * random.random() * self.count
            self.share = random.random()

        def fly(self, seen):
            assert self.count == 2
            return seen.along(0.0, self.share)

    made = Drawn()
    assert speed(made) == speed(made) == made.share


def test_checks_of_settings_stay_out_of_flights():
    @dataclass
    class Checked(Straight):
        pace_mps: float = 6.0
        names: list = field(default_factory=list)

        def __post_init__(self):
            if self.pace_mps <= 0:
                raise ValueError("pace_mps: expected more than 0")

        @property
        def mps(self):
            return self.pace_mps / 2

    assert speed(Checked(names=["A"]), pace_mps=8.0) == 4.0
    with pytest.raises(ValueError, match="more than 0"):
        Checked(-1.0)


def test_what_cannot_be_computed_from_symbols_is_refused_with_its_line():
    @dataclass
    class Stepped(Straight):
        pace_mps: float = 6.0

        def __post_init__(self):
            self.mps = 1.0 if self.pace_mps < 5 else 2.0

    told = r"test_settings.py:\d+: self.mps = 1.0 if .* write where\(.*__post_init__ is traced, as it computes mps; with"
    with pytest.raises(Untraceable, match=f"(?s){told}"):
        Stepped().text()


def test_a_field_that_is_no_parameter_is_no_setting():
    @dataclass
    class Fixed(Scenario):
        pace_mps: float = field(default=2.0, init=False)

        def vehicles(self):
            yield Vehicle("A", lambda seen: hover(), speed_mps=self.pace_mps)

    assert listed(Fixed()) == {}


@dataclass
class Clamped(Straight):
    pace_mps: float = 6.0

    def __post_init__(self):
        if self.pace_mps > 8:
            self.pace_mps = 8.0


@dataclass
class Least(Straight):
    pace_mps: float = 6.0

    def __post_init__(self):
        self.pace_mps = min(self.pace_mps, 8.0)


@dataclass
class Helped(Straight):
    pace_mps: float = 6.0

    def __post_init__(self):
        self.clamp()

    def clamp(self):
        if self.pace_mps > 8:
            object.__setattr__(self, "pace_mps", 8.0)


@pytest.mark.parametrize("kind", [Clamped, Least, Helped])
def test_a_clamp_of_a_setting_that_would_be_lost_is_refused_with_its_line(kind):
    with pytest.raises(Untraceable, match=r"(?s)test_settings.py:\d+: .*pace_mps.* 8.*write .*__post_init__ is traced"):
        kind().text()
