"""Skein's commands as functions; their tables are data frames."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, nullcontext
from pathlib import Path
from typing import Any

import pandas as pd

from . import arguments
from .errors import SkeinError
from .installation import find
from .places import plainly
from .policies import Policy, PolicyServer
from .progress import Progress
from .results import Budget, Flights, Found, Tables
from .scenario import Scenario
from .seeds import folded
from .tables import frame

#: Deadline of policies in Python in real time.
_DEADLINE_MS = 20.0


@plainly
def fly(
    scenario: Scenario | str | os.PathLike[str] | None = None,
    *,
    loop: str | Iterable[str] | None = None,
    link: str | Iterable[str] | None = None,
    duration_s: float | None = None,
    seed: int | None = None,
    clock: str = "virtual",
    settings: Mapping[str, Any] | None = None,
    policy: str | os.PathLike[str] | None = None,
    pursuer: Policy | None = None,
    evader: Policy | None = None,
    turn_rate_rad_per_s: float | None = None,
    deadline_ms: float | None = None,
    out: str | os.PathLike[str] | None = None,
    verbose: bool = False,
    **options: Any,
) -> Flights:
    """Flies a scenario under each loop over each link.

    Parameters
    ----------
    scenario : Scenario, str or path, optional
        A scenario written in Python (`skein_uav.scenario`), its file, or a name: ``surround``, ``formation``,
        ``crossing``, ``forest``, ``convoy``, ``shadow``, ``blind-pursuit``; by default the paper's duel. The file of a
        scenario written in Python is saved with the results.
    loop : str or iterable of str, optional
        ``paused``, ``sequential``, ``futures``, ``stream`` (the default), ``predictive`` or ``plan``.
    link : str or iterable of str, optional
        A latency profile: ``none``, ``direct`` (the default), ``vpn``, ``constant:200ms``, …
    duration_s : float, optional
        Duration of each flight, s; by default 60 s, or that of a scenario in Python.
    seed : int, optional
        Seed of every random choice, of any size, by default 1. In virtual time, equal seeds give equal flights, to the
        last bit.
    clock : str
        ``virtual`` (many times faster) or ``real``.
    settings : mapping, optional
        Settings of the scenario, for example ``{"ring-m": 10}``.
    policy : path, optional
        A policy file, as `search` writes one, or an ONNX file of another framework.
    pursuer, evader : callable, optional
        A policy written in Python: takes an observation, ndarray of float32 of shape (9,), and returns a number from
        -1 to 1, as in `skein_uav.environments`. All flights call it on one thread while they run. It must not count
        its calls: a rehearsal before live flights calls it, too.

        Each of `policy`, `pursuer` and `evader` has flights of its own, in which all other vehicles use the scenario's
        policies. Without any of them, only the scenario's own policies are used.
    turn_rate_rad_per_s : float, optional
        Greatest turn rate of `pursuer` and `evader`, as in `skein_uav.environments.PursuitVectorEnv`: a policy needs the
        one that it was trained with. By default 1 rad/s; an evader's answers are immediate turns.
    deadline_ms : float, optional
        Time within which a policy must decide, ms; if it has not, or has failed, ``fallback`` decides (``hold``,
        ``repeat`` or a policy's name), and the recording states it. The default is 20 ms for a policy in Python with
        ``clock="real"``; else flights wait for policies, at most 10 s. In virtual time the clock stands still meanwhile.
        The loop ``paused`` has no deadline.
    out : path, optional
        Folder for recordings and report; by default a new temporary one.
    verbose : bool
        Shows the command's progress on ``stderr``: a bar where tqdm is installed, else the lines that it prints.
    **options
        Any other option of ``./skein fly``, for example ``moves_in_flight=6``. With ``config``, loop, link, duration and
        seed are by default those of the file.

    Returns
    -------
    Flights

    Raises
    ------
    SkeinError
        If the command failed; with its error output. If flights were recorded before, it says where.
    """
    arguments.renamed("fly", options, duration="duration_s", deadline="deadline_ms", set="settings")
    planned = arguments.planned(loop, link, duration_s, scenario, options)
    if turn_rate_rad_per_s is not None and pursuer is None and evader is None:
        raise TypeError("turn_rate_rad_per_s: expected with a pursuer or an evader in Python")
    if seed is None and options.get("config") is None:
        seed = 1
    with ExitStack() as served:
        folder = served.enter_context(arguments.folder(out))
        given = [(role, one) for role, one in (("pursuer", pursuer), ("evader", evader)) if one is not None]
        policies: list[Any] = [
            served.enter_context(PolicyServer(one, role, turn_rate_rad_per_s)).option for role, one in given
        ]
        if given and clock == "real" and deadline_ms is None:
            deadline_ms = _DEADLINE_MS
        printed = _ran(
            "fly",
            **planned,
            seed=None if seed is None else folded(seed),
            clock=clock,
            scenario=arguments.scenario_file(scenario, folder),
            set=arguments.set_to(settings),
            policy=[policy, *policies],
            only_policies=policy is not None or bool(policies),
            deadline=None if deadline_ms is None else arguments.milliseconds("deadline_ms", deadline_ms, "ms"),
            out=folder,
            verbose=verbose,
            **options,
        )
    recordings = [folder / Path(one).name for one in printed["recordings"]]
    return Flights(_tables(printed), recordings, folder / "report.html")


@plainly
def spread(
    scenario: Scenario | str | os.PathLike[str] | None = None,
    *,
    loop: str | Iterable[str] | None = None,
    link: str | Iterable[str] | None = None,
    seeds: int = 20,
    duration_s: float | None = None,
    settings: Mapping[str, Any] | None = None,
    verbose: bool = False,
    **options: Any,
) -> Tables:
    """Flies each loop over each link many times in virtual time.

    Parameters
    ----------
    seeds : int
        Number of flights for each loop and link.
    loop, link, duration_s, scenario, settings, verbose
        As in `fly`.
    **options
        Any other option of ``./skein spread``; ``config`` as in `fly`.

    Returns
    -------
    dict of str to DataFrame
        Mean and spread over the seeds, by title; units are in the columns' names.
    """
    arguments.renamed("spread", options, duration="duration_s", set="settings")
    planned = arguments.planned(loop, link, duration_s, scenario, options)
    with tempfile.TemporaryDirectory(prefix="skein-") as folder:
        return run(
            "spread",
            **planned,
            seeds=seeds,
            scenario=arguments.scenario_file(scenario, Path(folder)),
            set=arguments.set_to(settings),
            verbose=verbose,
            **options,
        )


@plainly
def search(
    scenario: Scenario | str | os.PathLike[str] | None = None,
    *,
    family: str | None = None,
    link: str = "vpn",
    candidates: int | None = None,
    episodes: int | None = None,
    settings: Mapping[str, Any] | None = None,
    vary: Mapping[str, tuple[float, float]] | None = None,
    out: str | os.PathLike[str] | None = None,
    verbose: bool = False,
    **options: Any,
) -> Found:
    """Looks for the best of many policies by forward simulation under a loop's real timing.

    Parameters
    ----------
    scenario : Scenario, str or path, optional
        The scenario whose settings are searched, instead of a duel's policy; as in `fly`.
    family : str, optional
        Family of the policies to choose from: ``paper-pursuer`` by default, ``lead-pursuit``, ``neural:8x8``, …
    link : str
        A latency profile.
    candidates : int, optional
        Number of candidates to try in all; by default 1000, or 40 of a scenario that flies in virtual time alone.
    episodes : int, optional
        Number of episodes for each candidate; by default 20, or 2 there.
    settings : mapping, optional
        Fixed settings of the scenario.
    vary : mapping, optional
        Settings to search, each with its least and its greatest value; ``ring_m`` and ``ring-m`` are equivalent.
    out : path, optional
        Folder for state, policy and pictures; by default a new temporary one.
    verbose : bool
        Shows the command's progress on ``stderr``: a bar where tqdm is installed, else the lines that it prints.
    **options
        Any other option of ``./skein search``, for example ``objective="0.7*last10s + 0.3*effort"``.

    Returns
    -------
    Found

    Raises
    ------
    KeyboardInterrupt
        If it was interrupted; states how it goes on.
    """
    arguments.renamed("search", options, set="settings")
    with arguments.folder(out) as folder, _goes_on(folder):
        tables = run(
            "search",
            family=family,
            link=link,
            candidates=candidates,
            episodes=episodes,
            scenario=arguments.scenario_file(scenario, folder),
            set=arguments.set_to(settings),
            vary=arguments.varied(vary),
            out=folder,
            verbose=verbose,
            **options,
        )
    policy, landscape = folder / "policy.conf", folder / "landscape.csv"
    return Found(
        next(iter(tables.values())),
        policy if policy.exists() else None,
        pd.read_csv(landscape) if landscape.exists() else None,
        folder,
    )


@contextmanager
def _goes_on(folder: Path) -> Iterator[None]:
    """Says how an interrupted search goes on."""
    try:
        yield
    except KeyboardInterrupt:
        if not (folder / "search.json").exists():
            raise
        best = [file for file in (folder / "policy.conf", folder / "scenario.conf") if file.exists()]
        so_far = f"; the best so far is in {best[0]}" if best else ""
        raise KeyboardInterrupt(f"skein.run('search', resume='{folder}') goes on with this search{so_far}") from None


@plainly
def budget(
    scenario: Scenario | str | os.PathLike[str] | None = None,
    *,
    settings: Mapping[str, Any] | None = None,
    out: str | os.PathLike[str] | None = None,
    verbose: bool = False,
    **options: Any,
) -> Budget:
    """Maps how much latency and jitter a scenario, or a duel's policy, tolerates.

    Parameters
    ----------
    scenario, settings, verbose
        As in `fly`.
    out : path, optional
        Folder for the map's files and picture; by default a new temporary one.
    **options
        Any other option of ``./skein budget``, for example ``objective="off-ring"``.

    Returns
    -------
    Budget
    """
    arguments.renamed("budget", options, set="settings")
    with arguments.folder(out) as folder:
        given = {"scenario": arguments.scenario_file(scenario, folder), "set": arguments.set_to(settings)}
        maps = _ran("budget", **given, out=folder, verbose=verbose, **options)
    return Budget.of(maps, folder)


@plainly
def to_onnx(policy: str | os.PathLike[str], file: str | os.PathLike[str]) -> Path:
    """Writes the network of a policy file as an ONNX file.

    Parameters
    ----------
    policy : path
        A policy file of a family ``neural:…`` or ``learned:…``.
    file : path
        The ONNX file, which is replaced.

    Returns
    -------
    Path
        `file`.

    Raises
    ------
    SkeinError
        If the policy is no network, or the file cannot be written.
    """
    run("policy", os.fspath(policy), onnx=os.fspath(file))
    return Path(file)


@plainly
def run(command: str, *words: str, verbose: bool = False, **options: Any) -> Tables:
    """Runs a command of ``./skein`` and reads the tables that it prints.

    Parameters
    ----------
    command : str
        A command that has ``--json``: ``fly``, ``spread``, ``search``, ``report``, …
    *words : str
        Arguments after the options, such as files.
    verbose : bool
        Shows its progress on ``stderr``.
    **options
        ``moves_in_flight=6`` is ``--moves-in-flight 6``, and ``period_ms=50`` is ``--period 50ms``; a list is the option
        several times, True a bare flag, None no option.

    Returns
    -------
    dict of str to DataFrame

    Raises
    ------
    SkeinError
        If the command failed; with its error output.
    """
    return _tables(_ran(command, *words, verbose=verbose, **options))


def _tables(printed: Mapping[str, Any]) -> Tables:
    return Tables({table["title"]: frame(table) for table in printed["tables"]})


def _ran(command: str, *words: str, verbose: bool = False, **options: Any) -> Any:
    """Runs a command and returns the output of ``--json``."""
    installed = find()
    words = (command, "--json", *arguments.flags(options), *words)
    environment = {**os.environ, "JAVA_HOME": str(installed.java)}
    with tempfile.TemporaryFile() as tables:
        process = subprocess.Popen(
            ["bash", str(installed.launcher), *words],
            stdin=subprocess.DEVNULL,
            stdout=tables,
            stderr=subprocess.PIPE,
            env=environment,
            text=True,
            encoding="utf-8",
        )
        try:
            complained = _heard(process, verbose)
        except BaseException:
            # A notebook interrupts only Python; the command then hovers its vehicles and ends by itself.
            process.send_signal(signal.SIGINT)
            process.wait()
            raise
        if process.returncode != 0:
            reason = _reason(complained) or f"skein {command} ended with status {process.returncode}"
            scenario = options.get("scenario")
            raise SkeinError(scenario.explained(reason) if isinstance(scenario, arguments.WrittenFile) else reason)
        tables.seek(0)
        return json.load(tables)


def _heard(process: subprocess.Popen[str], verbose: bool) -> str:
    """Reads a command's progress and error messages, until it ends."""
    assert process.stderr is not None
    lines = []
    with process.stderr, Progress() if verbose else nullcontext() as progress:
        for line in process.stderr:
            lines.append(line)
            if progress is not None:
                progress.show(line.rstrip("\n"))
    process.wait()
    return "".join(lines)


def _reason(complained: str) -> str:
    """A command's error messages, without its progress."""
    lines = [line for line in complained.splitlines() if line.strip()]
    first = next((number for number, line in enumerate(lines) if line.startswith("skein")), max(len(lines) - 1, 0))
    return "\n".join(lines[first:])
