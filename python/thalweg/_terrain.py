# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Terrain from a recipe, as `thalweg make` makes it."""
from __future__ import annotations

import functools
import json
import os
import re
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from thalweg import _core, _networks, _show
from thalweg import flow as flows
from thalweg import recipe as recipes
from thalweg import report as reports
from thalweg import terrain as terrains
from thalweg._raster import Raster
from thalweg._show import bad_input

if TYPE_CHECKING:
    import geopandas
    import networkx
    import xarray
    from matplotlib.axes import Axes

# With these alone a recipe describes no terrain: they change the recipe that is used without one.
BESIDE_TERRAIN = {"seed", "grid", "output"}
MAP_WIDTH = 800  # [px]

Value = bool | int | float | str | list[Any] | dict[str, Any]


class TerrainWarning(UserWarning):
    """What make() warns of: a finding with the severity "warning".

    Attributes
    ----------
    finding : dict
        As in Terrain.findings.
    """

    def __init__(self, finding: dict[str, Any]) -> None:
        self.finding = finding
        super().__init__(_show.in_python(". ".join(filter(None, (finding["text"], finding["remedy"])))))


def _warn_of(findings: list[dict[str, Any]], stacklevel: int) -> None:
    for finding in findings:
        if finding["severity"] == "warning":
            warnings.warn(TerrainWarning(finding), stacklevel=stacklevel + 1)


