"""The Java virtual machine in this process, started on first use."""

from __future__ import annotations

import contextlib
import fcntl
import gc
import os
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .errors import SkeinError, needed
from .installation import find

_forked = False

_starting = threading.Lock()


def _fork() -> None:
    global _forked
    _forked = True
    # JPype asks for Java's collection after Python's: without Java's threads it would wait forever.
    gc.callbacks[:] = [one for one in gc.callbacks if getattr(one, "__module__", None) != "_jpype"]


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """Admits one thread of one of a user's processes at a time.

    Threads that start Java simultaneously would both find that it does not run; and when many processes started it
    simultaneously on a very busy machine, JPype crashed in some. If there is no folder for the lock, or it is another
    user's, processes do not lock.
    """
    with _starting, contextlib.ExitStack() as held:
        with contextlib.suppress(OSError):
            path = Path(tempfile.gettempdir()) / f"skein-uav-java-{os.getuid()}.lock"
            lock = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC, 0o600)
            held.callback(os.close, lock)
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def start() -> Any:
    """Starts Java in this process, unless it runs.

    Returns
    -------
    module
        ``jpype``, which gives access to Java's classes.

    Raises
    ------
    SkeinError
        In a process that was forked after Java had been started: Java does not run there.
    """
    jpype = needed("jpype", "learn")

    if _forked:
        raise SkeinError(
            "Java was started before this process was forked, and does not live on in it: start processes by "
            "'spawn', or give environments backend='socket'"
        )
    with _alone():
        if not jpype.isJVMStarted():
            installed = find()
            jpype.startJVM(
                str(_library(installed.java)),
                "--add-modules=jdk.incubator.vector",
                "--enable-native-access=ALL-UNNAMED",
                "--sun-misc-unsafe-memory-access=allow",
                "-Xlog:disable",
                "-Xrs",  # signals, Ctrl-C above all, stay Python's
                classpath=installed.jars,
                convertStrings=True,
                interrupt=True,  # else JPype has handlers of its own, which report Ctrl-C late and crash by SIGTERM
            )
            os.register_at_fork(after_in_child=_fork)
            # Java would wait for the end of the thread that started it; its next call attaches it as a daemon.
            jpype.java.lang.Thread.detach()
    return jpype


def _library(java: Any) -> Any:
    for name in ("lib/server/libjvm.so", "lib/server/libjvm.dylib"):
        if (java / name).exists():
            return java / name
    raise SkeinError(f"expected {java}/lib/server/libjvm.so or .dylib, which is missing")
