"""The Java machine in this process, started when it is first needed."""

from __future__ import annotations

import os
from typing import Any

from .errors import SkeinError
from .installation import find

_forked = False


def _fork() -> None:
    global _forked
    _forked = True


def start() -> Any:
    """Starts Java in this process, unless it runs.

    Returns
    -------
    module
        ``jpype``, by which Java's classes are reached.

    Raises
    ------
    SkeinError
        In a process that was forked after Java had been started: Java does not live on there.
    """
    import jpype

    if _forked:
        raise SkeinError(
            "Java was started before this process was forked, and does not live on in it: start processes by "
            "'spawn', or give environments backend='socket'"
        )
    if not jpype.isJVMStarted():
        installed = find()
        jpype.startJVM(
            str(_library(installed.java)),
            "--add-modules=jdk.incubator.vector",
            "--enable-native-access=ALL-UNNAMED",
            "--sun-misc-unsafe-memory-access=allow",
            "-Xlog:disable",
            classpath=installed.jars,
            convertStrings=True,
        )
        os.register_at_fork(after_in_child=_fork)
    return jpype


def _library(java: Any) -> Any:
    for name in ("lib/server/libjvm.so", "lib/server/libjvm.dylib"):
        if (java / name).exists():
            return java / name
    raise SkeinError(f"expected {java}/lib/server/libjvm.so or .dylib, which is missing")
