"""Scenarios in Python: what is traced, and what cannot be. None of these tests needs Java."""

import functools
import math
import random
import sys
import traceback
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from skein_uav import formula as f
from skein_uav.formula import Untraceable
from skein_uav.scenario import Action, Known, Moment, Observation, Scenario, Series, Vehicle, hover, setting

EXAMPLES = Path(__file__).parents[3] / "examples" / "scenario-in-python"
sys.path.insert(0, str(EXAMPLES))

import network  # noqa: E402
import pursuit  # noqa: E402
import ring  # noqa: E402
import tower  # noqa: E402


def scenario(policy, memory=None, others=1):
    """A scenario of a vehicle with this policy, and of others that hover."""

    class One(Scenario):
        pace_mps = 5.0

        def vehicles(self):
            yield Vehicle("Own", policy, memory=memory)
            for other in range(others):
                yield Vehicle(f"Other{other}", lambda seen: hover(), (20.0 + other, 0.0, -5.0))

    return One()


def interpreted(text):
    """Evaluates the nodes of a file, by inputs such as ``north 0``: an independent reader of the file."""
    lines = [line for line in text.splitlines() if line[0].isdigit()]
    operations = {
        **{"add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "div": lambda a, b: a / b},
        **{"neg": lambda a: -a, "abs": abs, "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "atan2": math.atan2},
        **{"hypot": math.hypot, "min": min, "max": max, "lt": lambda a, b: a < b, "le": lambda a, b: a <= b},
        **{"eq": lambda a, b: a == b, "not": lambda a: not a, "and": lambda a, b: a and b, "or": lambda a, b: a or b},
        **{"where": lambda c, a, b: a if c else b, "always": lambda: True, "remainder": math.remainder},
        **{"signum": lambda a: math.copysign(1, a) if a else a, "floor": math.floor, "rint": round, "tanh": math.tanh, "exp": math.exp},
    }

    def value(line, inputs):
        op, *words = line.split()[1:]
        if op == "const":
            return float(words[0].replace("Infinity", "inf"))
        if op in operations:
            return operations[op](*(inputs[int(word)] for word in words))
        return inputs[" ".join([op, *words])]

    def evaluate(named):
        values = dict(named)
        for place, line in enumerate(lines):
            values[place] = value(line, values)
        return values

    return evaluate


def drawn(random_, count):
    return [Known(*(random_.uniform(-20, 20) for _ in range(7)), random_.uniform(0, 1)) for _ in range(count)]


def inputs_of(seen, scenario_, memory=()):
    named = {"elapsed": seen.elapsed_s, "cruise": seen.cruise_mps, "start-down": seen.start_down_m}
    named["acts-in"], named["ahead"], named["time"] = seen.acts_in_s, 0.5, seen.time_s
    words = ("north", "east", "down", "north-mps", "east-mps", "down-mps", "heading", "age")
    for place, one in enumerate(seen.vehicles):
        fields = (one.north_m, one.east_m, one.down_m, one.north_mps, one.east_mps, one.down_mps)
        for word, field in zip(words, (*fields, one.heading_rad, one.age_s), strict=True):
            named[f"{word} {place}"] = field
    named.update({f"memory {place}": number for place, number in enumerate(memory)})
    for name in getattr(type(scenario_), "__dataclass_fields__", {}):
        named[f"setting {name.replace('_', '-')}"] = getattr(scenario_, name)
    return named


@pytest.mark.parametrize("made", [ring.Ring(), pursuit.Pursuit(), tower.Tower()], ids=lambda one: type(one).__name__)
def test_what_is_written_down_computes_what_the_function_computes(made):
    text = made.text()
    vehicles = list(made.vehicles())
    does = [line.split() for line in text.splitlines() if line.startswith("does")]
    remembers = [line.split() for line in text.splitlines() if line.startswith("remembers")]
    evaluate, random_ = interpreted(text), random.Random(3)
    rows = iter(does)
    for place, vehicle in enumerate(vehicles):
        cases = []
        while not cases or cases[-1][1] == "when":
            cases.append(next(rows))
        for _ in range(30):
            roles = [one.role for one in vehicles]
            rivals = [one for one, role in enumerate(roles) if role != roles[place]] or None
            seen = Observation(place, drawn(random_, len(vehicles)), 0.1, 0.2, 6.0, -5.0, rivals)
            held = [] if vehicle.memory is None else [random_.uniform(-3, 3), float(random_.random() < 0.5)]
            if vehicle.memory is None:
                action, after = vehicle.policy(seen), None
            else:
                action, after = vehicle.policy(seen, tower.Turns(held[0], bool(held[1])))
            values = evaluate(inputs_of(seen, made, held))
            case = next(one for one in cases if one[1] != "when" or values[int(one[2])])
            words = case[3:] if case[1] == "when" else case[1:]
            assert isinstance(action, Action) and words[0] == action.kind
            assert [values[int(word)] for word in words[1 : 1 + len(action.numbers)]] == list(action.numbers)
            if after is not None:
                numbers = [values[int(words[2])] for words in remembers[2 * place : 2 * place + 2]]
                assert numbers == [after.angle_rad, float(after.is_up)]


@pytest.mark.parametrize("made", [ring.Ring(), pursuit.Pursuit(), network.Network()], ids=lambda one: one.title)
def test_the_files_beside_the_examples_are_what_the_examples_write(made):
    assert (EXAMPLES / f"{made.title}.scenario").read_text(encoding="utf-8") == made.text()


def test_settings_are_fields_that_are_floats_and_others_are_fixed():
    text = ring.Ring(pursuers=3, ring_m=6).text()
    assert 'setting ring-m 6.0 "radius of the ring, m"' in text and "setting pursuers" not in text
    assert len([line for line in text.splitlines() if line.startswith("vehicle")]) == 4


def test_a_policy_runs_with_plain_numbers_as_it_stands():
    seen = Observation(1, [Known(north_m=10.0), Known(heading_rad=0.0)], rivals=[0], elapsed_s=0.1)
    assert pursuit.Pursuit().pursue(seen).numbers == (0.0, 5.0, -5.0)
    assert ring.Ring().gap(Moment([Known(), Known(north_m=1.0), Known(north_m=-1.0)])) == 180
    assert f.where(True, 1, 2) == 1 and f.clip(5, 0, 3) == 3 and f.minimum(3.0, 2.0, 1.0) == 1.0
    assert f.tanh(np.zeros(2)).tolist() == [0, 0] and f.pick(1, "abc") == "b"
    with pytest.raises(AttributeError, match="'Known' object has no attribute 'hypot'"):
        scenario(lambda seen: seen.own.hypot).text()


def test_numpy_and_its_arrays_are_written_down_too():
    weights = np.arange(6.0).reshape(2, 3)

    def network(seen):
        own = seen.own
        inner = np.tanh(weights @ np.array([own.north_m, own.east_m, 1.0]))
        return seen.along(np.arctan2(inner[0], inner[1]), np.float64(2.0) * np.sqrt(np.abs(own.north_mps)))

    text = scenario(network).text()
    seen = Observation(0, drawn(random.Random(1), 2))
    does = next(line for line in text.splitlines() if line.startswith("does"))
    values = interpreted(text)(inputs_of(seen, None))
    assert [values[int(word)] for word in does.split()[2:]] == pytest.approx(list(network(seen).numbers), abs=1e-12)


def test_a_layer_of_relu_is_written_down():
    weights = np.array([[1.0, -2.0], [0.5, 0.25]])

    def policy(seen):
        return seen.along(0.0, np.sum(f.maximum(weights @ np.array([seen.own.north_m, seen.own.east_m]), 0.0)))

    seen, text = Observation(0, drawn(random.Random(1), 2)), scenario(policy).text()
    does = next(line for line in text.splitlines() if line.startswith("does"))
    assert interpreted(text)(inputs_of(seen, None))[int(does.split()[3])] == policy(seen).numbers[1]


def test_a_choice_between_actions_is_a_line_for_each():
    def careful(seen):
        near = seen.own.distance_m(seen.vehicles[1])
        slow = f.where(near < 3, seen.along(0, 1.0), seen.along(0, 2.0))
        return f.where(near < 1, hover(), slow)

    does = [line.split()[1:4:2] for line in scenario(careful).text().splitlines() if line.startswith("does")]
    assert does == [["when", "hover"], ["when", "along"], ["along", does[2][1]], ["hover"]]


@dataclass
class Kept:
    rad: float = 0.0


SHARED: list = []


WRONG = [
    ("if seen.own.north_m > 3: pass", "branches on a number .* write where\\(condition, a, b\\)"),
    ("while seen.own.north_m > 3: pass", "branches .* write a loop over a range that is known"),
    ("x = 1 if seen.own.north_m > 3 else 2", "branches .* write where\\(condition, a, b\\)"),
    ("x = min(seen.vehicles, key=lambda one: one.north_m)", "branches .* write smallest\\(items, key\\) of"),
    ("x = max(seen.vehicles, key=lambda one: one.north_m)", "branches .* write smallest\\(items, key\\) .* negated"),
    ("x = [one for one in seen.vehicles if one.north_m > 3]", "branches .* write a sum or minimum over all of them"),
    ("x = np.median([seen.own.north_m, seen.own.east_m])", "branches .* write smallest\\(items, key\\)"),
    ("x = np.clip(np.array([seen.own.north_m]), 0, 1)", "branches .* write clip\\(x, least, most\\) of"),
    ("x = np.zeros(3); x[0] = seen.own.north_m", "needs the value .* np.zeros\\(3, dtype=object\\)"),
    ("x = np.log(np.array([seen.own.north_m, 1.0]))", "NumPy has no log for this array; nor have formulas"),
    ("x = float(f'{seen.own.north_m}')", "needs the value .* leave it a number"),
    ("x = seen.vehicles[2]", "reads vehicle 2 of a team of vehicles 0 to 1"),
    ("x = min(seen.own.north_m, 3)", "branches .* write minimum\\(a, b\\)"),
    ("x = max(seen.own.north_m, 3)", "branches .* write maximum\\(a, b\\)"),
    ("x = seen.own.north_m > 3 and seen.own.east_m > 3", "branches .* write logical_and\\(a, b\\)"),
    ("x = f.where(seen.own.north_m > 3 and seen.own.east_m > 3, 1.0, 0.0)", "branches .* write logical_and\\(a, b\\)"),
    ("x = seen.own.north_m > 3 or seen.own.east_m > 3", "branches .* write logical_or\\(a, b\\)"),
    ("x = not seen.own.north_m > 3", "branches .* write logical_not\\(condition\\)"),
    ("x = 1 < seen.own.north_m < 3", "branches .* write logical_and\\(a < b, b < c\\)"),
    ("x = sorted([seen.own.north_m, seen.own.east_m])", "branches .* write smallest\\(items, key\\)"),
    ("x = seen.own.north_m in (1.0, 2.0)", "branches .* write comparisons, joined by logical_or"),
    ("x = math.sin(seen.own.north_m)", "needs the value .* write sin of skein_uav.formula"),
    ("x = math.log(seen.own.north_m)", "needs the value .* there is no logarithm in formulas"),
    ("x = float(seen.own.north_m)", "needs the value .* leave it a number, without float"),
    ("x = int(seen.own.north_m)", "needs the value .* write floor\\(x\\) or ceil\\(x\\) of skein_uav.formula"),
    ("x = round(seen.own.north_m)", "needs the value .* write rint\\(x\\) of skein_uav.formula"),
    ("x = f'{seen.own.north_m:.2f}'", "needs the value .* leave it away, or make it a series"),
    ("x = [1, 2][seen.own.north_m]", "indexes by a number .* write pick\\(index, values\\)"),
    ("x = range(seen.own.north_m)", "counts or indexes by a number .* write a loop over a range that is known"),
    ("x = {1.0: 2}[seen.own.north_m]", "looks something up .* write pick\\(index, values\\)"),
    ("x = math.dist((seen.own.north_m, 0.0), (1.0, 0.0))", "write hypot\\(x, y\\) of skein_uav.formula"),
    ("x = np.cumsum(seen.own.north_m)", "there is no cumsum in formulas"),
    ("x = np.maximum(0, np.array([seen.own.north_m, 1.0]))", "branches .* write maximum\\(a, b\\) of skein_uav.formula"),
    ("x = np.array([seen.own.north_m]); x = f.where(x > 0, x, 0.0)", "branches .* write maximum or minimum of"),
    ("x = np.sin(np.array([seen.own.north_m, 1.0]))", "NumPy has no sin for this array; write sin of skein_uav.formula"),
    ("x = np.arctan2(np.array([1.0, seen.own.north_m]), 2.0)", "NumPy has no arctan2 for this array; write arctan2 of"),
    ("x = np.rad2deg(np.array([seen.own.north_m]))", "NumPy has no rad2deg for this array; nor have formulas"),
    ("x = seen.own.north_m ** seen.own.east_m", "raises to a power; write a product, or sqrt, or exp"),
    ("x = (seen.own.north_m > 3) * 2.0", "computes with a condition; write where\\(condition, 1.0, 0.0\\)"),
    ("x = f.where(seen.own.north_m, 1, 2)", "takes a number for a condition; write a comparison"),
    ("x = f.sin('a') + f.hypot(seen.own.north_m, 'a')", "must be real number"),
    ("x = f.atan2(seen.own.north_m)", "atan2.. takes 2 numbers, got 1"),
    ("x = seen.own.north_m / (len(seen.vehicles) - 2)", "it divides by 0"),
    ("x = 3.0 % seen.own.north_m // np.float64(0)", "it divides by 0"),
    ("x = np.isnan(np.array([seen.own.north_m]))", "NumPy has no isnan for this array; nor have formulas"),
    ("x = any(one.north_m > 3 for one in seen.vehicles)", "branches .* write logical_or or logical_and"),
    ("x = f.where(seen.own.north_m > 3, 'a', 'b')", "where takes two of one kind, got str 'a' and str 'b'"),
    ("return seen.along(0.0, 1.0, 3.0)", "the policy of Own: expected a yaw, such as Yaw.forward.., got float 3.0"),
    ("x, y = seen.own.north_m", "one number, not several"),
    ("return seen.own.north_m", "expected an action, such as seen.along\\(heading, speed\\), got Number"),
    ("return", "expected an action, .* got None; is a return missing\\?"),
    ("return seen.along(seen.own.north_m > 3, 1.0)", "py:2: the policy of Own: expected a number as argument 1 .* a condition; write where"),
    ("return seen.along('north', 1.0)", "py:2: the policy of Own: expected a number as argument 1 of along, got str 'north'"),
]


@pytest.mark.parametrize("line, told", WRONG, ids=[one[0] for one in WRONG])
def test_what_cannot_be_written_down_is_told_with_its_line_and_what_to_write(line, told, tmp_path):
    file = tmp_path / "patrol.py"
    file.write_text(f"def policy(seen):\n    {line}\n    return seen.along(0.0, 1.0)\n")
    names = {"math": math, "np": np, "f": f}
    exec(compile(file.read_text(), str(file), "exec"), names)
    expected = TypeError if "real number" in told or "takes 2" in told else Untraceable
    with pytest.raises(expected, match=f"(?s){told}") as caught:
        scenario(names["policy"]).text()
    if expected is Untraceable:
        assert "patrol.py:" in str(caught.value)


def test_a_standard_deviation_of_numpy_is_written_down():
    def policy(seen):
        return seen.along(0.0, np.std([one.north_m for one in seen.vehicles]))

    seen, text = Observation(0, drawn(random.Random(1), 2)), scenario(policy).text()
    does = next(line for line in text.splitlines() if line.startswith("does"))
    assert interpreted(text)(inputs_of(seen, None))[int(does.split()[3])] == pytest.approx(policy(seen).numbers[1])


def lone(policy=lambda seen: seen.along(0.0, 1.0), **given):
    """A scenario whose methods and vehicle are replaced."""
    methods = {name: value for name, value in given.items() if callable(value) and name != "memory"}
    of = {name: value for name, value in given.items() if name not in methods}
    vehicles = {"vehicles": lambda self: [Vehicle("Own", policy, **of)]}
    return type("Lone", (Scenario,), {**vehicles, **methods})()


def gap(index):
    return Series("gap", "m", lambda now: now.distance_m(0, index))


SLIPS = [
    (lone(measures=lambda self: [gap(0)]), "a list of Measure from .*, got a Series; reduce it, .*mean gap"),
    (lone(measures=lambda self: [1.0]), "expected a list of Measure .*, got float 1.0"),
    (lone(measures=lambda self: gap(0).mean("gap")), "expected a list of Measure .*, got one Measure without a list"),
    (lone(measures=lambda self: [gap(9).mean("gap")]), "reads vehicle 9 of a team of vehicles 0 to 0"),
    (lone(measures=lambda self: [Series("way", "rad", lambda now: now.vehicles[0].heading_rad).mean("way")]),
     "py:[0-9]+: the series way: expected positions, .* in a measure, got heading_rad"),
    (lone(measures=lambda self: [gap(0).mean("a"), Series("gap", "m", lambda now: now.elapsed_s).mean("b")]),
     "py:[0-9]+: the series gap: expected a name of its own for each series, got 'gap' twice"),
    (lone(vehicles=lambda self: None), "expected a list of Vehicle .*, got None; is a return missing"),
    (Scenario(), "expected a method vehicles.. of Scenario, got none"),
    (lone(3.0), "expected a function as the policy of Own, got float 3.0"),
    (lone(lambda seen, memory: (hover(), memory)), "a function of an observation, as .* no memory, got one of .seen, memory"),
    (lone(memory=0.0), "a function of an observation and the memory, got one of .seen"),
    (lone(lambda seen: seen.along(seen.opponent.north_m, 1.0)), "it seeks an opponent of the only vehicle"),
    (lone(vehicles=lambda self: [Vehicle("A", lambda seen: hover())] * 2), "a name of its own .*, got 'A' twice"),
    (lone(vehicles=lambda self: [Vehicle("A", lambda seen: hover(), speed_mps="5")]), "the vehicle's speed, got str '5'"),
]


@pytest.mark.parametrize("made, told", SLIPS, ids=[one[1] for one in SLIPS])
def test_a_slip_is_answered_with_what_was_expected_and_the_users_frames_alone(made, told):
    with pytest.raises((Untraceable, TypeError, ValueError, NotImplementedError), match=f"(?s){told}") as caught:
        made.text()
    files = [Path(one.filename).name for one in traceback.extract_tb(caught.value.__traceback__)]
    assert files.count("places.py") == 1 and set(files) == {"places.py", "test_scenario.py"}
    assert caught.value.__cause__ is None or caught.value.__suppress_context__


def test_settings_of_a_class_that_is_no_dataclass_are_refused_where_it_is_made():
    class Bare(Scenario):
        pace_mps: float = setting(3.0, "pace, m/s")
        turn_rad: float = 0.5
        duration_s: float = 3.0

    with pytest.raises(TypeError, match="Bare has settings \\(pace_mps, turn_rad\\): write @dataclass above the class"):
        Bare(pace_mps=4.0)
    assert dataclass(Bare)(pace_mps=4.0).pace_mps == 4.0


def test_a_name_is_made_of_the_words_of_a_class_or_a_text():
    assert [type(name, (Scenario,), {})().title for name in ("Maypole", "MyMay_pole2")] == ["maypole", "my-may-pole2"]
    named = lone()
    named.name = "My Maypole!"
    assert named.title == "my-maypole" and "name my-maypole\n" in named.text()
    named.name = "Дрон"
    with pytest.raises(ValueError, match="expected a name of Latin letters, .*, got the name 'Дрон'"):
        named.text()


def test_each_vehicle_of_a_loop_keeps_its_own_number():
    class Fan(Scenario):
        def vehicles(self):
            return [Vehicle(f"V{i}", lambda seen: seen.along(float(i), 1.0)) for i in range(3)]

        def measures(self):
            return [Series(f"d{i}", "m", lambda now: now.vehicles[i].north_m).mean(f"m{i}") for i in range(3)]

    lines = Fan().text().splitlines()
    does = [line.split()[2] for line in lines if line.startswith("does")]
    assert [next(line for line in lines if line.startswith(f"{one} const")).split()[2] for one in does] == ["0.0", "1.0", "2.0"]
    assert [line.split()[3] for line in lines if line.startswith("series")] == [
        line.split()[0] for line in lines if line[0].isdigit() and line.split()[1] == "north"
    ]


def test_a_policy_may_be_a_part_of_a_function_or_an_object():
    def fan(place, seen):
        return seen.along(place, 1.0 if place else None)

    class Fan:
        def __call__(self, seen):
            return fan(0, seen)

    assert "does along" in scenario(functools.partial(fan, 1.0)).text()
    for policy, code in ((functools.partial(fan, 0), fan.__code__), (Fan(), Fan.__call__.__code__)):
        place = f"test_scenario.py:{code.co_firstlineno + 1}: the policy of Own"
        with pytest.raises(Untraceable, match=f"^{place}: expected a number as argument 2 of along, got None"):
            scenario(policy).text()


def test_a_memory_may_be_an_array():
    def policy(seen, memory):
        return seen.along(0.0, memory @ memory), memory + np.array([seen.elapsed_s, 1.0])

    text = scenario(policy, np.array([0.5, 2.0])).text()
    evaluate = interpreted(text)(inputs_of(Observation(0, drawn(random.Random(1), 2)), None, [0.5, 2.0]))
    remembers = [line.split()[1:] for line in text.splitlines() if line.startswith("remembers")]
    assert [[evaluate[int(one)] for one in row] for row in remembers] == [[0.5, 0.6], [2.0, 3.0]]
    with pytest.raises(Untraceable, match="of the first, array\\(2\\) of float, got array\\(1\\) of float"):
        scenario(lambda seen, memory: (hover(), memory[:1]), np.zeros(2)).text()


def test_more_operations_than_a_file_takes_are_refused_with_what_helps(monkeypatch):
    monkeypatch.setattr("skein_uav.lines._MOST_NODES", 3)
    with pytest.raises(Untraceable, match="at most 3 operations .* got [0-9]+; write fewer vehicles, or shorter policies"):
        ring.Ring().text()


def test_what_an_observation_lacks_is_told_with_what_it_has():
    seen = Observation(0, [Known()])
    with pytest.raises(AttributeError, match="velocity is no method .* import it from skein_uav.scenario"):
        seen.velocity(1.0, 0.0, 0.0)
    with pytest.raises(AttributeError, match="no rival; it has .* opponent, others, own, .* towards, vehicles"):
        seen.rival  # noqa: B018


def test_a_memory_is_of_one_form_and_belongs_to_one_vehicle():
    with pytest.raises(Untraceable, match="expected an action and the next memory, got Action"):
        scenario(lambda seen, memory: seen.along(memory.rad, 1.0), Kept()).text()
    with pytest.raises(Untraceable, match="a next memory of the form of the first, Kept\\(float\\), got float"):
        scenario(lambda seen, memory: (seen.along(0.0, 1.0), memory.rad), Kept()).text()
    with pytest.raises(Untraceable, match="expected a memory of floats, .* got str 'north'"):
        scenario(lambda seen, memory: (seen.along(0.0, 1.0), memory), "north").text()
    SHARED.clear()

    def shared(seen):
        SHARED.append(seen.own.north_m)
        return seen.along(SHARED[0] - seen.own.east_m, 1.0)

    class Two(Scenario):
        def vehicles(self):
            return [Vehicle("A", shared), Vehicle("B", shared)]

    with pytest.raises(Untraceable, match="a number of another decision; what a policy keeps is in its memory alone"):
        Two().text()


def test_what_a_scenario_lacks_is_told():
    class Empty(Scenario):
        def vehicles(self):
            return []

    with pytest.raises(ValueError, match="expected a list of Vehicle"):
        Empty().text()

    @dataclass
    class Odd(Scenario):
        side: float = setting(1.0, "which side")

        def vehicles(self):
            return [Vehicle("A", lambda seen: seen.along(0.0, 1.0 if self.side > 0 else 2.0))]

    with pytest.raises(Untraceable, match="write where"):
        Odd().text()
    with pytest.raises(ValueError, match="ends in .scenario, got patrol.txt"):
        ring.Ring().write("patrol.txt")
    with pytest.raises(ValueError, match="last_s or after_s, got both"):
        Series("a", "m", lambda now: 0.0).mean("a", last_s=1, after_s=2)


class Keeping(Scenario):
    count = 0
    seen = []
    gains = np.zeros(2)

    def vehicles(self):
        yield Vehicle("Own", getattr(self, self.name))

    def counts(self, seen):
        self.count += 1
        return seen.along(0.0, 1.0)

    def lists(self, seen):
        self.seen.append(seen.own.north_m)
        return seen.along(0.0, 1.0)

    def learns(self, seen):
        self.gains[0] += 1.0
        return seen.along(0.0, self.gains[0])

    def looks(self, seen):
        self.north_m = seen.own.north_m
        return seen.along(0.0, 1.0)

    @functools.cached_property
    def far_m(self):
        return 3.0

    def caches(self, seen):
        return seen.along(0.0, self.far_m)


@pytest.mark.parametrize("name, told", [("counts", "count"), ("lists", "seen"), ("learns", "gains"), ("looks", "north_m")])
def test_what_a_policy_keeps_outside_its_memory_is_refused_with_its_line(name, told):
    made = Keeping()
    made.name = name
    line = getattr(Keeping, name).__code__.co_firstlineno + 1
    with pytest.raises(Untraceable, match=f"test_scenario.py:{line}: self.{told}.*\n  it changes self.{told}, but is called"):
        made.text()


def test_a_cached_property_is_nothing_kept_and_a_variable_of_the_closure_is():
    made = Keeping()
    made.name = "caches"
    assert "does along" in made.text()
    count = 0

    def counting(seen):
        nonlocal count
        count += 1
        return seen.along(0.0, float(count))

    with pytest.raises(Untraceable, match="count \\+= 1\n  it changes count"):
        scenario(counting).text()


def test_what_a_measure_keeps_is_refused():
    class Closest(Scenario):
        least_m = 1000.0

        def vehicles(self):
            yield Vehicle("Own", lambda seen: hover())

        def closest(self, now):
            self.least_m = f.minimum(self.least_m, now.vehicles[0].north_m)
            return self.least_m

        def series(self):
            yield Series("closest", "m", self.closest)

    with pytest.raises(Untraceable, match="it changes self.least_m"):
        Closest().text()
