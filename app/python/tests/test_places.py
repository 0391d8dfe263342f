"""Errors as a notebook shows them."""

import os
import re
from importlib.util import find_spec
from pathlib import Path

import pytest

# Jupyter's packages warn; in other tests a warning is an error.
pytestmark = pytest.mark.filterwarnings("default")

IMPORTS = "import skein_uav as skein\nfrom skein_uav.scenario import *"
WRONG = """class Wrong(Scenario):
    def vehicles(self):
        yield Vehicle("A", self.go)
    def go(self, seen):
        if seen.own.north_m > 3: return hover()
skein.fly(Wrong())"""


@pytest.mark.skipif(any(find_spec(one) is None for one in ("nbclient", "ipykernel")), reason="needs Jupyter")
def test_a_mistake_in_a_notebook_is_shown_by_its_cell_and_the_users_lines(monkeypatch):
    import nbformat
    from nbclient import NotebookClient

    package = str(Path(__file__).parents[1] / "src")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, (package, os.environ.get("PYTHONPATH")))))
    cells = [nbformat.v4.new_code_cell(one) for one in (IMPORTS, WRONG)]
    notebook = nbformat.v4.new_notebook(cells=cells)
    NotebookClient(notebook, timeout=120, kernel_name="python3", allow_errors=True).execute()
    (error,) = notebook.cells[1].outputs
    shown = re.sub(r"\x1b\[[0-9;]*m", "", "\n".join(error["traceback"]))
    assert error["evalue"].startswith("cell 2, line 5: if seen.own.north_m > 3: return hover()\n  it branches on")
    assert "site-packages" not in shown and "skein_uav/" not in shown
    assert len(shown.splitlines()) <= 26
