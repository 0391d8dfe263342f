from dataclasses import dataclass

import numpy as np
import pandas as pd
import pytest

import skein_uav as skein
from skein_uav import arguments, installation, tables
from skein_uav.formula import atan2
from skein_uav.scenario import Series, Vehicle, setting


@pytest.fixture(scope="module")
def flights(tmp_path_factory):
    return skein.fly(link="vpn", duration_s=15, seed=3, out=tmp_path_factory.mktemp("flights"))


def test_a_flight_comes_as_frames_with_numbers(flights):
    distance = next(iter(flights.tables.values()))
    assert distance["loop"].tolist() == ["stream"]
    assert 3 < distance["closest m"].iloc[0] < 6
    assert distance.columns.is_unique and flights.report.exists()


def test_columns_have_names_of_their_own_and_hold_numbers(flights):
    table = tables.frame(
        {
            "columns": ["loop", "last 10 s m", "min … max", "vs paused", "paper m", "min … max", "vs paused", "age ms"],
            "rows": [
                ["stream", 10.8, "10.8 … 10.9", "+30.4 %", 8.5, "5.0 … 11.6", None, "43/42/119"],
                ["paused", 8.3, "8.3 … 8.4", None, 8.5, "8.4 … 8.6", "-2 %", None],
            ],
            "note": "",
        }
    )
    assert table.columns.tolist() == [
        *("loop", "last 10 s m", "min", "max", "vs paused %", "paper m", "paper m: min", "paper m: max"),
        *("paper m: vs paused %", "age ms mean", "age ms median", "age ms p99"),
    ]
    assert table["vs paused %"].iloc[0] == 30.4 and table["paper m: max"].tolist() == [11.6, 8.6]
    assert table["age ms p99"].iloc[0] == 119
    with pytest.raises(KeyError, match="expected one of .*, got .*nothing"):
        flights["nothing"]


def test_a_spread_has_a_column_for_each_of_its_numbers():
    cells = [["3.27 ± 0.01, 3.2 … 1.5E-4"]]
    table = tables.frame({"columns": ["mean gap m"], "rows": cells, "note": ""})
    assert table.iloc[0].to_dict() == {
        **{"mean gap m": 3.27, "mean gap m sd": 0.01, "mean gap m min": 3.2, "mean gap m max": 1.5e-4},
    }


def test_words_among_numbers_have_a_column_of_their_own():
    def columns(title, *cells):
        made = tables.frame({"columns": [title], "rows": [[cell] for cell in cells], "note": ""})
        return {name: [None if one != one else one for one in made[name]] for name in made}

    assert columns("vs paused", "+30.4 %", "starved", None) == {
        **{"vs paused %": [30.4, None, None], "vs paused note": [None, "starved", None]},
    }
    assert columns("last 10 s m", 8.5, "< 10 s") == {
        **{"last 10 s m": [8.5, None], "last 10 s m note": [None, "< 10 s"]},
    }
    assert columns("gap m", "3.27 ± 0.01, 3.2 … 3.5, 2 never", "3.5, 1 too short", "4 never", 2.5) == {
        "gap m": [3.27, 3.5, None, 2.5],
        "gap m sd": [0.01, None, None, None],
        "gap m min": [3.2, None, None, None],
        "gap m max": [3.5, None, None, None],
        "gap m note": ["2 never", "1 too short", "4 never", None],
    }
    assert columns("<at", "12", "stream") == {"<at": ["12", "stream"]}


def test_recordings_are_in_the_order_of_the_tables(tmp_path):
    flights = skein.fly(loop=["predictive", "stream"], link=["vpn", "none"], duration_s=2, out=tmp_path)
    table = next(iter(flights.tables.values()))
    recorded = [skein.load(one)["flight"].iloc[0] for one in flights.recordings]
    assert [(one.loop, one.link) for one in recorded] == list(zip(table["loop"], table["link"], strict=True))


def test_the_recording_of_a_live_flight_comes_before_its_twin():
    flights = skein.fly(link="none", duration_s=2, clock="real")
    assert [skein.load(one)["flight"].clock[0] for one in flights.recordings] == ["real", "virtual"]


