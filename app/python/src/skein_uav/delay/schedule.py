"""Which observation is seen and which action acts, step by step: this depends on the link, not on the environment.

Delays do not depend on the messages' content. So the schedule is made in advance, in blocks of steps, on the host, and
for all links together; `skein_uav.delay.Delay` applies it to arrays on any device.

A *row* is a step of the wrapped environment, of ``step_s``; row r begins at ``r * step_s``. Row numbers continue over
episodes: the link does not begin anew with them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .profiles import SIZE, Delays

MOST_ROWS = 1000
_BLOCK = 512
_TINY = 1e-6  # of a row: a message due this shortly after its beginning is due at it
_NEVER = 2**15 - 1

Floats = NDArray[np.float64]
Lags = NDArray[np.int16]
Timed = tuple[Floats, "NDArray | None"]
"""Delays in rows; or a table of them, and where each stands in it."""


class Schedule:
    """The schedule of all links, determined by their seeds.

    Parameters
    ----------
    count : int
        Number of links.
    step_s : float
        Duration of a row, s.
    observation, action : Delays
        The two directions. One object for both is one link, whose correlated delays apply to both.
    compute_s : float
        Time from an observation to the departure of the action chosen on it, s.
    dropout : float
        Share of observations and of actions that are lost.
    moves_in_flight : int, optional
        Maximum number of unanswered actions; others wait, and are superseded by newer ones.
    every : int
        Number of rows from one decision to the next.
    shares : bool
        Whether `weights` are computed.

    Attributes
    ----------
    first, rows : int
        The block's first row, and its number of rows.
    seen : ndarray of int16, shape (rows, count)
        Age in rows of the newest observation that has arrived when a row begins.
    acts : ndarray of int16, shape (rows, count)
        Age in decisions of the newest action that has arrived when a row begins; 0: of the last decision.
    weights : ndarray of float64, shape (rows, decisions, count), optional
        The shares of each row in which the newest decision, the one before it, and so on, act.
    oldest_seen, oldest_acting : int
        Maxima of `seen` and `acts`; one more if nothing has arrived yet.
    action_delay_rows : int
        Mean number of rows from a decision to the beginning of the row from which on it acts.
    """

    def __init__(
        self,
        count: int,
        step_s: float,
        observation: Delays,
        action: Delays,
        *,
        compute_s: float = 0.0,
        dropout: float = 0.0,
        moves_in_flight: int | None = None,
        every: int = 1,
        shares: bool = False,
    ) -> None:
        self.count, self.every = count, every
        self.rows = max(_BLOCK // every, 1) * every
        self._moves, self._compute, self._dropout = moves_in_flight, compute_s / step_s, dropout
        # This many losses in a row have a probability of 10^-9.
        self._most_lost = math.ceil(-9 / math.log10(dropout)) if dropout else 0
        to, back = self._compute + action.longest_s / step_s, observation.longest_s / step_s
        if moves_in_flight is not None:
            to = 2 * to + back + every + 1
        self.oldest_seen = math.ceil(back - _TINY) + self._most_lost
        self.oldest_acting = math.ceil(to / every - _TINY) + self._most_lost
        if max(self.oldest_seen, self.oldest_acting * every) > MOST_ROWS:
            raise ValueError(
                f"expected delays of at most {MOST_ROWS} steps of {step_s:g} s, got up to "
                f"{observation.longest_s:g} s for observations and {action.longest_s:g} s for actions"
            )
        self.action_delay_rows = round(action.mean_of(lambda delay: np.ceil(delay / step_s + self._compute - _TINY)))
        self._back = _Direction(observation, count, step_s, lines=1 if moves_in_flight is None else 2)
        self._to = _Direction(action, count, step_s, lines=1, link=self._back if action is observation else None)
        self._is_exact = shares or moves_in_flight is not None
        self._is_constant = action.is_constant and observation.is_constant and not (dropout or self._is_exact)
        self._shares = shares

    def seed(self, seeds: Sequence[np.random.SeedSequence], line: int = 0) -> None:
        """Begins anew at row 0.

        Parameters
        ----------
        seeds : sequence of SeedSequence
            One per link; equal seeds give equal delays.
        line : int
            Index of the vehicle, of several over one link: correlated delays and the link's state are common to all.
        """
        self._links = [np.random.default_rng(spawned(seed, 0)) for seed in seeds]
        self._lines = [np.random.default_rng(spawned(seed, line + 1)) for seed in seeds]
        self._back.seed(self._links)
        self._to.seed(self._links)
        count, long_ago = self.count, -math.inf
        self._lost = np.zeros((2, count), dtype=np.int64)
        self._before = np.zeros((self.oldest_acting + 1, count), np.int16)
        self._arrived, self._answered = np.full(count, long_ago), np.full(count, long_ago)
        self._answers = np.full(((self._moves or 2) - 1, count), long_ago)
        self._underway = [np.full((oldest, count), _NEVER, np.int16) for oldest in (self.oldest_seen, self.oldest_acting)]
        self._past = np.full((self.oldest_acting + 1, count), math.inf)
        self.first = 0
        self._make()

    def row(self, row: int) -> int:
        """The index of a row in the block, which is replaced if it ends before; rows must ascend."""
        while row >= self.first + self.rows:
            self.first += self.rows
            self._make()
        return row - self.first

    def _make(self) -> None:
        if self._is_constant and self.first - self.rows >= max(self.oldest_seen, self.oldest_acting * self.every):
            return  # the last block began after the first messages' arrival, and another one is like it
        decided = slice(None, None, self.every)
        kinds = [one.draws + (self._dropout > 0) for one in (self._back, self._to)]
        drawn = _drawn(self._lines, self.rows, kinds)
        back, back_lost = self._back.block(self.first, self.rows, self._links, drawn[0], self._dropout)
        (to,), to_lost = self._to.block(self.first, self.rows, self._links, drawn[1], self._dropout)
        to_lost = None if to_lost is None else to_lost[decided]
        self.seen = self._newest(0, self._kept(0, _whole(back[0]), back_lost), 1)
        if not self._is_exact:
            late = self._kept(1, _whole(to, self._compute)[decided], to_lost)
            self.acts = self._newest(1, self._in_order(late), self.every)
            return
        chosen = np.arange(0.0, self.rows, self.every)[:, None]
        leaves = chosen + self._compute
        if self._moves is None:
            arrives = self._in_exact_order(self._kept(1, leaves + _exact(to)[decided], to_lost))
        else:
            arrives = self._paced(leaves, _exact(to)[decided], _exact(back[1])[decided])
        arrives = _snapped(arrives)
        self.acts = self._newest(1, _whole((np.minimum(arrives - chosen, _NEVER), None)), self.every)
        self.weights = self._weights(arrives) if self._shares else None

    def _kept(self, line: int, late: NDArray, lost: NDArray[np.bool_] | None) -> NDArray:
        """Lost messages never arrive; limits the number of losses in a row."""
        if lost is None:
            return late
        numbers = np.arange(len(lost))[:, None]
        since = numbers - np.maximum.accumulate(np.where(lost, -1 - self._lost[line], numbers), axis=0)
        since %= self._most_lost + 1
        self._lost[line] = since[-1]
        return np.where(since > 0, math.inf if late.dtype == np.float64 else _NEVER, late)

    def _in_order(self, late: Lags) -> Lags:
        """No action overtakes another: an action's lateness, in rows, may be due to those before it."""
        lost = late == _NEVER if self._most_lost else None
        all = np.concatenate([self._before, late if lost is None else np.where(lost, 0, late)])
        reach = 1
        while reach < len(self._before):  # the reach doubles each time
            np.maximum(all[reach:], all[:-reach] - np.int16(reach * self.every), out=all[reach:])
            reach *= 2
        self._before = all[len(late) :]
        late = all[len(self._before) :]
        return late if lost is None else np.where(lost, np.int16(_NEVER), late)

    def _in_exact_order(self, arrives: Floats) -> Floats:
        last = self._arrived
        for one in arrives:
            lost = np.isinf(one)
            np.maximum(one, last, out=one, where=~lost)
            last = np.where(lost, last, one)
        self._arrived = last - self.rows
        return arrives

    def _paced(self, leaves: Floats, to: Floats, answer: Floats) -> Floats:
        """An action is sent once the one ``moves_in_flight`` before it is answered, unless a newer one is chosen first.

        An action is answered when its successor arrives; the newest is not answered.
        """
        arrives = np.full_like(to, math.inf)
        for number, chosen in enumerate(leaves[:, 0]):
            leave = np.maximum(chosen, self._answers[0])
            goes = leave < chosen + self.every
            at = np.maximum(self._arrived, leave + to[number])
            answered = np.where(np.isinf(self._arrived), -math.inf, np.maximum(self._answered, at + answer[number]))
            arrives[number] = np.where(goes, at, math.inf)
            self._arrived = np.where(goes, at, self._arrived)
            self._answered = np.where(goes, answered, self._answered)
            self._answers = np.where(goes, np.concatenate([self._answers[1:], answered[None]]), self._answers)
        self._arrived -= self.rows
        self._answered -= self.rows
        self._answers -= self.rows
        return arrives

    def _newest(self, line: int, late: Lags, every: int) -> Lags:
        """Age of the newest arrived message, row by row, by the messages' lateness in rows."""
        oldest = len(self._underway[line])
        all = np.concatenate([self._underway[line], late])
        self._underway[line] = all[len(all) - oldest :]
        newest = np.empty((len(late) * every, self.count), np.int16)
        least = int(all.min()) // every
        is_late, beyond = np.empty(late.shape, np.bool_), np.empty_like(late)
        for offset in range(every):
            # How much older than `lag` the newest is, from lag to lag.
            beyond[...] = 0
            for lag in range(oldest, least - 1, -1):
                np.greater(all[oldest - lag : oldest - lag + len(late)], lag * every + offset, out=is_late)
                beyond += 1
                beyond *= is_late
            newest[offset::every] = beyond
        newest += least
        return newest

    def _weights(self, arrives: Floats) -> Floats:
        past = len(self._past)
        begins = np.concatenate([self._past, arrives])
        ends = np.full_like(begins, math.inf)
        ends[:-1] = np.minimum.accumulate(begins[::-1], axis=0)[::-1][1:]
        self._past = begins[-past:] - self.rows
        row = np.arange(self.rows)
        newest = row // self.every + past
        weights = np.empty((self.rows, past, self.count))
        for lag in range(past):
            begin, end = begins[newest - lag], ends[newest - lag]
            weights[:, lag] = np.maximum(np.minimum(end, row[:, None] + 1.0) - np.maximum(begin, row[:, None]), 0)
        return weights


