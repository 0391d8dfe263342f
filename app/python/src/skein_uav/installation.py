"""Finds Java and Skein's own files."""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass
from glob import glob
from pathlib import Path

from .errors import NotFound

_JAVA = 25
_VECTOR = "jdk.incubator.vector"

#: Where Java is usually installed; a star stands for any name.
_USUAL = (
    "/usr/lib/jvm/*",
    "/opt/java/*",
    "~/.sdkman/candidates/java/*",
    "~/.jdks/*",
    "/Library/Java/JavaVirtualMachines/*/Contents/Home",
)


@dataclass(frozen=True)
class Installation:
    """The files that a command needs.

    Parameters
    ----------
    java : Path
        Home folder of Java 25, with ``bin/java``.
    home : Path
        Skein's folder, with ``bin/skein`` and ``lib/*.jar``.
    """

    java: Path
    home: Path

    @property
    def launcher(self) -> Path:
        """The program that runs commands."""
        return self.home / "bin" / "skein"

    @property
    def jars(self) -> list[str]:
        """All jars, in a fixed order."""
        return sorted(glob(str(self.home / "lib" / "*.jar")))


def find() -> Installation:
    """Finds Skein, and Java if Skein does not include one.

    Returns
    -------
    Installation

    Raises
    ------
    NotFound
        If either is missing; the message lists where it was sought.
    """
    home = find_home()
    runtime = home / "runtime"
    return Installation(runtime if (runtime / "bin" / "java").exists() else find_java(), home)


def find_java() -> Path:
    """Finds a Java 25 that has the vector module: ``JAVA_HOME``, ``PATH``, then the usual folders.

    Returns
    -------
    Path
        Its home folder.

    Raises
    ------
    NotFound
        If there is none.
    """
    places = []
    if configured := os.environ.get("JAVA_HOME"):
        places.append(configured)
    if on_path := shutil.which("java"):
        places.append(str(Path(on_path).resolve().parent.parent))
    for usual in _USUAL:
        places += sorted(glob(os.path.expanduser(usual)))
    for place in places:
        if _is_java(Path(place)):
            return Path(place)
    looked = ", ".join(dict.fromkeys([*places, *_USUAL]))
    raise NotFound(
        f"expected a Java {_JAVA} with the module {_VECTOR}; looked in JAVA_HOME, on PATH and in {looked}. "
        f"Install one (Temurin {_JAVA}, for example) or set JAVA_HOME to it."
    )


def _is_java(home: Path) -> bool:
    try:
        release = (home / "release").read_text()
    except OSError:
        return False
    return f'JAVA_VERSION="{_JAVA}' in release and _VECTOR in release and (home / "bin" / "java").exists()


def find_home() -> Path:
    """Finds Skein: ``SKEIN_HOME``, the files in this package, or the build of the checkout that contains it.

    Returns
    -------
    Path

    Raises
    ------
    NotFound
        If none of them has ``bin/skein``.
    """
    here = Path(__file__).resolve().parent
    places = [here / "skein", here.parents[2] / "cli" / "target" / "universal" / "stage"]
    if configured := os.environ.get("SKEIN_HOME"):
        places = [Path(configured)]
    for place in places:
        if (place / "bin" / "skein").exists():
            return place
    raise NotFound(
        f"expected bin/skein in {' or '.join(map(str, places))}. "
        "In a checkout, ./sbtw cli/stage builds it; SKEIN_HOME may name another folder."
    )