def test_flights_without_a_terminal_that_shows_everything_have_the_columns_of_others(flights, monkeypatch):
    monkeypatch.setenv("LC_ALL", "C")
    other = skein.fly(link="vpn", duration_s=15, seed=3)
    assert list(other.tables) == list(flights.tables)
    for title, table in flights.tables.items():
        assert other[title].columns.tolist() == table.columns.tolist()
        assert other[title].attrs == table.attrs


def test_beside_a_configuration_flights_are_those_of_the_file(tmp_path):
    conf = tmp_path / "two.conf"
    conf.write_text("skein.fly { loops = [sequential], links = [none], duration = 3 s, seed = 5 }")
    flights = skein.fly(config=conf)
    with flights.load() as recording:
        flight = recording["flight"].iloc[0]
        assert (flight.loop, flight.link, flight.durationMs, flight.seed) == ("sequential", "none", 3000, 5)
    given = arguments.planned(None, ["none", "vpn"], 5, None, {"config": conf})
    assert given == {"loop": [None], "link": ["none", "vpn"], "duration": "5000ms"}
    plain = arguments.planned(None, None, None, None, {})
    assert plain == {"loop": ["stream"], "link": ["direct"], "duration": "60000ms"}


def test_a_failed_flight_leaves_the_recordings_and_says_where(monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(skein.SkeinError, match=f"was written before is in {tmp_path}/skein-"):
        skein.fly(link="none", duration_s=2, pursuer=lambda seen: 1 / 0)
    assert list(tmp_path.glob("skein-*/*.duckdb"))


def test_a_search_leaves_unsaid_numbers_to_the_command(monkeypatch):
    given = {}
    monkeypatch.setattr("skein_uav.commands.run", lambda command, **options: given.update(options) or {"": pd.DataFrame()})
    skein.search("surround")
    assert given["candidates"] is None and given["episodes"] is None


def test_a_notebook_shows_the_first_table_and_the_reports_figures(flights):
    page = flights._repr_html_()
    assert "closest m" in page and page.count("<img") >= 3
    assert page.index("<details>") < page.index("What happened")
    assert flights.figures["trajectories"]._repr_svg_().startswith("<svg")
    assert list(flights.figures)[-1] == "graph-stream"


def test_a_recording_says_how_old_each_decision_was(flights):
    with flights.load() as recording:
        decisions = recording["decision"]
        assert set(decisions.vehicle) == {"Evader", "Pursuer"}
        assert 60 < decisions.ownTrueAgeMs.mean() < 150
        counted = recording.sql("SELECT count(*) AS n FROM decision WHERE vehicle = ?", ["Pursuer"])
        assert counted.n[0] == (decisions.vehicle == "Pursuer").sum()
        with pytest.raises(KeyError, match="expected one of .*decision.*, got 'nothing'"):
            recording["nothing"]
        assert {name: len(table.columns) > 1 for name, table in recording.items()}.keys() == set(recording)
        assert "format" not in recording and recording.sql("SELECT version FROM format").size == 1


def test_equal_seeds_fly_equal_flights(flights, tmp_path):
    skein.fly(link="none", duration_s=2, out=tmp_path)
    again = skein.fly(link="vpn", duration_s=15, seed=3, out=tmp_path)
    assert [one.name for one in again.recordings] == [one.name for one in flights.recordings]
    with flights.load() as one, again.load() as other:
        pd.testing.assert_frame_equal(one["decision"], other["decision"])


def test_spread_and_search_come_as_frames(tmp_path):
    (spread,) = skein.spread(seeds=2, duration_s=15).values()
    assert spread["flights"].tolist() == [2]
    found = skein.search(candidates=8, episodes=2, population=4, fresh=16, out=tmp_path)
    assert found.result["policy"].iloc[0] == "paper-pursuer"
    assert found.policy is not None and found.policy.exists()
    assert found.landscape is not None and len(found.landscape) > 1
    assert list(found.figures) == ["landscape"] and "paper-pursuer" in found._repr_html_()


def test_what_a_command_refuses_is_an_exception_with_its_words():
    with pytest.raises(skein.SkeinError, match="no loop 'bogus': expected one of paused"):
        skein.fly(loop="bogus")
    with pytest.raises(skein.SkeinError, match="--bogus: no such option"):
        skein.spread(bogus=1)


def test_an_option_that_has_another_name_here_is_told_by_it():
    for function, options, name in [
        (skein.fly, {"duration": "5s"}, "duration_s"),
        (skein.fly, {"deadline": "20ms"}, "deadline_ms"),
        (skein.spread, {"duration": "5s"}, "duration_s"),
        (skein.search, {"set": "ring-m=8"}, "settings"),
    ]:
        with pytest.raises(TypeError, match=f"takes {name}, not {next(iter(options))}"):
            function(**options)


def test_a_file_that_is_no_recording_is_told(tmp_path):
    with pytest.raises(skein.SkeinError, match="which is no file"):
        skein.load(tmp_path / "nothing.duckdb")
    text = tmp_path / "text.duckdb"
    text.write_text("not a database")
    with pytest.raises(skein.SkeinError, match="expected a recording"):
        skein.load(text)


def test_a_missing_java_is_told_with_where_it_was_looked_for(monkeypatch, tmp_path):
    monkeypatch.setenv("JAVA_HOME", str(tmp_path))
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(installation, "_USUAL", (str(tmp_path / "jvm" / "*"),))
    with pytest.raises(skein.NotFound, match=f"expected a Java 25 .* JAVA_HOME, on PATH and in {tmp_path}"):
        installation.find_java()


def test_options_become_flags():
    assert arguments.flags({"moves_in_flight": 6, "link": ["vpn", "none"], "as_paper": True, "out": None}) == [
        *("--moves-in-flight", "6"),
        *("--link", "vpn", "--link", "none"),
        "--as-paper",
    ]
    assert arguments.flags({"link": (one for one in ("vpn", "none"))}) == ["--link", "vpn", "--link", "none"]
    assert arguments.flags({"period_ms": 50, "deadline_s": 0.5, "period": "50ms"}) == [
        *("--period", "50ms", "--deadline", "0.5s", "--period", "50ms"),
    ]


def test_settings_are_named_and_written_as_skein_reads_them():
    settings = {"ring_m": 6, "start-m": 2.5, "is_open": True, "is_shut": np.bool_(False)}
    assert arguments.texts(settings) == {"ring-m": "6", "start-m": "2.5", "is-open": "true", "is-shut": "false"}
    assert arguments.set_to({"ring_m": 6}) == ["ring-m=6"] and arguments.texts(None) == {}


WRONG = [
    (dict(loop=[]), ValueError, "loop: expected one or more, got none"),
    (dict(link=[]), ValueError, "link: expected one or more, got none"),
    (dict(link=iter(())), ValueError, "link: expected one or more, got none"),
    (dict(settings=["ring_m"]), TypeError, "settings: expected names with values, such as .*, got \\['ring_m'\\]"),
    (dict(seed=1.5), TypeError, "seed: expected a whole number from 0, got 1.5"),
    (dict(seed=-1), ValueError, "seed: expected a whole number from 0, got -1"),
    (dict(duration_s="8s"), TypeError, "duration_s: expected a number of s, got '8s'"),
    (dict(deadline_ms="8"), TypeError, "deadline_ms: expected a number of ms, got '8'"),
    (dict(scenario=skein.Scenario), TypeError, "expected a scenario, such as Scenario\\(\\), got the class Scenario"),
    (dict(scenario=3), TypeError, "expected a scenario, its file or its name, got int 3"),
]


@pytest.mark.parametrize("given, error, told", WRONG)
def test_an_argument_of_the_wrong_kind_is_refused_before_java_starts(given, error, told):
    with pytest.raises(error, match=told):
        skein.fly(**given)


def test_bounds_of_a_search_are_two_numbers():
    with pytest.raises(TypeError, match=r"vary: expected the least and the greatest value of ring_m, such as .* got 5"):
        skein.search("surround", vary={"ring_m": 5})
    assert arguments.varied({"ring_m": (4, 12.5)}) == ["ring-m=4..12.5"]


class Broken(skein.Scenario):
    heading = 90.0

    def vehicles(self):
        return [Vehicle("Own", lambda seen: seen.along(0.0, 1.0), heading_rad=self.heading)]


def test_a_message_about_a_file_is_of_the_place_in_python(tmp_path):
    file = arguments.scenario_file(Broken(), tmp_path)
    number = next(at for at, line in enumerate(Broken().text().splitlines(), 1) if line.startswith("vehicle"))
    place = f"test_commands.py:{Broken.vehicles.__code__.co_firstlineno + 1}: the policy of Own"
    assert file.explained(f"skein fly: --scenario: {file}: line {number}: no") == f"skein fly: {place}: no"
    assert file.explained(f"skein fly: --scenario: {file}: by its defaults: agents: no") == "skein fly: vehicles(): no"
    with pytest.raises(skein.SkeinError, match="fly: vehicles..: expected a heading .* in radians, .* got 90.0, of Own"):
        skein.fly(Broken())
    with pytest.raises(skein.SkeinError, match="out: cannot write to /proc/x: "):
        skein.fly(Broken(), out="/proc/x")


def test_a_flight_that_memory_cannot_hold_is_refused_at_its_start_and_leaves_no_folder(monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(skein.SkeinError, match="--duration: expected at most .* in virtual time, .* got 60000 s"):
        skein.fly(duration_s=60_000)
    assert list(tmp_path.glob("skein-*")) == []


def test_a_search_of_nothing_measured_is_refused():
    unmeasured = Broken()
    unmeasured.heading = 1.0
    with pytest.raises(skein.SkeinError, match="expected measures to optimise, got none in broken"):
        skein.search(unmeasured, vary={"pace": (1, 2)})


def test_a_search_that_is_interrupted_says_how_it_goes_on(monkeypatch, tmp_path):
    def interrupted(*_, **__):
        for name in ("search.json", "policy.conf"):
            (tmp_path / name).touch()
        raise KeyboardInterrupt

    monkeypatch.setattr("skein_uav.commands.run", interrupted)
    with pytest.raises(KeyboardInterrupt, match=f"resume='{tmp_path}'. goes on .*; the best so far is in .*policy.conf"):
        skein.search(out=tmp_path)


def test_a_scenario_in_python_is_flown_searched_and_budgeted(tmp_path):
    @dataclass
    class Chase(skein.Scenario):
        pace_mps: float = setting(6.0, "speed of the chaser, m/s")
        duration_s = 12.0

        def vehicles(self):
            yield Vehicle("Runner", lambda seen: seen.along(0.5, 4.0), start_ned_m=(20, 0, -5), role="Runner")
            yield Vehicle("Chaser", self.chase, role="Chaser")

        def chase(self, seen):
            to = seen.opponent
            return seen.along(atan2(to.east_m - seen.own.east_m, to.north_m - seen.own.north_m), self.pace_mps)

        def measures(self):
            return [Series("gap", "m", lambda now: now.distance_m(0, 1)).mean("mean gap", last_s=5)]

    flights = skein.fly(Chase(), loop=["stream", "predictive"], link="vpn", out=tmp_path)
    table = next(iter(flights.tables.values()))
    assert table["loop"].tolist() == ["stream", "predictive"] and (tmp_path / "chase.scenario").exists()
    faster = skein.fly(Chase(pace_mps=9.0), link="vpn")
    assert next(iter(faster.tables.values()))["mean gap m"].iloc[0] < table["mean gap m"].iloc[0]
    found = skein.search(
        Chase(), vary={"pace_mps": (4, 9)}, objective="mean-gap", candidates=12, episodes=2, fresh=4, link="vpn"
    )
    assert "SIMD" in " ".join(found.result.astype(str).iloc[0])
    assert found.result["policy"].tolist() == ["chase", "chase, unchanged"] and 4 <= found.parameters["pace-mps"] <= 9
    cells = skein.budget(Chase(), episodes=16, means=2, jitters=2)
    assert set(cells.map["meanMs"]) == {0.0, 100.0} and "deviation %" in cells.map
    assert "SIMD" in cells.engine and "within 5 % of the truth" in cells.sentence
    assert cells._repr_html_().count("<img") == 1 and list(cells.figures) == ["map"]
    (spread,) = skein.spread(Chase(), seeds=2).values()
    assert spread["flights"].tolist() == [2]