class _Direction:
    """Delays of one direction; of the other one as well, if they apply to both.

    Parameters
    ----------
    lines : int
        Number of messages per row.
    link : _Direction, optional
        The direction whose state it shares.
    """

    def __init__(self, delays: Delays, count: int, step_s: float, lines: int, link: _Direction | None = None) -> None:
        self._delays, self._count, self._step_s, self._lines, self._link = delays, count, step_s, lines, link
        self.draws = 0 if delays.is_constant or delays.trace is not None or delays.correlation_s else lines
        if delays.trace is not None and delays.trace.ndim == 2 and delays.trace.shape[1] != count:
            raise ValueError(
                f"expected delays of shape (times,) or (times, environments = {count}), got {delays.trace.shape}"
            )

    def seed(self, links: list[np.random.Generator]) -> None:
        self._last: dict[str, NDArray[np.float32]] = {}
        trace = self._delays.trace
        if trace is not None and self._link is None:
            self._begin = np.array([0 if trace.ndim == 2 else one.integers(len(trace)) for one in links])

    def block(
        self,
        first: int,
        rows: int,
        links: list[np.random.Generator],
        drawn: NDArray[np.uint16],
        dropout: float,
    ) -> tuple[list[Timed], NDArray[np.bool_] | None]:
        """The delays of each line, and which of the first line's messages are lost, shape (rows, count).

        Parameters
        ----------
        drawn : ndarray, shape (draws, rows, count)
            Random numbers below 2**16, with an additional draw if messages can be lost.
        """
        delays, h = self._delays, self._step_s
        lost = drawn[-1] < round(dropout * 2**16) if dropout else None
        if delays.trace is not None:
            begin = self._begin if self._link is None else self._link._begin
            share = h / (delays.every_s or h)
            at = (np.arange(first, first + rows)[:, None] * share + _TINY + begin).astype(np.int64)
            at %= len(delays.trace)
            values = delays.trace[at] if delays.trace.ndim == 1 else delays.trace[at, np.arange(self._count)]
            return [(values / h, None)] * self._lines, lost
        if delays.is_constant:
            at = np.broadcast_to(np.intp(0), (rows, self._count))
            return [(delays.busy[:1] / h, at)] * self._lines, lost
        if self._link is None:
            self._held, self._is_busy = None, None
            if delays.correlation_s:
                self._held = (self._state("held", links, rows, delays.correlation_s) * SIZE).astype(np.int64)
            if delays.mixing_s:
                self._is_busy = self._state("busy", links, rows, delays.mixing_s) < delays.busy_share
        state = self._link or self
        told = []
        for line in range(self._lines):
            at = drawn[line] & (SIZE - 1) if state._held is None else state._held
            if state._is_busy is not None:
                at = np.where(state._is_busy, at, at + np.asarray(SIZE, at.dtype))
            told.append((np.concatenate([delays.busy, delays.quiet]) / h, at))
        return told, lost

    def _state(
        self, name: str, links: list[np.random.Generator], rows: int, over_s: float
    ) -> NDArray[np.float32]:
        """A number that is drawn anew after exponentially distributed times of this mean, read once per row."""
        uniform = np.stack([one.random((rows, 2), dtype=np.float32) for one in links])
        is_new = uniform[:, :, 0] < -math.expm1(-self._step_s / over_s)
        last = self._last.get(name)
        if last is not None:
            uniform[:, 0, 1] = np.where(is_new[:, 0], uniform[:, 0, 1], last)
        is_new[:, 0] = True
        begins = is_new.ravel().nonzero()[0]
        held = np.repeat(uniform[:, :, 1].ravel()[begins], np.diff(begins, append=is_new.size)).reshape(-1, rows).T
        self._last[name] = held[-1]
        return np.ascontiguousarray(held)


