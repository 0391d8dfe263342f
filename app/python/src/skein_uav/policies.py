"""Policies written in Python, for flights: a server that a flight calls for every decision."""

from __future__ import annotations

import struct
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from socketserver import StreamRequestHandler, ThreadingUnixStreamServer
from typing import Any

import numpy as np

from .batch import FIELDS, Floats

#: From an observation, shape (9,), to a number from -1 to 1; see `skein_uav.environments`.
Policy = Callable[[Floats], Any]

_QUESTION = 4 * FIELDS
_MOST_TEXT = 60_000


class PolicyServer:
    """Answers a flight's requests with a policy's decisions, on a thread of its own.

    Parameters
    ----------
    policy : callable
        Takes an observation, ndarray of float32 of shape (9,), and returns a number, or an array of one, which is
        clamped to -1 to 1. All flights of a command call it, and a rehearsal before live ones, so it must not count its
        calls.
    role : {'pursuer', 'evader'}
        The side that it decides for.
    turn_rate_rad_per_s : float, optional
        Its greatest turn rate; by default 1 rad/s for a pursuer, and an evader turns immediately.

    Attributes
    ----------
    option : str
        The value for ``./skein fly --policy``.
    """

    def __init__(self, policy: Policy, role: str, turn_rate_rad_per_s: float | None = None) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="skein-")
        path = str(Path(self._folder.name) / "policy")
        rate = "" if turn_rate_rad_per_s is None else f"@{turn_rate_rad_per_s:.12g}"
        self.option = f"unix:{role}{rate}:{path}"

        class Flight(StreamRequestHandler):
            def handle(self) -> None:
                while len(question := self.rfile.read(_QUESTION)) == _QUESTION:
                    answer = _answer(policy, question)
                    try:
                        self.wfile.write(answer)
                    except OSError:  # The flight has ended.
                        return

        self._server = ThreadingUnixStreamServer(path, Flight)
        # A policy that hangs must not delay the caller.
        self._server.daemon_threads = True
        self._server.block_on_close = False
        threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True).start()

    def __enter__(self) -> PolicyServer:
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._folder.cleanup()


def _answer(policy: Policy, question: bytes) -> bytes:
    try:
        seen = np.frombuffer(question, dtype=">f4").astype(np.float32)
        action = np.asarray(policy(seen))
        if action.size != 1 or action.dtype.kind not in "fiu" or not np.isfinite(action).all():
            raise ValueError(f"expected a number from -1 to 1, got {action!r}")
        return struct.pack(">bf", 0, min(max(float(action.reshape(())), -1.0), 1.0))
    except Exception as mistake:
        told = f"{type(mistake).__name__}: {mistake}".encode()[:_MOST_TEXT]
        return struct.pack(">bi", 1, len(told)) + told
