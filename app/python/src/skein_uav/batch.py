"""Many episodes in lockstep: the memory that Java and numpy share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import jvm
from .errors import SkeinError

#: Number of components of an observation.
FIELDS = 9

#: Numbers of components of an observation and of an action, of a learner that climbs.
CLIMBING = 13, 2

Floats = NDArray[np.float32]
Flags = NDArray[np.bool_]


class Block:
    """The arrays that a batch of environments shares with its backend, all views of one block of bytes.

    Parameters
    ----------
    memory : ndarray of uint8, shape (Block.size(agents, count),)
    agents : int
        Number of learners; they are in the scenario's order.
    count : int
        Number of environments.
    climbs : bool
        Whether learners climb.

    Attributes
    ----------
    actions : (agents, 1, count) float32, or (agents, 2, count)
    observations, finals : (agents, 9, count) float32, or (agents, 13, count)
    rewards : (agents, count) float32
    distance : (agents, count) float32
        Distance to the nearest opponent, m.
    time : (count,) float32
        Time since the episode began, s.
    terminated, truncated : (count,) bool
    due : (agents, count) bool
        Which learners decide now.
    """

    def __init__(self, memory: NDArray[np.uint8], agents: int, count: int, climbs: bool = False) -> None:
        self.memory = memory
        fields, shares = _components(climbs)
        at = 0

        def part(kind: type, *shape: int) -> NDArray[Any]:
            nonlocal at
            size = int(np.prod(shape)) * np.dtype(kind).itemsize
            at += size
            return memory[at - size : at].view(kind).reshape(shape)

        self.actions: Floats = part(np.float32, agents, shares, count)
        self.observations: Floats = part(np.float32, agents, fields, count)
        self.finals: Floats = part(np.float32, agents, fields, count)
        self.rewards: Floats = part(np.float32, agents, count)
        self.distance: Floats = part(np.float32, agents, count)
        self.time: Floats = part(np.float32, count)
        self.terminated: Flags = part(np.bool_, count)
        self.truncated: Flags = part(np.bool_, count)
        self.due: Flags = part(np.bool_, agents, count)

    @staticmethod
    def size(agents: int, count: int, climbs: bool = False) -> int:
        """Size of a block in bytes."""
        fields, shares = _components(climbs)
        return (4 * (agents * (shares + 2 * fields + 2) + 1) + 2 + agents) * count


def _components(climbs: bool) -> tuple[int, int]:
    return CLIMBING if climbs else (FIELDS, 1)


class Backend(Protocol):
    """Runs a batch: in this process, or behind a socket."""

    learners: list[str]
    block: Block

    def reset(self, seeds: NDArray[np.int64], mask: Flags | None) -> None: ...

    def step(self) -> None: ...

    def close(self) -> None: ...

    def engine(self) -> str: ...


class InProcess:
    """Runs the batch by Java in this process, directly on the memory of its block.

    Parameters
    ----------
    climbs : bool
        Whether learners climb.

    Attributes
    ----------
    learners : list of str
        Names of the learners' vehicles.
    block : Block
    """

    def __init__(self, settings: Mapping[str, str], count: int, autoreset: int, climbs: bool = False) -> None:
        jpype = jvm.start()
        self._jpype = jpype
        batches = jpype.JClass("skein.environment.EnvironmentBatch")
        prepared = self._told(lambda: batches.prepare(jpype.java.util.HashMap(settings)))
        self.learners = str(prepared.learners()).splitlines()
        agents = len(self.learners)
        # Java writes to it for the lifetime of this object.
        self.block = Block(np.zeros(Block.size(agents, count, climbs), dtype=np.uint8), agents, count, climbs)
        buffer = jpype.nio.convertToDirectBuffer(memoryview(self.block.memory))
        self._batch = self._told(lambda: prepared.make(count, autoreset, buffer))
        self._step = self._batch.step

    def reset(self, seeds: NDArray[np.int64], mask: Flags | None) -> None:
        if mask is None:
            self._told(lambda: self._batch.reset(seeds))
        else:
            self._told(lambda: self._batch.reset(seeds, mask))

    def step(self) -> None:
        if jvm._forked:
            jvm.start()
        self._told(self._step)

    def close(self) -> None:
        self._batch.close()

    def engine(self) -> str:
        return str(self._batch.engine())

    def _told(self, call: Any) -> Any:
        try:
            return call()
        except self._jpype.JException as mistake:
            is_users = mistake.getClass().getSimpleName() == "IllegalArgumentException"
            raise (ValueError if is_users else SkeinError)(str(mistake.getMessage())) from None
