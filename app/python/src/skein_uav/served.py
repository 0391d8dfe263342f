"""Environments in a Java process of their own, behind a Unix socket: for processes that fork."""

from __future__ import annotations

import mmap
import os
import socket
import struct
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .batch import Block, Flags
from .errors import SkeinError
from .installation import find

_ENDS_WITHIN_S = 1.0


class Server:
    """A Java process that runs environments for any process of this machine's user.

    It ends when it is closed, or with the process that started it.

    Attributes
    ----------
    path : Path
        The socket: ``PursuitVectorEnv(backend=f"unix:{server.path}")`` connects to it.
    """

    def __init__(self) -> None:
        installed = find()
        self._folder = tempfile.TemporaryDirectory(prefix="skein-")
        self.path = Path(self._folder.name) / "socket"
        self._process = subprocess.Popen(
            [
                str(installed.java / "bin" / "java"),
                "--add-modules=jdk.incubator.vector",
                "-Xlog:disable",
                "-cp",
                os.pathsep.join(installed.jars),
                "skein.environment.EnvironmentServer",
                str(self.path),
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        assert self._process.stdout is not None
        if self._process.stdout.readline() != b"ready\n":
            self.close()
            raise SkeinError(f"the server of environments ended with status {self._process.returncode}")

    def close(self) -> None:
        """Ends the process and all its environments."""
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.close()
        try:
            self._process.wait(_ENDS_WITHIN_S)
        except subprocess.TimeoutExpired:  # a forked process holds its input open
            self._process.terminate()
            self._process.wait()
        self._process.stdout.close()
        self._folder.cleanup()

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Served:
    """A batch behind a socket; observations and actions are in a file that both processes map.

    Parameters
    ----------
    path : str or None
        Socket of a running server; None starts a server for this batch alone.
    climbs : bool
        Whether learners climb.

    Attributes
    ----------
    learners : list of str
        Names of the learners' vehicles.
    block : Block
    """

    def __init__(
        self, settings: Mapping[str, str], count: int, autoreset: int, path: str | None, climbs: bool = False
    ) -> None:
        self._server = None if path else Server()
        self._socket = socket.socket(socket.AF_UNIX)
        at = path or str(self._server.path)  # type: ignore[union-attr]
        try:
            self._socket.connect(at)
            self._open(settings, count, autoreset, climbs)
        except OSError as mistake:
            self.close()
            raise SkeinError(f"expected a server of environments at {at}: {mistake}") from None
        except (SkeinError, ValueError):
            self.close()
            raise

    def _open(self, settings: Mapping[str, str], count: int, autoreset: int, climbs: bool) -> None:
        self._ask(_text(settings))
        self.learners = self._receive_text().splitlines()
        agents = len(self.learners)
        size = Block.size(agents, count, climbs)
        with tempfile.NamedTemporaryFile(prefix="skein-") as file:
            file.truncate(size)
            self._map = mmap.mmap(file.fileno(), size)
            self.block = Block(np.frombuffer(self._map, dtype=np.uint8), agents, count, climbs)
            self._ask(_text({"count": count, "autoreset": autoreset, "file": file.name, **settings}))

    def reset(self, seeds: NDArray[np.int64], mask: Flags | None) -> None:
        told = seeds.astype(">i8").tobytes()
        self._ask(b"\x02" + told if mask is None else b"\x03" + told + mask.tobytes())

    def step(self) -> None:
        self._ask(b"\x01")

    def engine(self) -> str:
        self._ask(b"\x04")
        return self._receive_text()

    def close(self) -> None:
        self._socket.close()
        if self._server is not None:
            self._server.close()
            self._server = None

    def _ask(self, request: bytes) -> None:
        try:
            self._socket.sendall(request)
            status = self._receive(1)[0]
        except (BrokenPipeError, ConnectionResetError):
            raise SkeinError("the server of environments has ended") from None
        if status:
            message = self._receive_text()
            raise ValueError(message) if status == 1 else SkeinError(message)

    def _receive_text(self) -> str:
        (length,) = struct.unpack(">i", self._receive(4))
        return self._receive(length).decode()

    def _receive(self, count: int) -> bytes:
        received = b""
        while len(received) < count:
            part = self._socket.recv(count - len(received))
            if not part:
                raise SkeinError("the server of environments has ended")
            received += part
        return received


def _text(words: Mapping[str, object]) -> bytes:
    text = "\n".join(f"{name}={value}" for name, value in words.items()).encode()
    return struct.pack(">i", len(text)) + text