class Terrain:
    """Terrain and rivers made from a recipe.

    Attributes
    ----------
    made : terrain.MakeResult
        Everything, as the library has it; what follows are its parts.
    """

    def __init__(self, made: terrains.MakeResult, files: list[_networks.TemporaryPath]) -> None:
        self.made = made
        self._files = files  # write() copies them

    @property
    def has_dem(self) -> bool:
        """False where the recipe asks for rivers alone."""
        return self.made.terrain.ground.dem is not None

    @functools.cached_property
    def has_network(self) -> bool:
        """False where the recipe has no [network]."""
        return bool(self.made.terrain.rivers.network.planform.arc_count)

    @functools.cached_property
    def dem(self) -> Raster:
        """[m] Heights by cell, float32, NaN: no data.

        Raises
        ------
        BadInput
            Where there is none: has_dem tells.
        """
        dem = self.made.terrain.ground.dem
        if dem is None:
            raise bad_input("Terrain", "the terrain has no DEM: its recipe asks for rivers alone")
        return dem

    def _rivers(self) -> terrains.Rivers:
        if not self.has_network:
            raise bad_input("Terrain", "the terrain has no rivers: its recipe has no [network]")
        return self.made.terrain.rivers

    @property
    def grid(self) -> _core.Grid:
        """Frame of the cells."""
        return self.made.terrain.grid

    @property
    def crs(self) -> str:
        """Coordinate system, "EPSG:n" or WKT."""
        return self.grid.crs

    @functools.cached_property
    def network(self) -> _core.ElevatedNetwork:
        """Rivers with heights.

        Raises
        ------
        BadInput
            Where there are none: has_network tells.
        """
        return self._rivers().network

    @functools.cached_property
    def orders(self) -> _core.NetworkOrders:
        """Stream orders and basins of the network; raises as network."""
        return self._rivers().orders

    @functools.cached_property
    def areas(self) -> flows.ContributingAreas:
        """[m²] Contributing areas by arc and node of the network; raises as network."""
        self._rivers()
        return self.made.terrain.water.areas

    @functools.cached_property
    def flow(self) -> flows.FlowField:
        """Flow over the DEM; raises as dem."""
        if not self.has_dem:
            raise bad_input("Terrain", "the terrain has no DEM that water flows over: its recipe asks for rivers alone")
        return self.made.terrain.water.drainage

    @functools.cached_property
    def catchments(self) -> flows.Catchments | None:
        """Catchments of the arcs, where the recipe asks for them."""
        return self.made.assessment.catchments

    @functools.cached_property
    def tin(self) -> _core.Tin | None:
        """TIN of rivers and points, where the surface is drawn over one."""
        tin = self.made.terrain.ground.tin
        return tin if len(tin.vertices) else None

    @functools.cached_property
    def ridges(self) -> _core.RidgeLines | None:
        """Ridges between streams, where the recipe asks for them."""
        ridges = self.made.terrain.ground.ridges
        return ridges if ridges.lines else None

    @property
    def checks(self) -> list[dict[str, Any]]:
        """name, value, limit, ok and bound of each check, as in report.json."""
        return self.made.assessment.checks

    @property
    def passed(self) -> bool:
        """Whether every check is ok."""
        return all(check["ok"] for check in self.checks)

    @property
    def findings(self) -> list[dict[str, Any]]:
        """What was found, as in report.json: of the recipe and its files, the rivers, the terrain, and by the checks.

        Each is a dict of kind, severity ("note", "warning" or "error"), feature, where ((x, y) [m] or None), amount and its
        unit, text, remedy, key of the recipe, layer, and numbers ({name: (value, unit)}).
        """
        return terrains.findings_of(self.made)

    @functools.cached_property
    def report(self) -> dict[str, Any]:
        """Content of report.json."""
        report: dict[str, Any] = json.loads(reports.report_json(self.made))
        return report

    @property
    def recipe(self) -> dict[str, Any]:
        """The recipe with every default that was used; make(recipe) makes the same terrain."""
        return tomllib.loads(self.recipe_toml)

    @property
    def recipe_toml(self) -> str:
        """The recipe as TOML."""
        return recipes.write_recipe(_with_whole_paths(self.made.recipe))

    @property
    def timings(self) -> dict[str, float]:
        """[s] By stage."""
        return {time.stage: time.wall_s for time in terrains.timings_of(self.made)}

    def write(self, folder: str | os.PathLike[str], overwrite: bool = False) -> list[str]:
        """Write the folder that `thalweg make` writes, completely or not at all.

        Parameters
        ----------
        folder : str or path
            Made where it does not exist.
        overwrite : bool, default False
            Whether to replace what an earlier run wrote there; other files are kept.

        Returns
        -------
        list of str
            Names of the files.

        Raises
        ------
        BadInput
            When the folder has content and overwrite is not set.
        IoError
            When it cannot be written.
        """
        return reports.write_terrain(self.made, os.fspath(folder), existing="replace" if overwrite else "refuse")

    def to_xarray(self) -> xarray.DataArray:
        """Return the DEM as xarray has it; see Raster.to_xarray.

        Raises
        ------
        BadInput
            When there is no DEM.
        ImportError
            Without xarray.
        """
        return self.dem.to_xarray("dem")

    def to_geodataframe(self, layer: str = "arcs") -> geopandas.GeoDataFrame:
        """Return the arcs or nodes of the rivers as a table; see to_geodataframe."""
        return _networks.to_geodataframe(self, layer)

    def to_networkx(self) -> networkx.DiGraph[Any]:
        """Return the rivers as a graph, directed downstream; see to_networkx."""
        return _networks.to_networkx(self)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the DEM as a hillshade under a tint, and the rivers, with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Left out: new ones.

        Returns
        -------
        matplotlib.axes.Axes
            In the terrain's coordinates.

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        ax = _show.axes_of(ax)
        if self.has_dem:
            _show.plot_raster(self.dem, ax)
        if self.has_network:
            limits = (ax.get_xlim(), ax.get_ylim())
            _show.plot_lines(self.network.planform.lines, self.orders.strahler, ax)
            if self.has_dem:
                ax.set(xlim=limits[0], ylim=limits[1])
        return ax

    def _words(self) -> str:
        grid = self.grid
        words = [f"{grid.width} × {grid.height} cells of {grid.cell_m:g} m"]
        if self.has_dem and np.isfinite(self.dem.values).any():
            words.append(f"relief {np.nanmax(self.dem.values) - np.nanmin(self.dem.values):.0f} m")
        if self.has_network:
            words += [f"{self.network.planform.arc_count} arcs", f"highest order {int(np.max(self.orders.strahler))}"]
        failed = [check["name"] for check in self.checks if not check["ok"]]
        words.append(f"failed: {', '.join(failed)}" if failed else f"{len(self.checks)} checks ok")
        return " · ".join(words)

    def __reduce__(self) -> Any:
        raise TypeError("a Terrain cannot be pickled: keep its parts, such as dem and network, or its recipe")

    def __repr__(self) -> str:
        return f"<Terrain {self._words()}>"

    @functools.cached_property
    def _map(self) -> bytes | None:
        return reports.draw_map(self.made, width_px=MAP_WIDTH).bytes if self.has_dem else None

    def _repr_html_(self) -> str:
        return _show.html_of(self._map, self._words())


