"""The Java machine in this process, started when it is first needed."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
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
        with _without_remark():
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


@contextmanager
def _without_remark() -> Iterator[None]:
    """Standard error without the line in which Java remarks on the vector module, before any option can prevent it.

    Whatever else is written meanwhile passes, also if Java ends this process: another one filters it.
    """
    try:
        own = os.dup(2)
    except OSError:  # There is none.
        yield
        return
    remark = "/^WARNING: Using incubator modules: jdk[.]incubator[.]vector$/d"
    filtering = subprocess.Popen(["sed", remark], stdin=subprocess.PIPE, stdout=own)
    assert filtering.stdin is not None
    os.dup2(filtering.stdin.fileno(), 2)
    filtering.stdin.close()
    try:
        yield
    finally:
        os.dup2(own, 2)
        os.close(own)
        # Another thread's child of this moment holds it open, for as long as it lives.
        with suppress(subprocess.TimeoutExpired):
            filtering.wait(timeout=1)


def _library(java: Any) -> Any:
    for name in ("lib/server/libjvm.so", "lib/server/libjvm.dylib"):
        if (java / name).exists():
            return java / name
    raise SkeinError(f"expected {java}/lib/server/libjvm.so or .dylib, which is missing")
