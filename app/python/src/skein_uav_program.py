"""The program ``skein``. Apart from the package, whose libraries take longer to load than the program to start."""

import os
import sys
from pathlib import Path


def main() -> None:
    """Becomes Skein's launcher: the one in the wheel, else the one that the package finds."""
    launcher = Path(__file__).resolve().parent / "skein_uav" / "skein" / "bin" / "skein"
    if not launcher.exists():
        from skein_uav.errors import NotFound
        from skein_uav.installation import find

        try:
            installed = find()
        except NotFound as missing:
            sys.exit(f"skein: {missing}")
        os.environ["JAVA_HOME"] = str(installed.java)
        launcher = installed.launcher
    os.execv(launcher, [str(launcher), *sys.argv[1:]])
