"""A link and a loop's timing around a batch of environments, on arrays and without Gymnasium."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Tree, beside, cast, each, leaf, namespace, on
from .history import History
from .pending import OneHot, Pending, PendingElsewhere, PendingOneHot
from .profiles import Trace, delays
from .schedule import MOST_ROWS, Schedule, spawned

MOST_LINKS = 256
"""Of more environments, those share a link whose numbers differ by a multiple."""

_LATER = 2**31
_ROWS, _BYTES = 512, 2**24
"""Steps of which histories have room, if they fit into so many bytes, but as many as delays are long."""

Link = str | float | ArrayLike | Trace


class Seen(NamedTuple):
    """The input of a policy's decision.

    Attributes
    ----------
    observation : Tree
        The newest observation that has arrived.
    age_s : array of float, shape (environments,)
        Time since it was sampled, s; before the episode's first one has arrived, since the episode began.
    pending : Tree or None
        The last ``pending`` decisions, the oldest first, shape (environments, pending, …).
    """

    observation: Tree
    age_s: Any
    pending: Tree | None


class Delay:
    """Determines which observation is seen, and which action acts, in each of a batch of environments.

    Arrays may be of NumPy, PyTorch or JAX, and stay on their device; the link's behaviour is computed in advance on the
    host and uploaded for many steps together.

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
        Number of environments.
    step_s : float
        Simulated time of a step of the environment, s.
    link : str, array or Trace, optional
        Delays of both directions: a profile (`skein_uav.delay.profiles`), whose times are round trips, or one-way delays
        in s; by default none. A single number is refused, since it could be either.
    observation_delay, action_delay : str, float, array or Trace, optional
        Delays of one direction, s, instead of ``link``. A profile states round trips here, too: one direction takes half.
    compute_s : float
        Time from an observation to the departure of the action chosen on it, s.
    dropout : float
        Share of each direction's messages that are lost, 0 to 0.9; losses in a row end at a probability of 10⁻⁹.
    moves_in_flight : int, optional
        Maximum number of unanswered actions, from 2. An action is answered when its successor arrives. An action that
        waits for an answer is superseded by a newer one.
    arrival : {'next', 'share'}
        The effect of an action that arrives within a step. ``next``: it acts from the next step on. ``share``: the step
        gets the mean of the actions in force during it, weighted by their shares of the step; for actions of floats.
    first : {'known', 'zeros'}
        The observation seen before one of the episode has arrived: the first one, or zeros as in Gymnasium's
        ``DelayObservation``.
    idle_action : array or number
        The action that acts before one of the episode has arrived.
    pending : int
        Number of last decisions that are part of the policy's input.
    encode : callable, optional
        Encodes a batch of actions for the policy's input as pending ones; by default the actions themselves.
    predict : callable, optional
        ``predict(observation, action)`` returns the observation a step later, for the whole batch. The seen observation
        is then predicted for the time at which an action chosen now acts by the mean delay, under the pending actions.
    every : int
        Steps of the environment from one decision to the next.
    seed : int, optional
        Seed of the link's random generators, until `begin` sets one.

    Attributes
    ----------
    row : int
        Number of steps since the link began.
    longest_age_s : float
        Greatest age of an observation, s.
    spare : int
        If not 0, observations that are NumPy matrices and not predicted are followed by so many columns, the age and the
        pending decisions, and this matrix is returned instead of `Seen`. To be set before the first observation.

    Raises
    ------
    ValueError
        If an argument is invalid; states what was expected and what was given.
    """

    def __init__(
        self,
        count: int,
        step_s: float,
        *,
        link: Link | None = None,
        observation_delay: Link | None = None,
        action_delay: Link | None = None,
        compute_s: float = 0.0,
        dropout: float = 0.0,
        moves_in_flight: int | None = None,
        arrival: str = "next",
        first: str = "known",
        idle_action: ArrayLike = 0,
        pending: int = 0,
        encode: Callable[[Tree], Tree] | None = None,
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
                raise ValueError(f"{what}: expected {expected}, got {came!r}")
        if moves_in_flight is not None and dropout:
            raise ValueError("dropout: expected 0 beside moves_in_flight, since a lost action is never answered")
        if isinstance(link, Real):
            raise ValueError(
                f"link: expected a profile, whose times are round trips, such as 'constant:200ms', got {link!r}; "
                "delays of one direction in s are observation_delay and action_delay"
            )
        if link is not None and observation_delay is not None and action_delay is not None:
            raise ValueError("link: expected none beside observation_delay and action_delay, which are both directions")
        both = delays("none" if link is None else link, "link")
        back = both if observation_delay is None else delays(observation_delay, "observation_delay")
        to = both if action_delay is None else delays(action_delay, "action_delay")
        longest_s = max(back.longest_s, to.longest_s) + compute_s
        if 0 < longest_s < step_s / 20:
            warnings.warn(
                f"step_s is {step_s:g} s, and delays are of at most {longest_s:.3g} s: is it in s?", stacklevel=3
            )
        self.step_s, self._every, self._pending, self._encode = step_s, every, pending, encode
        self._is_zero, self._is_shared, self._predict = first == "zeros", arrival == "share", predict
        self._idle_action = idle_action
        is_own = any(one.trace is not None and one.trace.ndim == 2 for one in (back, to))
        links = count if is_own else min(count, MOST_LINKS)
        self._schedule = Schedule(
            links, step_s, back, to, compute_s=compute_s, dropout=dropout, moves_in_flight=moves_in_flight, every=every,
            shares=self._is_shared,
        )  # fmt: skip
        if longest_s > 10:
            warnings.warn(f"delays are of up to {longest_s:g} s: are they in s?", stacklevel=3)
        self.longest_age_s = self._schedule.oldest_seen * step_s
        self._ahead = self._schedule.action_delay_rows
        oldest = max(self._schedule.oldest_seen, self._schedule.oldest_acting * every)
        self._kept = max(oldest, self._schedule.oldest_seen + self._ahead) + 2 * every
        self._count, self.row, self._first, self._end = count, 0, 0, 0
        self._seeds = np.random.SeedSequence(seed).spawn(links)
        self._links = np.arange(count) % links if count > links else None
        self._observations: History | None = None
        self._actions: History | None = None
        self._idles: Tree = {}
        self._told: Tree = None
        self._is_begun = False
        self.spare = 0

    def begin(
        self,
        observations: Tree,
        mask: Any = None,
        seed: Sequence[int | None] | None = None,
        line: int = 0,
        actions: Tree = None,
    ) -> Seen | np.ndarray:
        """Begins episodes with these observations; no time passes.

        Parameters
        ----------
        mask : array of bool, optional
            The environments in which episodes begin; by default all.
        seed : sequence of int or None, optional
            One seed per environment, with which the link begins anew, too. None: the link continues.
        line : int
            Index of the vehicle, of several over one link.
        actions : Tree, optional
            Examples of the later actions: needed if pending ones are reported, or observations predicted.
        """
        self.row = -(-self.row // self._every) * self._every
        if not self._is_begun or (seed is not None and any(one is not None for one in seed)):
            if self._is_begun:
                self._forget(self._in_block())  # this row becomes row 0
            for at, one in enumerate((seed or ())[: len(self._seeds)]):
                if one is not None:
                    self._seeds[at] = np.random.SeedSequence(one)
            self._schedule.seed(self._seeds, line)
            # An environment without a later seed continues with other random numbers.
            self._seeds = [spawned(one, _LATER) for one in self._seeds]
            self.row, self._first, self._end, self._is_begun = 0, 0, 0, True
        if self._observations is None:
            self._like = leaf(observations)
            self._xp = namespace(self._like)
            self._maximum = self._xp.maximum
            self._room = self._rows_at_once(observations)
            self._has_room = self.spare > 0 and self._xp is np and self._predict is None
            self._observations = History(observations, self._kept, self._room, self._count, self._has_room)
            self._ages = on(self._like, self._table())
            self._columns = on(self._like, np.arange(self._count))
            links, self._of_links = self._schedule.count, None
            if links < self._count:
                self._of_links = on(self._like, np.arange(-(-self._count // links) * links).reshape(-1, links))
            self._began = self._row(0)
        if self._actions is None and actions is not None:
            self._allocate(actions)
        at = self._in_block()
        mask = on(self._like, np.ones(self._count, dtype=np.bool_) if mask is None else mask)
        self._void(mask, at)
        self._observations.put_where(mask.nonzero()[0] if self._xp is np else mask, at, observations)
        return self._look(at)

    def acting(self, actions: Tree = None) -> Tree:
        """Takes the actions decided at the beginning of a step; returns those that act in it.

        Parameters
        ----------
        actions : Tree, optional
            The decided actions; None in the steps between two decisions.
        """
        if not self._is_begun:
            raise RuntimeError("expected reset, or begin of a Delay, before the first step")
        at = self.row - self._first
        if actions is not None:
            if type(actions) is not np.ndarray or self._xp is not np:
                actions = each(lambda one: on(self._like, one), actions)
            if self._actions is None:
                self._allocate(actions)
            self._actions.put(at + 1, actions)
            if self._pending:
                newest = actions if self._encode is None else self._encode(actions)
                if self._has_room:  # then they are one array
                    self._told.add(newest)
                else:
                    each(lambda told, one: told.add(one), self._told, newest)
        if self._is_shared:
            return self._mean(at)
        rows = self._actions.rows
        return rows.take(self._newest[1], 0) if type(rows) is np.ndarray else self._actions.take(self._newest[1])

    def seen(self, observations: Tree, began: Any = None) -> Seen | np.ndarray:
        """Takes the observations after a step; returns the policy's input.

        Parameters
        ----------
        began : array of bool, optional
            The environments in which this step began a new episode, of which the observation is the first.
        """
        self.row += 1
        at = self.row - self._first if self.row < self._end else self._in_block()
        if began is not None:
            self._void(began if type(began) is np.ndarray and self._xp is np else on(self._like, began), at)
        self._observations.put(at, observations)
        return self._look(at)

    def _void(self, flags: Any, at: int) -> None:
        """Begins episodes: earlier decisions are void, and the idle action replaces the last one."""
        if type(flags) is np.ndarray:
            which = flags.nonzero()[0]
            if not which.size:
                return
            places = which + (at + self._kept) * self._count
            self._began[which] = places
        else:
            which, places = flags, None
            self._began = self._xp.where(flags, self._row(at), self._began)
        if self._actions is not None:
            if places is not None and type(self._idles) is np.ndarray:
                self._actions.rows[places] = self._idles[which]
            else:
                self._actions.put_where(which, at, self._idles)
            if self._pending and self._has_room:
                self._told.void(which)
            elif self._pending:
                each(lambda told: told.void(which), self._told)

    def _look(self, at: int) -> Seen | np.ndarray:
        arrived = self._arrived[at]
        if self._of_links is not None:  # environments beyond the links share them in turns
            arrived = (arrived + self._of_links).reshape(2, -1)[:, : self._count]
        self._newest = self._maximum(arrived, self._began)
        newest = self._newest[0]
        # The table ends with ages of 0: those of this row.
        ages = self._ages[(self._room - 1 - at) * self._count :]
        has = arrived[0] >= self._began if self._is_zero else None
        if self._has_room:
            return self._joined(newest, ages, has)
        observation = self._observations.take(newest)
        if has is not None:
            observation = each(lambda one: self._xp.where(beside(has, one), one, self._xp.zeros_like(one)), observation)
        if self._predict is not None:
            observation = self._predicted(observation, (self._row(at) - newest) // self._count, at)
        age_s = ages.take(newest) if self._xp is np else ages[newest]
        return Seen(observation, age_s, each(lambda told: told.by_environment(), self._told) if self._pending else None)

    def _joined(self, newest: np.ndarray, ages: np.ndarray, has: np.ndarray | None) -> np.ndarray:
        """The observation, its age and the pending decisions as one matrix, of which each column is contiguous."""
        columns = self._observations.rows.T
        width = len(columns)
        joined = np.empty((width + self.spare, self._count), columns.dtype)
        columns.take(newest, 1, joined[:width], "clip")  # else ``out`` is copied
        if has is not None:
            joined[:width, ~has] = 0
        if ages.dtype != joined.dtype:
            self._ages = self._table().astype(joined.dtype)
            ages = self._ages[-len(ages) :]
        ages.take(newest, 0, joined[width], "clip")
        if self._pending:
            joined[width + 1 :] = self._told.columns()
        return joined.T

    def _table(self) -> Any:
        """Ages by history index, at the last row."""
        return np.repeat(np.arange(self._kept + self._room)[::-1] * self.step_s, self._count)

    def _row(self, at: Any) -> Any:
        """The history indices of this row."""
        return self._columns + (at + self._kept) * self._count

    def _predicted(self, observation: Tree, lag: Any, at: int) -> Tree:
        newest = -(-at // self._every) - 1
        for step in range(int(self._most[at]) + self._ahead):
            chosen = ((at - lag + step - self._ahead) // self._every).clip(None, newest) * self._every
            places = self._maximum(self._row(chosen + 1), self._began)
            later = self._predict(observation, self._actions.take(places))
            goes = step < lag + self._ahead
            observation = each(lambda old, new: self._xp.where(beside(goes, old), new, old), observation, later)
        return observation

    def _mean(self, at: int) -> Tree:
        """The mean of the actions in force during a step."""
        shares, left = [], 1.0
        for lag, weight in enumerate(self._weights[at]):
            counts = self._row(at - lag * self._every) >= self._began
            shares.append(self._xp.where(counts, weight if self._links is None else weight[self._links], 0.0))
            left = left - shares[-1]
        chosen = at - at % self._every
        rows = [self._actions.row(chosen - lag * self._every + 1) for lag in range(len(shares))]

        def mean(idle: Any, *ones: Any) -> Any:
            total = beside(left, idle) * idle
            for share, one in zip(shares, ones):
                total = total + beside(share, one) * one
            return cast(total, ones[0].dtype)

        return each(mean, self._idles, *rows)

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
        self._actions = History(self._idles, self._kept, self._room + 1, self._count)
        if self._pending and self._xp is np and isinstance(self._encode, OneHot):
            self._told, self._encode = PendingOneHot(self._idles, self._pending, self._encode), None
        elif self._pending:
            idles = self._idles if self._encode is None else self._encode(self._idles)
            kind = Pending if self._xp is np else PendingElsewhere
            self._told = each(lambda one: kind(one, self._pending), idles)

    def _rows_at_once(self, observations: Tree) -> int:
        """How many rows histories take before old ones are forgotten."""
        sizes = [48 * self._count]  # of the indices
        each(lambda one: sizes.append(one.nbytes), observations)
        # Arrays of JAX are copied as a whole at each change.
        is_copied = self._xp is not np and not hasattr(self._like, "is_cuda")
        fit = 0 if is_copied else _BYTES // sum(sizes)
        rows = max(min(fit, _ROWS), self._kept)
        return -(-min(rows, self._schedule.rows) // self._every) * self._every

    def _in_block(self) -> int:
        """The index of this row in the block; makes the next block if the last one is over."""
        while self.row >= self._end:
            self._forget(self._end - self._first)
            self._first = self._end
            self._make_block()
        return self.row - self._first

    def _forget(self, rows: int) -> None:
        if rows and self._observations is not None:
            self._observations.forget(rows)
            if self._actions is not None:
                self._actions.forget(rows)
            # An episode may be older than the kept rows; bounded, so that it fits 32 bits.
            self._began = (self._began - rows * self._count).clip(-4 * MOST_ROWS * self._count)

    def _make_block(self) -> None:
        """Uploads the link's behaviour in the next rows: where rows of seen observations and acting actions begin."""
        schedule, at = self._schedule, self._schedule.row(self._first)
        rows = min(self._room, schedule.rows - at)
        self._end, block = self._first + rows, slice(at, at + rows)
        numbers = np.arange(rows, dtype=np.int32)[:, None]
        # An action is stored a row after its decision, since the row in which an episode begins holds the idle one.
        first = np.empty((rows, 2, schedule.count), np.int32)
        np.subtract(numbers + self._kept, schedule.seen[block], out=first[:, 0])
        np.multiply(schedule.acts[block], np.int32(-self._every), out=first[:, 1])
        first[:, 1] += numbers - numbers % self._every + (self._kept + 1)
        first *= self._count
        if self._of_links is None:
            first += np.arange(self._count, dtype=np.int32)
        else:
            first = first[:, :, None]
        self._arrived = list(on(self._like, first.astype(np.intp)))
        self._most = schedule.seen[block].max(1)
        self._weights = on(self._like, schedule.weights[block]) if self._is_shared else None
