"""A link and a loop's timing around a batch of environments, as arrays and without Gymnasium."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Tree, beside, cast, each, leaf, namespace, on, put
from .profiles import Trace, delays
from .schedule import MOST_ROWS, Schedule, spawned

MOST_LINKS = 256
"""Of more environments, those share a link whose numbers differ by a multiple."""

_LATER = 2**31

Link = str | float | ArrayLike | Trace


class Seen(NamedTuple):
    """What a policy knows when it decides.

    Attributes
    ----------
    observation : Tree
        The newest that has arrived.
    age_s : array of float, shape (environments,)
        Since it was sampled; before one of the episode has arrived, since the episode began.
    pending : Tree or None
        The last ``pending`` decisions, the oldest first, shape (environments, pending, …).
    """

    observation: Tree
    age_s: Any
    pending: Tree | None


class Delay:
    """Decides which observation is seen, and which action acts, in each of a batch of environments.

    Arrays may be of NumPy, PyTorch or JAX, and stay where they are; what the link does is made ahead on the host and
    uploaded once in 128 steps.

    >>> delay = Delay(2, 0.05, observation_delay=0.05, action_delay=0.1)
    >>> delay.begin(np.array([0.0, 0.0]), seed=[1, 2]).age_s
    array([0., 0.])
    >>> delay.acting(np.array([7.0, 8.0]))      # has not arrived: nothing acts yet
    array([0., 0.])
    >>> delay.seen(np.array([1.0, 1.0])).observation
    array([0., 0.])

    Parameters
    ----------
    count : int
        Environments.
    step_s : float
        Simulated time of a step of the environment, s.
    link : str, float, array or Trace
        Both directions: a profile (`skein_uav.delay.profiles`), or one-way delays in s.
    observation_delay, action_delay : str, float, array or Trace, optional
        One direction, in the place of ``link``. A profile tells round trips here, too: one direction takes half.
    compute_s : float
        From an observation to the departure of the action chosen upon it, s.
    dropout : float
        Share of the messages of each direction that are lost, from 0 to 0.9; as many in a row as one time in 10⁹.
    moves_in_flight : int, optional
        Actions that may be unanswered, from 2. An action is answered when its successor arrives. What waits for an answer
        is superseded by what is chosen after it.
    arrival : {'next', 'share'}
        What an action does that arrives within a step. ``next``: it acts from the next one on. ``share``: the step gets
        the mean of the actions that are in force during it, each weighted by its share of the step; for actions of floats.
    first : {'known', 'zeros'}
        What is seen before an observation of the episode has arrived: the first one, or zeros as by Gymnasium's
        ``DelayObservation``.
    idle_action : array or number
        What acts before an action of the episode has arrived.
    pending : int
        Decisions that are told beside the observation.
    predict : callable, optional
        ``predict(observation, action)`` gives the observation a step later, for the whole batch. What is seen is then
        carried forward to the moment at which an action chosen now acts by the mean delay, under the actions on their way.
    every : int
        Steps of the environment from one decision to the next.
    seed : int, optional
        Of the link's own generators, until `begin` has one.

    Attributes
    ----------
    row : int
        Steps since the link began.
    longest_age_s : float
        Of an observation, s.

    Raises
    ------
    ValueError
        With what was expected, and what came.
    """

    def __init__(
        self,
        count: int,
        step_s: float,
        *,
        link: Link = "none",
        observation_delay: Link | None = None,
        action_delay: Link | None = None,
        compute_s: float = 0.0,
        dropout: float = 0.0,
        moves_in_flight: int | None = None,
        arrival: str = "next",
        first: str = "known",
        idle_action: ArrayLike = 0,
        pending: int = 0,
        predict: Callable[[Tree, Tree], Tree] | None = None,
        every: int = 1,
        seed: int | None = None,
    ) -> None:
        for what, is_right, expected, came in (
            ("step_s", 0 < step_s < math.inf, "more than 0 s", step_s),
            ("compute_s", 0 <= compute_s < math.inf, "at least 0 s", compute_s),
            ("dropout", 0 <= dropout <= 0.9, "a share from 0 to 0.9", dropout),
            ("moves_in_flight", moves_in_flight is None or moves_in_flight >= 2, "None or at least 2", moves_in_flight),
            ("arrival", arrival in ("next", "share"), "'next' or 'share'", arrival),
            ("first", first in ("known", "zeros"), "'known' or 'zeros'", first),
            ("pending", 0 <= pending <= 1000, "from 0 to 1000", pending),
            ("every", every >= 1, "at least 1", every),
        ):
            if not is_right:
                raise ValueError(f"{what}: expected {expected}, came {came!r}")
        if moves_in_flight is not None and dropout:
            raise ValueError("dropout: expected 0 beside moves_in_flight, since a lost action is never answered")
        both = delays(link, "link")
        back = both if observation_delay is None else delays(observation_delay, "observation_delay")
        to = both if action_delay is None else delays(action_delay, "action_delay")
        self.step_s, self._every, self._pending = step_s, every, pending
        self._is_zero, self._is_shared, self._predict = first == "zeros", arrival == "share", predict
        self._idle_action = idle_action
        is_own = any(one.trace is not None and one.trace.ndim == 2 for one in (back, to))
        links = count if is_own else min(count, MOST_LINKS)
        self._schedule = Schedule(
            links, step_s, back, to, compute_s=compute_s, dropout=dropout, moves_in_flight=moves_in_flight, every=every,
            shares=self._is_shared,
        )  # fmt: skip
        self.longest_age_s = self._schedule.oldest_seen * step_s
        self._ahead = self._schedule.action_delay_rows
        behind = (self._schedule.oldest_seen + self._ahead) // every + 2
        self._kept_observations = self._schedule.oldest_seen + 2
        self._kept_actions = max(self._schedule.oldest_acting, behind, pending) + 2
        self._count, self.row, self._block = count, 0, -1
        self._seeds = np.random.SeedSequence(seed).spawn(links)
        self._links: Any = np.arange(count) % links if count > links else None
        self._observations: Tree = None
        self._actions: Tree = {}
        self._idles: Tree = {}
        self._is_begun = False

    def begin(
        self,
        observations: Tree,
        mask: Any = None,
        seed: Sequence[int | None] | None = None,
        line: int = 0,
        actions: Tree = None,
    ) -> Seen:
        """Begins episodes with these observations; no time passes.

        Parameters
        ----------
        mask : array of bool, optional
            Only in these environments.
        seed : sequence of int or None, optional
            One an environment; the link begins anew, too. None: goes on.
        line : int
            Which of several vehicles over one link.
        actions : Tree, optional
            Of the kind of those to come: needed where pending ones are told, or observations predicted.
        """
        if not self._is_begun or (seed is not None and any(one is not None for one in seed)):
            for at, one in enumerate((seed or ())[: len(self._seeds)]):
                if one is not None:
                    self._seeds[at] = np.random.SeedSequence(one)
            self._schedule.seed(self._seeds, line)
            # An environment that is given no seed later goes on with other numbers.
            self._seeds = [spawned(one, _LATER) for one in self._seeds]
            self.row, self._block, self._is_begun = 0, -1, True
        self.row = -(-self.row // self._every) * self._every
        self._like = leaf(observations)
        self._xp = namespace(self._like)
        if self._observations is None:
            self._observations = each(lambda one: _ring(self._xp, one, self._kept_observations), observations)
            self._columns = on(self._like, np.arange(self._count))
            self._began = on(self._like, np.zeros(self._count, dtype=np.int64))
            # Of no axes, since a Python number takes NumPy as long as the sum itself.
            self._all = on(self._like, np.array(self._count))
            kept = max(self._kept_observations, self._kept_actions)
            self._begins = [on(self._like, np.array(one * self._count)) for one in range(kept)]
            self._ages = on(self._like, np.repeat(np.arange(self._kept_observations) * self.step_s, self._count))
            self._links = None if self._links is None else on(self._like, self._links)
        if not len(self._actions) and actions is not None:
            self._allocate(actions)
        mask = on(self._like, np.ones(self._count, dtype=np.bool_) if mask is None else mask)
        self._void(mask)
        now = self._slot(self.row, self._kept_observations)
        observations = each(
            lambda one, ring: self._xp.where(beside(mask, one), one, ring[now]), observations, self._observations
        )
        return self._look(observations)

    def acting(self, actions: Tree = None) -> Tree:
        """Takes what is decided at the begin of a step; gives what acts in it.

        Parameters
        ----------
        actions : Tree, optional
            None in the steps between two decisions.
        """
        if actions is not None:
            actions = each(lambda one: on(self._like, one), actions)
            if not len(self._actions):
                self._allocate(actions)
            now = self._slot(self.row // self._every, self._kept_actions)
            self._actions = each(lambda ring, one: put(_wide(ring, one), now, one), self._actions, actions)
        at = self._in_block()
        if self._is_shared:
            return self._mean(self._weights[at])
        return self._chosen(self._of(self._acts[at]), self.row // self._every)

    def seen(self, observations: Tree, began: Any = None) -> Seen:
        """Lets a step pass, after which the environment is as these observations tell.

        Parameters
        ----------
        began : array of bool, optional
            Where this step began a new episode: the observation is its first.
        """
        self.row += 1
        self._began = self._began - self._all
        if began is not None:
            self._void(on(self._like, began))
        return self._look(observations)

    # A ring holds one array of all environments after the other. What was so many steps ago is told by its place in
    # the ring, were that of now the first: the number of the environment, less so many times the number of all.

    def _of(self, lags: Any) -> Any:
        """Places of what came so long ago, by environment, from what `_in_block` told."""
        if self._links is None:
            return lags
        return self._columns + (lags.take(self._links) if self._xp is np else lags[self._links])

    def _slot(self, number: int, kept: int) -> slice:
        """Where a ring holds what came with a step or decision."""
        begin = number % kept * self._count
        return slice(begin, begin + self._count)

    def _void(self, mask: Any) -> None:
        """Episodes begin: what was decided before is void, and the idle action stands in the place of the last."""
        last = self._slot(-(-self.row // self._every) - 1, self._kept_actions)
        if self._xp is np:
            at = mask.nonzero()[0]
            if len(at):
                self._began[at] = at
                each(lambda ring, idle: ring.__setitem__(at + last.start, idle[at]), self._actions, self._idles)
            return
        self._began = self._xp.where(mask, self._columns, self._began)
        self._actions = each(lambda ring, idle: _put_where(ring, last, mask, idle), self._actions, self._idles)

    def _look(self, observations: Tree) -> Seen:
        row, now = self.row, self._slot(self.row, self._kept_observations)
        self._observations = each(lambda ring, one: put(ring, now, one), self._observations, observations)
        at = self._in_block()
        arrived = self._of(self._seen[at])
        newest = self._xp.maximum(arrived, self._began)
        places = newest + self._begins[row % self._kept_observations]
        observation = each(lambda ring: _taken(self._xp, ring, places), self._observations)
        if self._is_zero:
            has = arrived >= self._began
            observation = each(lambda one: self._xp.where(beside(has, one), one, self._xp.zeros_like(one)), observation)
        lag = self._columns - newest
        if self._predict is not None:
            observation = self._predicted(observation, lag // self._count, int(self._most[at]))
        pending = None
        if self._pending:
            ago = on(self._like, np.arange(self._pending, 0, -1) * self._count)
            pending = self._chosen(self._columns[:, None] + self._count - ago, -(-row // self._every))
        return Seen(observation, self._ages.take(lag) if self._xp is np else self._ages[lag], pending)

    def _predicted(self, observation: Tree, lag: Any, most: int) -> Tree:
        now = -(-self.row // self._every)
        for step in range(most + self._ahead):
            ago = now - (self.row - lag + step - self._ahead) // self._every
            places = self._columns - (ago - 1) * self._count
            later = self._predict(observation, self._chosen(places, now))
            goes = step < lag + self._ahead
            observation = each(lambda old, new: self._xp.where(beside(goes, old), new, old), observation, later)
        return observation

    def _chosen(self, places: Any, now: int) -> Tree:
        """What was chosen at these places, if the next is this decision; the idle action where before the episode."""
        began = self._began
        if self._every > 1:
            steps = (self._columns - began) // self._count + now * self._every - self.row
            began = self._columns - steps // self._every * self._count
        newest = self._xp.maximum(places, began if places.ndim == 1 else began[:, None])
        newest = newest + self._begins[(now - 1) % self._kept_actions]
        return each(lambda ring: _taken(self._xp, ring, newest), self._actions)

    def _mean(self, weights: Any) -> Tree:
        """The mean of the actions in force during a step."""
        now, shares, left = self.row // self._every, [], 1.0
        for lag in range(len(weights)):
            weight = weights[lag] if self._links is None else weights[lag][self._links]
            counts = self._columns - lag * self._count * self._every >= self._began
            shares.append(self._xp.where(counts, weight, 0.0))
            left = left - shares[-1]

        def mean(ring: Any, idle: Any) -> Any:
            one = ring[self._slot(now, self._kept_actions)]
            total = beside(left, one) * idle
            for lag, share in enumerate(shares):
                total = total + beside(share, one) * ring[self._slot(now - lag, self._kept_actions)]
            return cast(total, ring.dtype)

        return each(mean, self._actions, self._idles)

    def _allocate(self, actions: Tree) -> None:
        actions = each(lambda one: on(self._like, one), actions)
        idles = self._idle_action
        if not isinstance(idles, (dict, tuple)):
            idles = each(lambda one: self._idle_action, actions)

        def filled(one: Any, idle: Any) -> Any:
            if self._is_shared and "float" not in str(one.dtype):
                raise ValueError(f"arrival: expected 'next', since there is no mean of actions of {one.dtype}")
            return cast(on(self._like, np.broadcast_to(np.asarray(idle), tuple(one.shape)).copy()), one.dtype)

        self._idles = each(filled, actions, idles)
        self._actions = each(lambda idle: _ring(self._xp, idle, self._kept_actions), self._idles)

    def _in_block(self) -> int:
        """The place of this row in the schedule's block, which lies where the arrays do."""
        at = self._schedule.row(self.row)
        if self._block != self._schedule.first:
            self._block = self._schedule.first
            columns = np.arange(self._count) if self._links is None else 0
            seen, acts = (one.astype(np.int64) * self._count for one in (self._schedule.seen, self._schedule.acts))
            self._seen, self._acts = on(self._like, columns - seen), on(self._like, columns - acts + self._count)
            self._most = self._schedule.seen.max(1)
            self._weights = on(self._like, self._schedule.weights) if self._is_shared else None
            # Keeps within 32 bits.
            self._began = self._began.clip(-4 * MOST_ROWS * self._every * self._count)
        return at


def _ring(xp: Any, one: Any, length: int) -> Any:
    """Room for so many arrays, one after the other."""
    ring = xp.concatenate([one] * length)
    return np.ascontiguousarray(ring) if xp is np else ring  # as ``take`` wants it, whatever the environment has


def _put_where(ring: Any, slot: slice, mask: Any, value: Any) -> Any:
    return put(ring, slot, namespace(ring).where(beside(mask, value), value, ring[slot]))


def _taken(xp: Any, ring: Any, places: Any) -> Any:
    if xp is np:
        return ring.take(places, 0, mode="wrap")
    return ring[places % len(ring)]


def _wide(ring: Any, one: Any) -> Any:
    """The ring, so that it holds a value as it is."""
    return ring if ring.dtype == one.dtype else cast(ring, namespace(ring).promote_types(ring.dtype, one.dtype))
