import re
import sys

import pandas as pd
import pytest

from skein_uav.progress import Progress
from skein_uav.results import Budget, Flights, Found, Tables

LINES = [
    "flying 4 flights",
    "  2 %  5 min left   best 4.1 m",
    " 66 %  5 s left     best 3.0 m",
    "drawing the landscape",
    " 12 %  37 s left    rows",
]


def test_tables_are_shown_with_their_titles_and_notes_as_text():
    frame = pd.DataFrame({"loop": ["<stream>"], "closest m": [3.5], "vs paused": [None]})
    frame.attrs["note"] = "a < b"
    page = Tables({"Distance & more": frame})._repr_html_()
    assert "<h4>Distance &amp; more</h4>" in page and "&lt;stream&gt;" in page and "a &lt; b" in page
    assert "None" not in page and "NaN" not in page


def test_results_without_figures_are_shown_as_tables(tmp_path):
    frame = pd.DataFrame({"policy": ["lead-pursuit"]})
    assert "<img" not in Found(frame, None, None, tmp_path)._repr_html_()
    assert "lead-pursuit" in Budget(frame, "holds", "SIMD", tmp_path)._repr_html_()
    assert Flights(Tables(), [], tmp_path / "report.html")._repr_html_() == ""


def test_only_figures_of_the_command_are_shown_beside_files_of_others(tmp_path):
    for name in ("map", "landscape", "mine"):
        (tmp_path / f"{name}.svg").write_text(f"<svg>{name}</svg>")
    frame = pd.DataFrame({"policy": ["lead-pursuit"]})
    assert list(Found(frame, None, None, tmp_path).figures) == ["landscape"]
    assert Budget(frame, "holds", "SIMD", tmp_path).figures["map"]._repr_svg_() == "<svg>map</svg>"


def test_a_budget_says_its_sentence_and_its_deviations_in_per_cent(tmp_path):
    (tmp_path / "map.csv").write_text("periodMs,meanMs,deviation\n100.0,50.0,0.025\n")
    one = {"policy": "patrol", "sentence": "holds up to 50 ms", "engine": "SIMD", "deviation": "share of the truth"}
    found = Budget.of([one], tmp_path)
    assert found.map["deviation %"].tolist() == [2.5] and found.engine == "SIMD"
    assert repr(found).startswith("Budget(patrol: holds up to 50 ms; engine: SIMD; 1 cells")
    assert "holds up to 50 ms" in found._repr_html_()
    within = Budget.of([{**one, "deviation": "distance from the truth"}], tmp_path)
    assert within.map["deviation"].tolist() == [0.025]


def test_the_parameters_that_a_search_found_are_numbers(tmp_path):
    frame = pd.DataFrame({"policy": ["patrol"], "parameters": ["ring-m = 2.5, gain-per-s = 1.0E-4"]})
    assert Found(frame, None, None, tmp_path).parameters == {"ring-m": 2.5, "gain-per-s": 1e-4}


def test_a_name_that_is_missing_is_answered_with_those_there_are(tmp_path):
    (tmp_path / "map.svg").write_text("<svg></svg>")
    for names in (Budget(pd.DataFrame(), "", "", tmp_path).figures, Tables({"map": pd.DataFrame()})):
        with pytest.raises(KeyError, match="expected one of 'map', got 'maps'"):
            names["maps"]


def test_progress_is_a_bar_for_each_part_of_the_work_and_other_lines_stay(capsys):
    pytest.importorskip("tqdm")
    with Progress() as progress:
        for line in LINES:
            progress.show(line)
    shown = re.split(r"[\r\n]+", capsys.readouterr().err)
    assert "flying 4 flights" in shown and "drawing the landscape" in shown
    assert any("66%" in line and "best 3.0 m" in line for line in shown)
    assert any("12%" in line and "rows" in line for line in shown)


def test_flights_are_counted_by_the_bar(capsys):
    pytest.importorskip("tqdm")
    with Progress() as progress:
        for done in range(1, 5):
            progress.show(f"{done} of 4 flights have ended")
    assert "100%" in capsys.readouterr().err


def test_without_tqdm_progress_is_the_lines_of_the_command(capsys, monkeypatch):
    for name in ("tqdm", "tqdm.auto"):
        monkeypatch.setitem(sys.modules, name, None)
    with Progress() as progress:
        for line in LINES:
            progress.show(line)
    assert capsys.readouterr().err.splitlines() == LINES