def make(recipe: object = None, /, *, preset: str | None = None,
         output: str | os.PathLike[str] | Mapping[str, Any] | None = None, overwrite: bool = False, threads: int = 0,
         progress: _show.Progress = None, log: Callable[[str], object] | None = None,
         device: Literal["cpu", "opencl"] = "cpu", **keys: Any) -> Terrain:
    """Make terrain and rivers, as `thalweg make` does: the same recipe gives the same values.

    Parameters
    ----------
    recipe : dict, str, path, GeoDataFrame, GeoSeries, Raster, DataArray, ndarray or recipe.Recipe, optional
        A recipe as a dict of its sections, as TOML, or the path of one. Or rivers, for terrain around them: the path of a
        file, or a table of lines with a CRS. Or a DEM, for terrain as it has it: the path of a raster, or an array. Left
        out, or a dict of seed, grid and output alone: rivers over the whole grid and terrain around them. In a dict the
        value of a key that names a file may be a table or an array, None leaves a key out, and a section may be written as
        "grid.width". Relative names of files start from the working folder.
    preset : str, optional
        A name of recipe.presets(), such as "hills": keys of equilibrium terrain for land of one kind. What the recipe and
        **keys set goes before it.
    output : str, path or dict, optional
        Folder to write; see Terrain.write. A dict is the recipe's section of that name.
    overwrite : bool, default False
        Whether to replace what an earlier run wrote there.
    threads : int, default 0
        Number of threads; 0: as many as there are processors. Values do not depend on it.
    progress : callable or bool, optional
        Called with the share of a stage that is done, from 0 to 1, and its name; what it raises ends the work. True: a bar
        of tqdm, or lines on standard error where tqdm is not installed.
    log : callable, optional
        Called with each line of the log.
    device : {"cpu", "opencl"}, default "cpu"
        Where large systems are solved.
    **keys
        Keys of the recipe, which go before it: seed=7, grid={"width": 256}, or **{"grid.width": 256}.

    Returns
    -------
    Terrain

    Warns
    -----
    TerrainWarning
        For each finding of the terrain that is a warning.

    Raises
    ------
    BadParameter
        With all faults of a recipe: unknown keys, wrong types, values out of range, keys without effect; for a preset that
        is unknown or has no effect.
    BadInput
        When an input does not suit.
    NotConverged
        When a solver does not reach its tolerance.
    TypeError
        For a recipe or a value of another type.

    Examples
    --------
    >>> terrain = make({"grid": {"width": 256, "height": 256}}, seed=8)
    >>> terrain.dem.shape
    (256, 256)
    """
    if isinstance(output, Mapping):
        keys, output = {**keys, "output": output}, None
    files: list[_networks.TemporaryPath] = []
    return _made(_recipe_of(recipe, keys, files, preset), files, "make", output, overwrite, threads=threads, progress=progress, log=log,
                 device=device)


