"""Numbers that are known in flight alone compute what floats compute. None of these tests needs Java."""

import copy
import dataclasses
import math
import random
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import pytest
from test_scenario import inputs_of, interpreted, scenario

from skein_uav import formula as f
from skein_uav.scenario import Known, Observation


def computed(function, *arguments):
    """What a function's trace computes from arguments."""
    made = scenario(lambda seen: seen.along(function(*(one.north_m for one in seen.vehicles)), 0.0), others=1)
    text = made.text()
    does = next(line for line in text.splitlines() if line.startswith("does"))
    evaluate, inputs = interpreted(text), lambda given: inputs_of(Observation(0, [Known(*one) for one in given]), None)
    return [evaluate(inputs([(x,), (y,)]))[int(does.split()[2])] for x, y in zip(*arguments, strict=True)]


def drawn():
    random_ = random.Random(7)
    rounded = [round(random_.uniform(-9, 9), digits) or 0.5 for digits in (0, 1, 2) for _ in range(400)]
    wide = [random_.choice((-1, 1)) * 10 ** random_.uniform(-9, 9) for _ in range(400)]
    return [1.0, 1.0, 3.0, -1.0, *rounded, *wide], [0.1, -0.1, 0.2, 1.0, *reversed(rounded), *wide[200:], *wide[:200]]


@pytest.mark.parametrize(
    "function",
    [
        *(lambda x, y: x % y, lambda x, y: x // y, lambda x, y: divmod(x, y)[0] + divmod(x, y)[1]),
        *(lambda x, y: x % 0.1, lambda x, y: x // -0.3, lambda x, y: 7.1 % y, lambda x, y: -7.1 // y),
        *(lambda x, y: f.hypot(x, y, 3.0), lambda x, y: f.hypot(x, y, x, y)),
        *(lambda x, y: np.clip(x, a_min=y, a_max=None), lambda x, y: np.clip(x, -1, 1)),
        *(lambda x, y: np.mod(x, y), lambda x, y: np.floor_divide(x, y), lambda x, y: np.float64(0.7) % y),
    ],
)
def test_moduli_whole_quotients_lengths_and_limits_are_those_of_floats(function):
    xs, ys = drawn()
    assert computed(function, xs, ys) == [function(x, y) for x, y in zip(xs, ys, strict=True)]


def test_a_modulo_of_nothing_has_the_sign_of_floats():
    (zero,) = computed(lambda x, y: x % y, [-1.0], [1.0])
    assert math.copysign(1, zero) == math.copysign(1, -1.0 % 1.0) == 1


def test_an_index_is_rounded_and_limited_alike_in_both_forms():
    def picked(x, y):
        return f.pick(x, [10.0, y, 30.0])

    places = [-7.0, -1, -0.0, 0, 0.49999999999999994, 0.5, 0.7, 1, 1.5, 2, 2.5, 5, math.inf]
    values = [picked(x, 20.0) for x in places]
    assert computed(picked, places, [20.0] * len(places)) == values
    assert values == [10, 10, 10, 10, 10, 20, 20, 20, 30, 30, 30, 30, 30]
    assert f.pick(5, "abc") == "c" and f.pick(-1, "abc") == "a" and f.pick(np.int64(1), ("a",)) == "a"


class Held(NamedTuple):
    rad: float
    is_left: bool = True


def test_a_memory_may_be_a_named_tuple():
    def policy(seen, memory):
        other = f.where(memory.is_left, Held(memory.rad + seen.elapsed_s, False), Held(0.0))
        return seen.along(memory.rad, 1.0), other

    text = scenario(policy, Held(0.5)).text()
    seen = Observation(0, [Known(), Known()], elapsed_s=0.25)
    remembers = [line.split()[1:] for line in text.splitlines() if line.startswith("remembers")]
    for held in (Held(0.5), Held(2.0, False)):
        values = interpreted(text)(inputs_of(seen, None, [held.rad, float(held.is_left)]))
        after = policy(seen, held)[1]
        assert [values[int(next_)] for _, next_ in remembers] == [after.rad, float(after.is_left)]
    assert [interpreted(text)({**inputs_of(seen, None, [0, 0])})[int(first)] for first, _ in remembers] == [0.5, 1.0]


@pytest.mark.parametrize(
    "function",
    [
        *(lambda x, y: np.float64(2) < x, lambda x, y: np.float64(2) >= x, lambda x, y: np.int64(2) == x),
        *(lambda x, y: np.float32(2) != x, lambda x, y: np.array(2.0) > x, lambda x, y: x <= np.float64(2)),
    ],
)
def test_numpys_numbers_are_compared_from_both_sides(function):
    xs = [1.0, 2.0, 3.0]
    chosen = computed(lambda x, y: f.where(function(x, y), 1.0, y), xs, [0.0] * 3)
    assert chosen == [float(function(x, 0.0)) for x in xs]


@dataclass(frozen=True)
class Clock:
    rad: float = 0.0
    turns: float = field(default=0.0, init=False)


def test_a_memory_may_be_copied_and_have_fields_of_its_own():
    def policy(seen, memory):
        copied = copy.deepcopy(memory)
        object.__setattr__(copied, "turns", copied.turns + dataclasses.asdict(memory)["rad"])
        return seen.along(memory.rad, 1.0), f.where(memory.rad > 1, copied, memory)

    text = scenario(policy, Clock()).text()
    remembers = [line.split()[2] for line in text.splitlines() if line.startswith("remembers")]
    for rad, turns in ((0.5, 3.0), (2.0, 5.0)):
        values = interpreted(text)(inputs_of(Observation(0, [Known(), Known()]), None, [rad, 3.0]))
        assert [values[int(one)] for one in remembers] == [rad, turns]


def test_one_of_two_arrays_is_chosen():
    def chosen(x, y):
        return f.where(x > 1, np.array([x, 2.0]), y).sum() + f.where(x > 1, np.eye(2), np.zeros((2, 2)))[1, 1]

    assert computed(chosen, [0.0, 3.0], [4.0, 4.0]) == [8.0, 6.0]


def test_a_power_is_a_whole_number_of_numpys_too():
    assert computed(lambda x, y: x ** np.int64(2) + y, [3.0], [1.0]) == [10.0]
