"""Where Java and Skein are found; no Java is started."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import skein_uav
from skein_uav.errors import NotInstalled
from skein_uav.installation import find


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for program in ("bin/skein", "runtime/bin/java"):
        file = tmp_path / program
        file.parent.mkdir(parents=True)
        file.write_text("#!/bin/sh\necho started: $*\n")
        file.chmod(0o755)
    monkeypatch.setenv("SKEIN_HOME", str(tmp_path))
    monkeypatch.setenv("JAVA_HOME", "/nowhere")
    return tmp_path


def test_a_runtime_of_its_own_is_used_before_any_other_java(home: Path) -> None:
    assert find().java == home / "runtime"


def test_the_program_skein_becomes_the_launcher(home: Path) -> None:
    source = Path(__file__).resolve().parents[1] / "src"
    said = subprocess.run(
        [sys.executable, "-c", "import skein_uav_program; skein_uav_program.main()", "fly", "--loop"],
        env={**os.environ, "PYTHONPATH": str(source)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout == "started: fly --loop\n"


@pytest.mark.parametrize("module", ["gymnasium", "jpype"])
def test_a_package_of_an_extra_that_is_missing_is_told_with_the_extra(monkeypatch: pytest.MonkeyPatch, module: str) -> None:
    if module == "jpype":
        pytest.importorskip("gymnasium")
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(NotInstalled, match=rf"{module} is not installed; pip install 'skein-uav\[learn\]' installs it"):
        skein_uav.evaluate(lambda seen: seen[..., 0], draws=2)