def rebuild(rivers: object, /, *, like: object = None, against: object = None, output: str | os.PathLike[str] | None = None,
            overwrite: bool = False, threads: int = 0, progress: _show.Progress = None,
            log: Callable[[str], object] | None = None, device: Literal["cpu", "opencl"] = "cpu", **keys: Any) -> Terrain:
    """Make the terrain between rivers with heights, as `thalweg rebuild` does.

    Parameters
    ----------
    rivers : str, path, GeoDataFrame, GeoSeries, dict or recipe.Recipe
        Lines with heights, or a recipe that names them; see make.
    like : str, path, Raster, DataArray or ndarray, optional
        A DEM of any place, whose mean slope and texture the terrain gets; left out: they follow from the rivers.
    against : str, path, Raster, DataArray or ndarray, optional
        A DEM on whose cells the terrain is made, and which it is compared with: Terrain.report["against"]. Its heights decide
        nothing of the terrain.
    output, overwrite, threads, progress, log, device, **keys
        As for make.

    Returns
    -------
    Terrain

    Raises
    ------
    BadParameter, BadInput, NotConverged, TypeError
        As make.
    """
    files: list[_networks.TemporaryPath] = []
    asked = _recipe_of(rivers, {**keys, "surface.like": like, "output.against": against}, files)
    return _made(recipes.rebuild_recipe(asked), files, "rebuild", output, overwrite, threads=threads, progress=progress, log=log,
                 device=device)


def _made(asked: recipes.Recipe, files: list[_networks.TemporaryPath], who: str, output: str | os.PathLike[str] | None,
          overwrite: bool, **run: Any) -> Terrain:
    if output is not None and not overwrite and os.path.isdir(output) and os.listdir(output):
        raise bad_input(who, f"{os.fspath(output)} is not empty: set overwrite=True or name another folder")
    made = terrains.make(asked, **run)
    terrain = Terrain(made, files)
    _warn_of(terrain.findings, 3)
    if output is not None:
        terrain.write(output, overwrite)
    return terrain


def forecast(recipe: object = None, /, *, preset: str | None = None, **keys: Any) -> dict[str, Any]:
    """Estimate the work of make(), without doing it.

    Parameters
    ----------
    recipe, preset, **keys
        As for make.

    Returns
    -------
    dict
        stages (list of str), grid (Grid, or None where it depends on rivers that must be grown first), cells,
        memory_bytes [byte] (at its peak, within some 15 %), seconds [s] (on one core of 2020) and findings, as in Terrain.findings.

    Warns
    -----
    TerrainWarning
        For each finding that is a warning.

    Raises
    ------
    BadParameter, BadInput
        As make.
    """
    files: list[_networks.TemporaryPath] = []
    found = recipes.forecast(_recipe_of(recipe, keys, files, preset))
    _warn_of(found.findings, 2)
    return {name: getattr(found, name) for name in ("stages", "grid", "cells", "memory_bytes", "seconds", "findings")}


def _recipe_of(recipe: object, keys: Mapping[str, Any], files: list[_networks.TemporaryPath],
               preset: str | None = None) -> recipes.Recipe:
    asked = _recipe_with(recipe, keys, files)
    return asked if preset is None else recipes.with_preset(asked, preset)


def _recipe_with(recipe: object, keys: Mapping[str, Any], files: list[_networks.TemporaryPath]) -> recipes.Recipe:
    over = dict(_values(keys, files))
    if isinstance(recipe, Mapping):
        given = dict(_values(recipe, files)) | over
        if not {str(key).split(".")[0] for key in recipe} <= BESIDE_TERRAIN:
            # One text, so that all faults are reported at once.
            return recipes.read_recipe(_toml_of(given), "recipe")
        recipe, over = None, given
    return _set_all(_without_file(over) if recipe is None else _base_of(recipe, files), over)


def _set_all(recipe: recipes.Recipe, over: Mapping[str, Value]) -> recipes.Recipe:
    for path, value in over.items():
        if value == {}:
            raise _core.BadParameter(f"{path} = {{}}: over another recipe, name a key of the section")
        recipe = recipes.set_key(recipe, path, value if isinstance(value, str) else _value_in_toml(value))
    return recipe


def _with_whole_paths(recipe: recipes.Recipe) -> recipes.Recipe:
    """The recipe with names of files that hold in any folder."""
    names_file = {key.path for key in recipes.recipe_keys() if key.is_file}
    for path, value in _values(tomllib.loads(recipes.write_recipe(recipe)), []):
        if re.sub(r"^(\w+)\.\d+\.", r"\1.", path) in names_file and value:
            whole = os.path.abspath(os.path.join(recipe.folder, str(value)))
            if os.path.exists(whole):  # else the address of a source elsewhere
                recipe = recipes.set_key(recipe, path, whole)
    return recipe