def _exact(delays: Timed) -> Floats:
    rows, at = delays
    return rows if at is None else rows[at]


def _whole(delays: Timed, more: float = 0.0) -> Lags:
    """Number of rows after which a message has arrived that was sent `more` of a row later."""
    rows, at = delays
    lags = np.ceil(rows + more - _TINY).astype(np.int16)
    return lags if at is None else lags.take(at)


def _snapped(rows: Floats) -> Floats:
    """Moves times within a millionth of a row of a row's beginning to that beginning."""
    whole = np.rint(rows)
    with np.errstate(invalid="ignore"):
        return np.where(np.abs(rows - whole) < _TINY, whole, rows)


def _drawn(generators: list[np.random.Generator], rows: int, kinds: list[int]) -> list[NDArray[np.uint16]]:
    """Random numbers below 2**16, each of shape (kinds, rows, generators)."""
    words, count = [-(-rows * one // 4) for one in kinds], len(generators)
    raw = np.concatenate([one.bit_generator.random_raw(sum(words)) for one in generators]).reshape(count, -1)
    # By whole words first: single numbers would be scattered in memory.
    parts = np.ascontiguousarray(raw.T).astype("<u8", copy=False).view("<u2").reshape(-1, count, 4)
    numbers = np.ascontiguousarray(parts.swapaxes(1, 2)).reshape(-1, count)
    ends = np.cumsum(words) * 4
    return [
        numbers[end - 4 * size :][: rows * one].reshape(rows, one, count).swapaxes(0, 1)
        for one, size, end in zip(kinds, words, ends)
    ]


def spawned(seed: np.random.SeedSequence, number: int) -> np.random.SeedSequence:
    """A seed that is independent of this one, and of others spawned from it."""
    return np.random.SeedSequence(seed.entropy, spawn_key=(*seed.spawn_key, number))
