# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many terrains by one recipe, as `thalweg make --ensemble` makes them."""
from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Any

from thalweg import _networks, _show
from thalweg import members as ensembles
from thalweg._terrain import Terrain, _recipe_of


class Member:
    """A member of an ensemble.

    Attributes
    ----------
    number : int
        From 0.
    seed : int
        That of the recipe plus the number.
    keys : dict
        What varies, with this member's value as a recipe has it.
    status : str
        "ok", "check_failed", or "failed" for one that could not be made.
    reason : str
        Why it is not ok; "" for ok.
    values : dict
        Measures by the columns of table.csv; NaN: unknown.
    terrain : Terrain or None
        None where it could not be made.
    """

    def __init__(self, made: ensembles.MadeMember, files: list[_networks.TemporaryPath]) -> None:
        row = made.row
        self.number: int = row.member.number
        self.seed: int = row.member.seed
        self.keys: dict[str, str] = dict(row.member.keys)
        self.status: str = row.state
        self.reason: str = row.reason
        self.warnings: int = row.warnings
        self.values: dict[str, float] = dict(row.values)
        self.terrain = None if made.made is None else Terrain(made.made, files)

    def __repr__(self) -> str:
        words = "".join(f" {key}={value}" for key, value in self.keys.items())
        return f"<Member {self.number} seed={self.seed}{words} {self.status}>"


def ensemble(recipe: object = None, /, members: int | None = None, *, seeds: Sequence[int] | None = None,
             vary: Mapping[str, object] | None = None, preset: str | None = None, threads: int = 0, progress: _show.Progress = None,
             **keys: Any) -> Iterator[Member]:
    """Make terrains that differ in the seed and in what varies, and yield them as they finish.

    A member is the same as that of `thalweg make --ensemble`, whatever the number of threads; only the order in which
    members come depends on them. As many terrains as there are threads are in memory, and those that the caller keeps.

    Parameters
    ----------
    recipe : dict, str, path, GeoDataFrame, GeoSeries, Raster, DataArray, ndarray or recipe.Recipe, optional
        See make.
    members : int, optional
        Number of members; the seed of the first is the recipe's.
    seeds : range, optional
        In place of members: consecutive seeds.
    vary : dict, optional
        By key of the recipe: a tuple (a, b) for a random number between a and b, a list for its values in turn, or a str as
        --vary has it, "10..35".
    preset : str, optional
        See make.
    threads : int, default 0
        Number of members made at once; 0: as many as there are processors.
    progress : callable or bool, optional
        See make.
    **keys
        Keys of the recipe, which go before it; see make.

    Yields
    ------
    Member

    Raises
    ------
    BadParameter
        For an unknown key, or one that cannot vary so.
    ValueError
        Without a number of members, or for seeds that are not consecutive.

    Examples
    --------
    >>> slopes = {}
    >>> for member in ensemble({"grid": {"width": 64, "height": 48}}, 4, vary={"surface.mean_slope": (10, 30)}):
    ...     slopes[member.number] = member.values["dem.slope_true_deg"]
    >>> len(slopes)
    4
    """
    if seeds is not None:
        if members is not None or len(seeds) == 0 or list(seeds) != list(range(seeds[0], seeds[0] + len(seeds))):
            raise ValueError("ensemble: give either the number of members or consecutive seeds, as range(7, 107)")
        keys = {**keys, "seed": seeds[0]}
        members = len(seeds)
    if members is None or members < 1:
        raise ValueError("ensemble: give the number of members, at least 1")
    files: list[_networks.TemporaryPath] = []
    asked = ensembles.Ensemble(recipe=_recipe_of(recipe, keys, files, preset), members=members,
                              vary=[ensembles.read_varied_key(f"{key}={_words_of(value)}") for key, value in (vary or {}).items()])
    return _members(asked, files, threads or os.cpu_count() or 1, _show.progress_of(progress))


def _words_of(value: object) -> str:
    if isinstance(value, tuple) and len(value) == 2:
        return f"{value[0]}..{value[1]}"
    return ", ".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)


def _members(asked: ensembles.Ensemble, files: list[_networks.TemporaryPath], threads: int,
             report: Callable[[float, str], object] | None) -> Iterator[Member]:
    left = iter(range(asked.members))
    with ThreadPoolExecutor(threads) as pool:
        running: set[Future[ensembles.MadeMember]] = set()
        stop = threading.Event()
        make: Callable[..., ensembles.MadeMember] = ensembles.make_member

        def begin() -> None:
            number = next(left, None)
            if number is not None:
                running.add(pool.submit(make, asked, number, threads=1, _is_stopped=stop.is_set))

        for _ in range(threads):
            begin()
        done = 0
        try:
            while running:
                ended = wait(running, return_when=FIRST_COMPLETED).done
                running -= ended
                for one in ended:
                    begin()
                    done += 1
                    if report is not None:
                        report(done / asked.members, "members")
                    yield Member(one.result(), files)
        finally:
            stop.set()  # the pool waits for the members that are being made
            for one in running:
                one.cancel()
