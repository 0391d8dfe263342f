"""Delays of messages over one direction of a link.

A profile is a text, as for Skein's ``--link``. It states round trips; one direction takes half of one:

* ``none``; ``direct``, about 36 ms; ``vpn``, 20 to 200 ms; ``vpn-mixed``, ``vpn`` and ``direct`` in turns;
* ``constant:200ms``, ``uniform:10ms..40ms``, ``lognormal:36ms,0.3`` (median, deviation of the logarithm);
* ``file:PATH``, round trips in ms, one per line;
* ``correlated:250ms,PROFILE``: one sample applies to both directions, and is drawn anew after exponentially
  distributed times with this mean, so that the correlation of delays falls as e^(-t/250 ms).

``direct`` and ``vpn`` are quantiles of the samples that Böhm and Singh measured. As in Skein's forward simulation, a
distribution is 1024 equally likely values, each the middle of a 1024th. Python's tests compare them with Skein's source.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

SIZE = 1024
LONGEST_S = 3600.0

_PUBLISHED = np.array([0, 1, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 95, 99, 100]) / 100
_DIRECT_MS = [17.8, 20.8, 22.4, 23.8, 26.1, 28.2, 31.2, 35.9, 40.1, 44.0, 47.6, 51.3, 53.8, 58.3, 85.4]
_VPN_MS = [38.3, 53.7, 64.8, 74.2, 81.3, 87.2, 94.9, 99.4, 106.3, 113.2, 124.8, 137.9, 148.2, 165.5, 207.4]
_BUSY_S, _QUIET_S = 40.0, 55.0
_MIDDLES = (np.arange(SIZE) + 0.5) / SIZE
_TIME = re.compile(r"\s*(\d+(?:\.\d+)?)\s*(us|ms|s)\s*")
_FORMS = (
    "none, direct, vpn, vpn-mixed, constant:200ms, uniform:10ms..40ms, lognormal:36ms,0.3, file:PATH "
    "or correlated:250ms,PROFILE"
)


@dataclass(frozen=True)
class Trace:
    """Measured one-way delays in their order, repeated.

    Parameters
    ----------
    delays_s : array of float, shape (times,) or (times, environments)
        Delays in s. With one axis, each environment begins at a random index; with two, at the beginning of its own.
    every_s : float, optional
        Time from one delay to the next, s; by default a step of the environment.
    """

    delays_s: NDArray[np.float64]
    every_s: float | None = None


@dataclass(frozen=True)
class Delays:
    """One direction of a link.

    Attributes
    ----------
    busy, quiet : ndarray of float64, shape (1024,)
        Equally likely one-way delays, ascending, s, in the link's two states; equal if it has only one state.
    busy_share : float
        Share of the time in which the link is busy.
    mixing_s : float
        Time after which the correlation of the link's state has fallen to 1/e, s; 0: it has one state.
    correlation_s : float
        Time after which the correlation of delays has fallen to 1/e, s; 0: delays are independent.
    trace : ndarray of float64, shape (times,) or (times, environments), optional
        Delays in s that replace all of these.
    every_s : float, optional
        Time from one delay of the trace to the next, s.
    """

    busy: NDArray[np.float64]
    quiet: NDArray[np.float64]
    busy_share: float = 1.0
    mixing_s: float = 0.0
    correlation_s: float = 0.0
    trace: NDArray[np.float64] | None = None
    every_s: float | None = None

    @property
    def longest_s(self) -> float:
        return float(max(self.busy[-1], self.quiet[-1]) if self.trace is None else self.trace.max())

    def mean_of(self, function: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> float:
        """The mean of a function of the delay in s."""
        if self.trace is not None:
            return float(function(self.trace).mean())
        busy, quiet = function(self.busy).mean(), function(self.quiet).mean()
        return float(self.busy_share * busy + (1 - self.busy_share) * quiet)

    @property
    def is_constant(self) -> bool:
        return self.trace is None and self.busy[0] == self.busy[-1] == self.quiet[0] == self.quiet[-1]


def delays(given: str | float | ArrayLike | Trace | Delays, what: str = "delays") -> Delays:
    """One direction of a link, by a profile's text, a constant in s, an array of delays in s, or a `Trace`.

    Raises
    ------
    ValueError
        If the argument is invalid; states what was expected and what was given.
    """
    if isinstance(given, Delays):
        return given
    if isinstance(given, str):
        return _parsed(given, what)
    trace = given if isinstance(given, Trace) else Trace(given)
    try:
        values = np.asarray(trace.delays_s, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{what}: expected a profile, a number or array of s, or a Trace, got {_short(given)}") from None
    if values.ndim > 2 or values.size == 0 or not np.all((values >= 0) & (values <= LONGEST_S)):
        raise ValueError(
            f"{what}: expected delays in s from 0 to {LONGEST_S:g}, as one number or of shape (times,) or (times, "
            f"environments), got {_short(given)}"
        )
    if trace.every_s is not None and not 0 < trace.every_s < math.inf:
        raise ValueError(f"{what}: expected more than 0 s from one delay to the next, got {trace.every_s!r}")
    if values.ndim == 0:
        return _steady(np.full(SIZE, float(values)))
    none = np.zeros(SIZE)
    return Delays(none, none, trace=values, every_s=trace.every_s)


def _short(given: Any) -> str:
    text = " ".join(repr(given).split())
    return text if len(text) < 100 else text[:97] + "..."


def _steady(one_way_s: NDArray[np.float64]) -> Delays:
    return Delays(one_way_s, one_way_s)


def _quantiles(shares: ArrayLike, round_trips_ms: ArrayLike) -> NDArray[np.float64]:
    return np.interp(_MIDDLES, shares, round_trips_ms) / 2000


_DIRECT, _VPN = _quantiles(_PUBLISHED, _DIRECT_MS), _quantiles(_PUBLISHED, _VPN_MS)
_NAMED = {
    "none": _steady(np.zeros(SIZE)),
    "direct": _steady(_DIRECT),
    "vpn": _steady(_VPN),
    "vpn-mixed": Delays(_VPN, _DIRECT, _BUSY_S / (_BUSY_S + _QUIET_S), 1 / (1 / _BUSY_S + 1 / _QUIET_S)),
}


def _parsed(text: str, what: str) -> Delays:
    kind, _, rest = text.partition(":")
    if text in _NAMED:
        return _NAMED[text]
    if kind == "correlated" and "," in rest:
        over, _, latency = rest.partition(",")
        if latency.startswith("correlated:"):
            raise ValueError(f"{what}: expected one time constant, got {text!r}")
        seconds = _seconds(over, what)
        if seconds == 0:
            raise ValueError(f"{what}: expected a time constant of more than 0, got {over!r}")
        one = _parsed(latency, what)
        return Delays(one.busy, one.quiet, one.busy_share, one.mixing_s, seconds)
    if kind == "constant":
        return _steady(np.full(SIZE, _seconds(rest, what) / 2))
    if kind == "uniform" and ".." in rest:
        least, most = (_seconds(one, what) for one in rest.split("..", 1))
        if least > most:
            raise ValueError(f"{what}: expected the smaller time first, got {rest!r}")
        return _steady((least + (most - least) * _MIDDLES) / 2)
    if kind == "lognormal" and "," in rest:
        median, sigma = rest.split(",", 1)
        if not re.fullmatch(r"\s*\d+(\.\d+)?\s*", sigma) or not 0 <= float(sigma) <= 3:
            raise ValueError(f"{what}: expected a standard deviation of the logarithm from 0 to 3, got {sigma!r}")
        normal = np.array([NormalDist().inv_cdf(share) for share in _MIDDLES])
        return _steady(_seconds(median, what) * np.exp(float(sigma) * normal) / 2)
    if kind == "file":
        return _read(rest, what)
    if kind == "rate":
        raise ValueError(f"{what}: expected a link without a rate, since messages have no size here, got {text!r}")
    raise ValueError(f"{what}: expected {_FORMS}, got {text!r}")


def _seconds(text: str, what: str) -> float:
    match = _TIME.fullmatch(text)
    seconds = float(match[1]) * {"us": 1e-6, "ms": 1e-3, "s": 1.0}[match[2]] if match else -1.0
    if not 0 <= seconds <= LONGEST_S:
        raise ValueError(f"{what}: expected a time such as 200ms, of at most an hour, got {text!r}")
    return seconds


def _read(path: str, what: str) -> Delays:
    samples = []
    for number, line in enumerate(Path(path).read_text().splitlines(), 1):
        if line.strip() and not line.strip().startswith("#"):
            try:
                samples.append(float(line))
            except ValueError:
                samples.append(math.nan)
            if not 0 <= samples[-1] <= LONGEST_S * 1000:
                raise ValueError(f"{what}: expected a round trip in ms in line {number} of {path}, got {line!r}")
    if not samples:
        raise ValueError(f"{what}: expected round trips in ms in {path}, got none")
    return _steady(_quantiles(np.linspace(0, 1, len(samples)), np.sort(samples)))