def _without_file(over: Mapping[str, Value]) -> recipes.Recipe:
    """The recipe that `thalweg make` uses without a file: a cluster where its keys are set, else rivers that suit the grid."""
    if over.get("network.source") == "dla" or any(path.startswith("network.dla.") for path in over):
        return recipes.cluster_recipe()
    sides = {path: value for path, value in over.items() if path in ("grid.width", "grid.height")}
    grid = tomllib.loads(recipes.write_recipe(_set_all(recipes.default_recipe(), sides)))["grid"]
    return recipes.default_recipe_on(grid["width"], grid["height"])


def _base_of(recipe: object, files: list[_networks.TemporaryPath]) -> recipes.Recipe:
    if isinstance(recipe, recipes.Recipe):
        return recipe
    if isinstance(recipe, str) and ("\n" in recipe or ("=" in recipe and not os.path.exists(recipe))):
        return recipes.read_recipe(recipe, "recipe")
    if isinstance(recipe, (str, os.PathLike)):
        return recipes.recipe_from(os.fspath(recipe))
    if _networks.is_table(recipe):
        files.append(_networks.lines_from(recipe))
    elif _networks.is_raster(recipe):
        files.append(_networks.raster_file(recipe, "dem"))
    else:
        raise TypeError("make takes a recipe (dict, TOML or path), rivers (GeoDataFrame or path) or a DEM (Raster, array or "
                        f"path), not {type(recipe).__name__}")
    return recipes.recipe_from(str(files[-1]))


def _values(sections: Mapping[Any, Any], files: list[_networks.TemporaryPath], prefix: str = "") -> Iterator[tuple[str, Value]]:
    """Keys by their paths, tables and arrays as names of files; an empty section is {}."""
    for key, value in sections.items():
        path = f"{prefix}{key}"
        if isinstance(value, (list, tuple)) and recipes.is_array_section(path):
            value = dict(enumerate(value, 1))
        if isinstance(value, Mapping):
            if not value:
                yield path, {}
            yield from _values(value, files, f"{path}.")
        elif value is not None:
            yield path, _value_of(value, path, files)


def _value_of(value: object, path: str, files: list[_networks.TemporaryPath]) -> Value:
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim < 2):
        value = value.tolist()
    if _networks.is_table(value):
        value = _networks.table_file(value, path)
        files.append(value)
        value = str(value)
    elif _networks.is_raster(value):
        value = _networks.raster_file(value, path)
        files.append(value)
        value = str(value)
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (list, tuple)):
        numbers = [one.item() if isinstance(one, np.generic) else one for one in value]
        if all(isinstance(one, (int, float)) for one in numbers) or all(isinstance(one, str) for one in numbers):
            return numbers
    raise TypeError(f"{path}: takes text, a number, True or False, a list of numbers or words, or for the name of a file a "
                    f"table or an array, not {value!r:.80}")


def _value_in_toml(value: Value) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        # A basic string of TOML is JSON's but for this character.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return "{}" if isinstance(value, dict) else f"[{', '.join(map(_value_in_toml, value))}]"


def _toml_of(values: Mapping[str, Value]) -> str:
    """A recipe of dotted keys; patches and layers, whose paths are patch.1.key, become arrays of tables."""
    lines: list[str] = []
    arrays: dict[tuple[str, int], list[str]] = {}
    for path, value in values.items():
        item = re.fullmatch(r"(\w+)\.(\d+)\.?(.*)", path, re.DOTALL)
        is_item = item is not None and recipes.is_array_section(item[1])
        into = arrays.setdefault((item[1], int(item[2])), []) if item and is_item else lines
        key = item[3] if item and is_item else path
        if key and not (value == {} and any(other.startswith(f"{path}.") for other in values)):
            into.append(f"{_dotted(key)} = {_value_in_toml(value)}")
    for (name, _), keys in sorted(arrays.items()):
        lines += [f"[[{name}]]", *keys]
    return "\n".join(lines) + "\n"


def _dotted(path: str) -> str:
    keys = path.split(".")
    return ".".join(key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key, ensure_ascii=False) for key in keys)
