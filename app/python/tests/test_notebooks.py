"""The notebooks of `examples/notebooks`: minutes each, on a machine that does nothing else."""

import json
import os
from importlib.util import find_spec
from pathlib import Path
from shutil import copytree

import pytest

FOLDER = Path(__file__).parents[3] / "examples" / "notebooks"
NEEDED = {
    "measure-my-loop": ("matplotlib",),
    "write-and-search": ("gymnasium", "jpype"),
    "train-under-delay": ("gymnasium", "jpype", "matplotlib"),
    "delay-anywhere": ("gymnasium", "matplotlib", "mujoco", "stable_baselines3", "PyFlyt"),
}

# Jupyter's packages warn; in other tests a warning is an error.
pytestmark = pytest.mark.filterwarnings("default")


def test_every_notebook_is_run_here_and_named_in_the_readme():
    names = {file.stem for file in FOLDER.glob("*.ipynb")}
    assert names == set(NEEDED)
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert [name for name in names if f"]({name}.ipynb)" not in readme] == []


@pytest.mark.parametrize("name", NEEDED)
def test_a_notebook_is_stored_without_outputs(name):
    cells = json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert code and all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)


@pytest.mark.parametrize("name", NEEDED)
def test_a_notebook_runs_from_top_to_bottom(name, monkeypatch, tmp_path):
    missing = [one for one in ("nbclient", "nbformat", "ipykernel", *NEEDED[name]) if find_spec(one) is None]
    if missing:
        pytest.skip(f"not installed: {', '.join(missing)}")
    import nbformat
    from nbclient import NotebookClient

    package = str(Path(__file__).parents[1] / "src")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, (package, os.environ.get("PYTHONPATH")))))
    folder = copytree(FOLDER, tmp_path / "notebooks")  # MuJoCo leaves a log where it is used
    notebook = nbformat.read(folder / f"{name}.ipynb", as_version=4)
    NotebookClient(notebook, timeout=1800, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
