# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasters: numpy arrays with a grid, and what else is accepted as one."""
from __future__ import annotations

import functools
import os
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from thalweg import _core, _show, io
from thalweg._show import bad_input

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Array = npt.NDArray[Any]
RasterLike: TypeAlias = "Raster | Array | xarray.DataArray | str | os.PathLike[str]"

ROWS = {"y", "lat", "latitude", "northing", "row"}
COLUMNS = {"x", "lon", "longitude", "easting", "col", "column"}
NO_DATA = (-9999.0, -32767.0, -32768.0, -99999.0)  # what no height is, and often stands for none
LARGEST = 1e19  # beyond it no number is a height; numpy fills masked arrays with 1e20
# Functions of numpy beside its ufuncs that give one value for each cell.
OF_EACH_CELL = {np.where, np.clip, np.round, np.around, np.nan_to_num, np.isclose, np.isin, np.real, np.fix, np.full_like, np.zeros_like,
                np.ones_like, np.empty_like, np.copy, np.interp, np.digitize}
DEEPEST_SEA = -12000.0  # [m]
FEET = {"ft", "foot", "feet", "us survey foot", "us_survey_foot", "us-ft", "ftus"}


class ConversionWarning(UserWarning):
    """Values were converted or copied before a call of the library could read them."""


class UnitWarning(UserWarning):
    """A stage takes for metres what are none."""


def _reduction(name: str) -> Callable[..., Any]:
    def reduce(self: Raster, *args: Any, **options: Any) -> Any:
        return getattr(self.values, name)(*args, **options)

    reduce.__name__, reduce.__qualname__ = name, f"Raster.{name}"
    reduce.__doc__ = f"Return numpy's {name} of the values: cells without data count as NaN."
    return reduce


class Raster(NDArrayOperatorsMixin):
    """One value per cell of a grid, as a numpy array that cannot be written.

    Operators and numpy's functions of each cell (dem + 1, a - b, dem > 100, np.sqrt, np.where, np.clip) return rasters of the
    same grid, and refuse rasters of another one. Every other function of numpy takes a raster as its array, and returns arrays,
    which Raster(array, dem.grid) places again. A stage gives a plain array the grid of the other rasters of the call.

    Parameters
    ----------
    values : array_like, Raster or DataArray, shape (height, width)
        Rows from the north. An array is shown, not copied. Of masked arrays the masked cells become NaN. A Raster or DataArray
        keeps its grid unless one is given.
    grid : Grid, Raster or dict, optional
        Frame of the cells. Without it the grid follows from the keywords.
    cell_m : float, default 1.0
        [m] Side of a cell.
    west : float, default 0.0
        [m] Outer edge of column 0.
    north : float, optional
        [m] Outer edge of row 0; left out: the southern edge is at 0.
    crs : str, int or CRS of pyproj, rasterio, geopandas or GDAL, optional
        "EPSG:n", n, WKT, or any object that gives WKT; "" or None for none.

    Raises
    ------
    BadInput
        When values are not a table of real numbers, the grid has another size or is given beside keywords, or crs is no
        coordinate system.

    Examples
    --------
    >>> dem = Raster(np.zeros((2, 3), np.float32), cell_m=10)
    >>> dem.bounds
    (0.0, 0.0, 30.0, 20.0)
    """

    values: Array
    grid: _core.Grid

    def __init__(self, values: npt.ArrayLike, grid: _core.Grid | Raster | dict[str, Any] | None = None, *, cell_m: float = 1.0, west: float = 0.0,
                 north: float | None = None, crs: object = "") -> None:
        of_keywords = (cell_m, west, north) != (1.0, 0.0, None) or not (crs is None or isinstance(crs, str) and not crs)
        xr = sys.modules.get("xarray")
        if grid is None and not of_keywords and xr is not None and isinstance(values, xr.DataArray):
            values = _from_xarray(values, np.dtype(np.float32 if values.dtype.kind == "f" else values.dtype), "values")
        if grid is None and isinstance(values, Raster):
            grid = values.grid  # refused below beside keywords
        shown = _unmasked(values, "values").view()
        _require_table(shown, "values")
        shown.flags.writeable = False
        height, width = shown.shape
        if grid is not None and of_keywords:
            raise bad_input("Raster", "give a grid or cell_m, west, north and crs, not both")
        if isinstance(grid, dict):
            grid = _core.Grid(**grid)
        if isinstance(grid, Raster):
            grid = grid.grid
        if grid is not None and not isinstance(grid, _core.Grid):
            raise TypeError(f"Raster: grid is {type(grid).__name__}; it must be a Grid, a Raster or a dict")
        if grid is None:
            if not cell_m > 0.0:
                raise bad_input("Raster", f"cell_m = {cell_m} is not above 0")
            grid = _core.Grid(width, height, cell_m, west, height * cell_m if north is None else north, crs_text(crs))
        elif (grid.width, grid.height) != (width, height):
            raise bad_input("Raster", f"values of {height} rows and {width} columns do not fit a grid of {grid.height} rows "
                                      f"and {grid.width} columns")
        self.values = shown
        self.grid = grid

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        height, width = self.values.shape
        return height, width

    @property
    def ndim(self) -> int:
        """2."""
        return 2

    @property
    def size(self) -> int:
        """Number of cells."""
        return self.values.size

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of a value."""
        return self.values.dtype

    @property
    def crs(self) -> str:
        """Coordinate system, "EPSG:n" or WKT; "" for none."""
        return self.grid.crs

    @property
    def cell_m(self) -> float:
        """[m] Side of a cell."""
        return self.grid.cell_m

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """[m] Outer edges: west, south, east, north."""
        grid = self.grid
        return (grid.west, grid.north - grid.height * grid.cell_m, grid.west + grid.width * grid.cell_m, grid.north)

    def array(self, copy: bool = False) -> Array:
        """Return the values.

        Parameters
        ----------
        copy : bool, default False
            Whether to return a copy, which can be written.

        Returns
        -------
        ndarray, shape (height, width)
            A view that cannot be written and keeps the memory alive, or a copy.
        """
        return self.values.copy() if copy else self.values

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> Array:
        if dtype is None or np.dtype(dtype) == self.dtype:
            return self.array(copy=bool(copy))
        if copy is False:
            raise ValueError(f"{self.dtype} cannot be shown as {np.dtype(dtype)} without a copy")
        return self.values.astype(dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        placed = "out" not in options and method == "__call__" and ufunc.signature is None
        _require_one_grid([*inputs, *options.values()], ufunc.__name__)
        options = {name: tuple(map(_plain, one)) if name == "out" else _plain(one) for name, one in options.items()}
        made = getattr(ufunc, method)(*map(_plain, inputs), **options)
        return tuple(self._placed(one) for one in made) if placed and isinstance(made, tuple) else (
            self._placed(made) if placed else made)

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        if not all(issubclass(kind, (Raster, np.ndarray)) for kind in types):
            return NotImplemented
        if function not in OF_EACH_CELL:
            return function(*_deeply_plain(args), **_deeply_plain(options))
        _require_one_grid([*args, *options.values()], function.__name__)
        return self._placed(function(*_deeply_plain(args), **_deeply_plain(options)))

    def _placed(self, values: Any) -> Any:
        return Raster(values, self.grid) if isinstance(values, np.ndarray) and values.shape == self.shape else values

    min = _reduction("min")
    max = _reduction("max")
    mean = _reduction("mean")
    std = _reduction("std")
    sum = _reduction("sum")
    any = _reduction("any")
    all = _reduction("all")

    def clip(self, least: Any = None, greatest: Any = None) -> Raster:
        """Return the raster with values between these two; None: no limit."""
        return Raster(np.clip(self.values, _plain(least), _plain(greatest)), self.grid)

    def round(self, decimals: int = 0) -> Raster:
        """Return the raster with values rounded to so many decimals."""
        return Raster(self.values.round(decimals), self.grid)

    def copy(self) -> Raster:
        """Return a raster with memory of its own."""
        return Raster(self.values.copy(), self.grid)

    def astype(self, dtype: npt.DTypeLike) -> Raster:
        """Return the raster with values of another type."""
        return Raster(self.values.astype(dtype), self.grid)

    def __getitem__(self, key: Any) -> Any:
        return self.values[tuple(map(_mask, key)) if isinstance(key, tuple) else _mask(key)]

    def __setitem__(self, key: Any, value: Any) -> None:
        raise ValueError("a raster cannot be written: array(copy=True) gives an array that can")

    @classmethod
    def open(cls, path: str | os.PathLike[str], *, values: Literal["heights", "numbers", "codes"] = "heights",
             nodata: float | None = None) -> Raster:
        """Read a raster file.

        Parameters
        ----------
        path : str or path
            Any raster that GDAL reads.
        values : {"heights", "numbers", "codes"}, default "heights"
            Heights become metres, and what no terrain has is refused; numbers and codes stay as they are. See io.read_dem.
        nodata : float, optional
            The value of cells without data; left out: what the file declares. NaN: none has.

        Returns
        -------
        Raster
            float32, NaN where there is no data; whole numbers beyond 2^24 are rounded.

        Raises
        ------
        BadInput
            As io.read_dem.
        """
        read: Raster = io.read_dem(os.fspath(path), values=values, nodata=nodata)
        return read

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Write the raster as a GeoTIFF.

        Parameters
        ----------
        path : str or path
            Ends in .tif or .tiff, or has no ending.
        overwrite : bool, default False
            Whether to replace the file.

        Raises
        ------
        BadParameter
            For another ending.
        BadInput
            For a value that is infinite or -9999, which stands for no data there.
        IoError
            When the file exists and overwrite is not set, or cannot be written.

        Notes
        -----
        float16 and float32 become Float32 (as io.write_dem), bool and uint8 Byte, without a number for no data (as
        io.write_mask), all other types Float64 (as io.write_field).
        """
        name = os.fspath(path)
        kind = self.dtype
        write: Any
        if kind in (np.dtype(np.bool_), np.dtype(np.uint8)):
            write, stored = io.write_mask, self.astype(np.uint8)
        elif kind in (np.dtype(np.float16), np.dtype(np.float32)):
            write, stored = io.write_dem, self.astype(np.float32)
        else:
            write, stored = io.write_field, self.astype(np.float64)
        if not (overwrite and os.path.exists(name)):
            write(stored, name)
            return
        if os.path.isdir(name):
            raise _core.IoError(f"{name} is a folder")
        folder, file = os.path.split(os.path.abspath(name))
        with tempfile.TemporaryDirectory(dir=folder, prefix=".thalweg-") as new:
            write(stored, os.path.join(new, file))
            os.replace(os.path.join(new, file), name)

    @property
    def transform(self) -> tuple[float, float, float, float, float, float]:
        """[m] Coefficients (a, b, c, d, e, f) of affine.Affine and rasterio: x = a col + c, y = e row + f at a cell's corner."""
        grid = self.grid
        return (grid.cell_m, 0.0, grid.west, 0.0, -grid.cell_m, grid.north)

    def xy(self, rows: npt.ArrayLike, columns: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the centres of cells.

        Parameters
        ----------
        rows, columns : array_like of int
            From 0, in the north-west.

        Returns
        -------
        x, y : ndarray
            [m] Coordinates.
        """
        grid = self.grid
        return (grid.west + (np.asarray(columns, float) + 0.5) * grid.cell_m,
                grid.north - (np.asarray(rows, float) + 0.5) * grid.cell_m)

    def index(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the cells of positions.

        Parameters
        ----------
        x, y : array_like
            [m] Coordinates.

        Returns
        -------
        rows, columns : ndarray of int64
            May lie outside the grid. The outer edge belongs to the outermost cells.
        """
        grid = self.grid
        x, y = np.asarray(x, float), np.asarray(y, float)
        _, south, east, _ = self.bounds
        far = 2.0**62  # positions beyond are outside any grid
        columns = np.where(x == east, grid.width - 1.0, np.floor((x - grid.west) / grid.cell_m))
        rows = np.where(y == south, grid.height - 1.0, np.floor((grid.north - y) / grid.cell_m))
        rows, columns = (np.clip(np.nan_to_num(one, nan=-far), -far, far).astype(np.int64) for one in (rows, columns))
        return rows, columns

    def sample(self, x: npt.ArrayLike, y: npt.ArrayLike, *, method: Literal["nearest", "bilinear"] = "nearest") -> Array:
        """Return the values at positions.

        Parameters
        ----------
        x, y : array_like
            [m] Coordinates in the raster's CRS, of equal shapes.
        method : {"nearest", "bilinear"}, default "nearest"
            The value of the cell, or interpolated between the centres of four.

        Returns
        -------
        ndarray
            Of the shape of x and y, floating point; NaN outside the grid, and where a cell that counts has no data.

        Raises
        ------
        BadParameter
            For another method.
        """
        if method not in ("nearest", "bilinear"):
            raise _core.BadParameter(f"sample: method = {method!r}; it must be nearest or bilinear")
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        values = self.values if self.dtype.kind == "f" else self.values.astype(np.float64)
        height, width = self.shape
        if method == "nearest":
            rows, columns = self.index(x, y)
            inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
            found: Array = np.where(inside, values[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)], np.nan)
            return found
        west, south, east, north = self.bounds
        inside = (x >= west) & (x <= east) & (y >= south) & (y <= north)
        across = np.clip(np.where(inside, (x - west) / self.cell_m - 0.5, 0.0), 0.0, width - 1.0)
        down = np.clip(np.where(inside, (north - y) / self.cell_m - 0.5, 0.0), 0.0, height - 1.0)
        left, top = np.floor(across).astype(np.int64), np.floor(down).astype(np.int64)
        right, bottom = np.minimum(left + 1, width - 1), np.minimum(top + 1, height - 1)
        dx, dy = across - left, down - top
        total: Array = np.zeros(x.shape)
        for row, column, weight in ((top, left, (1 - dx) * (1 - dy)), (top, right, dx * (1 - dy)), (bottom, left, (1 - dx) * dy),
                                    (bottom, right, dx * dy)):
            total = total + np.where(weight > 0.0, weight * values[row, column], 0.0)
        return np.where(inside, total, np.nan)

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.values)

    def __reduce__(self) -> tuple[Any, ...]:
        return Raster, (self.values, self.grid)

    def __repr__(self) -> str:
        return f"<Raster {self._words()}>"

    def _words(self) -> str:
        grid = self.grid
        crs = "no CRS" if not grid.crs else grid.crs if len(grid.crs) < 20 else io.crs_in_words(grid.crs)
        known = self.values[np.isfinite(self.values)]
        extent = f"from {known.min():g} to {known.max():g}" if known.size else "without data"
        return f"{grid.width} × {grid.height} cells of {grid.cell_m:g}, {self.dtype}, {extent}, {crs}"

    def _repr_html_(self) -> str:
        return _show.html_of(_show.png_of(self), self._words())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the raster with matplotlib: heights as a hillshade under a tint, other values in colours.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Left out: new ones.

        Returns
        -------
        matplotlib.axes.Axes
            In the raster's coordinates.

        Raises
        ------
        ImportError
            Without matplotlib.
        """
        return _show.plot_raster(self, ax)

    def to_xarray(self, name: str | None = None) -> xarray.DataArray:
        """Return the raster as xarray has it, by the conventions of rioxarray.

        Parameters
        ----------
        name : str, optional
            Name of the array.

        Returns
        -------
        xarray.DataArray, dims (y, x)
            The same memory. Coordinates are those of the cells' centres, y falls; spatial_ref holds CRS and GeoTransform.

        Raises
        ------
        ImportError
            Without xarray.
        """
        xr = _show.need("xarray", "python3-xarray")
        grid = self.grid
        x = grid.west + (np.arange(grid.width) + 0.5) * grid.cell_m
        y = grid.north - (np.arange(grid.height) + 0.5) * grid.cell_m
        reference = {"GeoTransform": f"{grid.west!r} {grid.cell_m!r} 0.0 {grid.north!r} 0.0 {-grid.cell_m!r}"}
        if grid.crs:
            wkt = _wkt_of(grid.crs)
            reference |= {"crs_wkt": wkt, "spatial_ref": wkt}
        shown = xr.DataArray(
            self.values, dims=("y", "x"), name=name, attrs={"_FillValue": np.nan} if self.dtype.kind == "f" else {},
            coords={"y": ("y", y, {"axis": "Y"}), "x": ("x", x, {"axis": "X"}), "spatial_ref": ((), 0, reference)})
        shown.encoding["grid_mapping"] = "spatial_ref"
        array: xarray.DataArray = shown
        return array


def from_core(values: Array, grid: _core.Grid) -> Raster:
    """Return the raster of a result of the library, without copying.

    Parameters
    ----------
    values : ndarray, shape (grid.height, grid.width)
        Keeps the memory alive.
    grid : Grid
    """
    return Raster(values, grid)


def to_core(thing: object, dtype: npt.DTypeLike, what: str, frame: _core.Grid | None = None) -> Raster:
    """Return anything that is accepted as a raster as the library reads it.

    Parameters
    ----------
    thing : Raster, ndarray, xarray.DataArray, str or path
        Also a masked array, and anything else that numpy takes as an array. A path is read as by io.read_dem.
    dtype : dtype
        float32, float64, uint8, int32, uint32 or int64.
    what : str
        Its name in messages.
    frame : Grid, optional
        Of a plain array of its shape. Else that has the grid of a raster without place: cells of 1, the south-western
        corner at 0.

    Returns
    -------
    Raster
        Of this dtype, C-contiguous, aligned, in native byte order; the given memory where it is so already.

    Raises
    ------
    BadInput
        When it is not a table of real numbers, its cells are not square, a value is none of the dtype, or heights hold a
        number that stands for no data, such as -9999; names its place.
    TypeError
        When it is nothing of the kind.

    Warns
    -----
    ConversionWarning
        When values are converted or copied.
    """
    target = np.dtype(dtype)
    if target == np.int32 and what == "codes":
        thing = _with_least(thing)
    raster = _raster_of(thing, target, what)
    if frame is not None and (frame.height, frame.width) == raster.shape:
        raster = Raster(raster.values, frame)
    values = _converted(raster.values, target, what)
    if target == np.float32:
        _refuse_no_data(values, what)
    return raster if values is raster.values else Raster(values, raster.grid)


def crs_text(crs: object, what: str = "crs") -> str:
    """Return a coordinate system as the library names it.

    Parameters
    ----------
    crs : str, int or CRS of pyproj, rasterio, geopandas or GDAL, optional
        "EPSG:n", n, WKT, or any object with to_wkt() or ExportToWkt(); "" or None for none.
    what : str
        Its name in messages.

    Returns
    -------
    str
        "EPSG:n" where it is one, else WKT; "" for none.

    Raises
    ------
    BadInput
        When a text or number is no coordinate system.
    TypeError
        For anything else.
    """
    if crs is None:
        return ""
    if isinstance(crs, str):
        return _known_crs(crs.upper() if crs.lower().startswith("epsg:") else crs)
    if isinstance(crs, (int, np.integer)) and not isinstance(crs, bool):
        return _known_crs(f"EPSG:{crs}")
    for method in ("to_wkt", "ExportToWkt"):
        if hasattr(crs, method):
            return _code_of(str(getattr(crs, method)()))
    raise TypeError(f"{what} is {crs!r}; it must be a text, a number or a CRS of pyproj, rasterio, geopandas or GDAL")


@functools.lru_cache(maxsize=64)
def _known_crs(crs: str) -> str:
    if crs:
        io.crs_in_words(crs)
    return crs


def say_unit(crs: str, what: str) -> None:
    """Warn where a raster's coordinates are no metres on the ground: stages take them for metres."""
    unit = _unit_of(crs)
    if unit in ("degrees", "other"):
        say(f"{what}: its coordinates are {'degrees' if unit == 'degrees' else 'no metres'}, and stages take them for metres: warp it "
             "to a projected CRS first", UnitWarning)


@functools.lru_cache(maxsize=64)
def _unit_of(crs: str) -> str:
    return io.ground_cell(_core.Grid(1, 1, 1e-3, 0.0, 1e-3, crs)).unit


def _raster_of(thing: object, target: np.dtype[Any], what: str) -> Raster:
    if isinstance(thing, Raster):
        return thing
    if isinstance(thing, (str, os.PathLike)):
        # What is not a height may be any number, also one that no terrain has.
        if what == "codes":
            return io.read_dem(os.fspath(thing), values="codes", nodata=np.nan)
        return io.read_dem(os.fspath(thing), values="heights" if target == np.float32 else "numbers")
    xr = sys.modules.get("xarray")
    if xr is not None and isinstance(thing, xr.Dataset):
        raise bad_input(what, f"{what}: a Dataset holds several arrays ({', '.join(map(str, thing.data_vars))}): choose one")
    if xr is not None and isinstance(thing, xr.DataArray):
        return _from_xarray(thing, target, what)
    if hasattr(thing, "__array__"):
        if target.kind != "f" and _is_masked(thing):
            raise bad_input(what, f"{what}: masked cells, and {target.name} has no value for them")
        values = _unmasked(thing, what)
        _require_table(values, what)
        return Raster(values)
    raise TypeError(f"{what}: takes a Raster, a numpy array, an xarray.DataArray or a path, not {type(thing).__name__}")


def _converted(values: Array, target: np.dtype[Any], what: str) -> Array:
    if values.dtype == np.bool_ and target == np.uint8:
        values = values.view(np.uint8)
    flags = values.flags
    if values.dtype == target and flags.c_contiguous and flags.aligned:
        return values
    if values.dtype.newbyteorder("=") != target:
        if target != np.uint32 or values.dtype != np.int64:  # counts, which the library shows as int64
            say(f"{what}: {values.dtype.name} converted to {target.name}")
        if target.kind != "f":
            _require_integers(values, target, what)
    elif not values.dtype.isnative:
        say(f"{what}: copied, not in native byte order")
    else:
        say(f"{what}: copied, not in C order" if not flags.c_contiguous else f"{what}: copied, not aligned")
    with np.errstate(over="ignore"):
        out = values.astype(target, order="C")
    if target.kind == "f" and values.dtype.itemsize > target.itemsize and np.isinf(out).any():
        _refuse_at(np.isinf(out) & np.isfinite(values), values, what, f"is beyond the range of {target.name}")
    return out


def _refuse_no_data(values: Array, what: str) -> None:
    """Refuse numbers that files write where there is no data, as io.read_dem does of a file that does not declare them."""
    low, high = float(np.fmin.reduce(values, axis=None)), float(np.fmax.reduce(values, axis=None))
    if low > max(NO_DATA) and high < LARGEST:
        return
    for number in NO_DATA:
        is_number = values == np.float32(number)
        # The sea is so deep where other cells are a little deeper.
        if is_number.any() and not ((values < number) & (values > DEEPEST_SEA) & ~np.isin(values, NO_DATA)).any():
            _refuse_no_data_at(is_number, number, values, what)
    if low <= -LARGEST or high >= LARGEST:
        is_large = np.isfinite(values) & (np.abs(values) >= LARGEST)
        if is_large.any():
            _refuse_no_data_at(is_large, float(values[is_large][0]), values, what)


def _refuse_no_data_at(cells: npt.NDArray[np.bool_], number: float, values: Array, what: str) -> None:
    row, column = np.unravel_index(int(cells.argmax()), cells.shape)
    test = f"abs({what}) >= {LARGEST:g}" if abs(number) >= LARGEST else f"{what} == {number:g}"
    raise bad_input(what, f"{what}: {int(cells.sum())} cells are {number:g}, the first in row {row}, column {column} (from 0): no "
                          f"terrain has this height. If it stands for no data: np.where({test}, np.nan, {what})")


def _require_one_grid(things: list[Any], where: str) -> None:
    grids = [one.grid for one in things if isinstance(one, Raster)]
    for grid in grids[1:]:
        if grid != grids[0]:
            raise bad_input(where, f"{where}: rasters of different grids: {grids[0]} and {grid}; resample one to the cells of the "
                                   "other, or take its values")


def _require_integers(values: Array, target: np.dtype[Any], what: str) -> None:
    if values.dtype.kind == "f":
        _refuse_at(np.isnan(values), values, what, f"is no value of {target.name}")
        _refuse_at(values != np.trunc(values), values, what, f"is not an integer, as {target.name} has them")
    least, most = np.iinfo(target).min, np.iinfo(target).max
    # Python's integers: numpy would compare uint64 with int64 as float64.
    for place in (values.argmin(), values.argmax()):
        value = values.flat[place]
        if not np.isfinite(value) or not least <= int(value) <= most:
            row, column = np.unravel_index(place, values.shape)
            raise bad_input(what, f"{what}: {value} in row {row}, column {column} (from 0) is beyond the range of "
                                  f"{target.name}, [{least}, {most}]")


def _refuse_at(bad: npt.NDArray[np.bool_], values: Array, what: str, fault: str) -> None:
    if bad.any():
        row, column = np.unravel_index(int(bad.argmax()), bad.shape)
        raise bad_input(what, f"{what}: {values[row, column]} in row {row}, column {column} (from 0) {fault}")


def _require_table(values: Array, what: str) -> None:
    if values.dtype.kind not in "biuf":
        raise bad_input(what, f"{what}: values are {values.dtype.name}, not real numbers")
    if values.ndim != 2:
        raise bad_input(what, f"{what}: has {values.ndim} dimensions, a raster has two: rows and columns")
    if values.size == 0:
        raise bad_input(what, f"{what}: is empty: {values.shape[0]} rows, {values.shape[1]} columns")


def _with_least(thing: Any) -> Any:
    """Codes with the least number of int32 where there are none: NaN, masked, or the least number of a smaller type."""
    raster = thing if hasattr(thing, "__array__") else _raster_of(thing, np.dtype(np.int32), "codes")
    values = np.asarray(raster)
    absent = np.broadcast_to(raster.mask, values.shape) if isinstance(raster, np.ma.MaskedArray) else np.zeros(values.shape, bool)
    if values.dtype.kind == "f":
        absent = absent | np.isnan(values)
    elif values.dtype.kind == "i" and values.dtype.itemsize < 4:
        absent = absent | (values == np.iinfo(values.dtype).min)
    if values.ndim != 2 or (not absent.any() and raster is thing) or not np.array_equal(values, np.trunc(values), equal_nan=True):
        return raster
    filled = np.where(absent, 0, values)
    if np.abs(filled).max() > np.iinfo(np.int32).max:
        return raster
    filled = filled.astype(np.int32)
    filled[absent] = np.iinfo(np.int32).min
    return Raster(filled, raster.grid) if isinstance(raster, Raster) else filled


def _unmasked(values: Any, what: str) -> Array:
    array: Array = np.asarray(values)
    if _is_masked(values):
        say(f"{what}: copied, masked cells become NaN")
        array = _with_nan(array, values.mask)
    return array


def _is_masked(values: object) -> bool:
    return isinstance(values, np.ma.MaskedArray) and bool(np.any(values.mask))


def _with_nan(values: Array, unknown: npt.NDArray[np.bool_]) -> Array:
    """A copy with NaN where a value is not known, of a floating-point type that holds the others."""
    copy = values.astype(np.result_type(values.dtype, np.float16 if values.dtype.kind == "f" else np.float32))
    copy[unknown] = np.nan
    return copy


def _plain(one: Any) -> Any:
    return one.values if isinstance(one, Raster) else one


def _deeply_plain(thing: Any) -> Any:
    if isinstance(thing, (list, tuple)):
        return type(thing)(map(_deeply_plain, thing))
    if isinstance(thing, dict):
        return {name: _deeply_plain(one) for name, one in thing.items()}
    return _plain(thing)


def _mask(key: Any) -> Any:
    """A key of an array: rasters are masks, also those of the library, which hold 1 and 0."""
    return (key.values.astype(bool) if key.dtype == np.uint8 else key.values) if isinstance(key, Raster) else key


def say(text: str, kind: type[UserWarning] = ConversionWarning) -> None:
    """Warn at the line outside this package that led here."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__name__", "").split(".")[0] == "thalweg":
        frame, level = frame.f_back, level + 1
    warnings.warn(text, kind, stacklevel=level)


def _from_xarray(array: xarray.DataArray, target: np.dtype[Any], what: str) -> Raster:
    if array.ndim == 3:
        bands = [dim for dim in array.dims if str(dim).lower() not in ROWS | COLUMNS]
        if len(bands) != 1 or array.sizes[bands[0]] != 1:
            raise bad_input(what, f"{what}: has three dimensions {array.dims} and more than one band: choose one, "
                                  "as .isel(band=0) does")
        array = array.isel({bands[0]: 0})
    if array.ndim == 2 and (str(array.dims[1]).lower() in ROWS or str(array.dims[0]).lower() in COLUMNS):
        array = array.transpose(array.dims[1], array.dims[0])
    values = _known(array, target, what)
    _require_table(values, what)
    mapping = array.encoding.get("grid_mapping", array.attrs.get("grid_mapping", "spatial_ref"))
    reference = array.coords[mapping].attrs if mapping in array.coords else {}
    crs = str(reference.get("crs_wkt", reference.get("spatial_ref", array.attrs.get("crs", ""))))
    affine = _affine_of(reference, what)
    y, x = (array.coords[dim].values.astype(np.float64) if dim in array.coords else None for dim in array.dims)
    if y is not None and y.size > 1 and y[0] < y[-1]:
        values, y = values[::-1], y[::-1]
    if x is not None and x.size > 1 and x[0] > x[-1]:
        values, x = values[:, ::-1], x[::-1]
    return Raster(values, _grid_of(values.shape, x, None if y is None else -y, affine, _code_of(crs), what))


def _known(array: xarray.DataArray, target: np.dtype[Any], what: str) -> Array:
    """The values with NaN where there is no data, scale and offset applied."""
    attributes = array.attrs
    if target == np.float32 and str(attributes.get("units", "")).lower() in FEET:
        raise bad_input(what, f"{what}: heights are in feet (attribute units = {attributes['units']!r}): multiply them by "
                              "0.3048, or 1200/3937 for survey feet, and set units to m")
    values = _unmasked(array.values, what)
    if values.dtype.kind not in "biuf":
        return values
    named = [attributes[name] for name in ("_FillValue", "missing_value", "nodata", "nodatavals") if name in attributes]
    unknown = np.isin(values, np.concatenate([np.ravel(one) for one in named]) if named else [])
    scale, offset = float(attributes.get("scale_factor", 1.0)), float(attributes.get("add_offset", 0.0))
    if unknown.any():
        if target.kind != "f":
            raise bad_input(what, f"{what}: cells without data, and {target.name} has no value for them")
        say(f"{what}: copied, cells without data become NaN")
        values = _with_nan(values, unknown)
    if (scale, offset) != (1.0, 0.0):
        say(f"{what}: copied, scale and offset applied")
        values = (values.astype(np.float64) * scale + offset).astype(target if target.kind == "f" else np.float64)
    return values


def _affine_of(reference: dict[Any, Any], what: str) -> tuple[float, float, float] | None:
    """West, cell and north of a GeoTransform, as GDAL writes it; None where there is none, or cells are not square."""
    numbers = [float(word) for word in str(reference.get("GeoTransform", "")).split()]
    if len(numbers) != 6:
        return None
    west, dx, skew_x, north, skew_y, dy = numbers
    if skew_x or skew_y:
        raise bad_input(what, f"{what}: is rotated (GeoTransform {reference['GeoTransform']}): warp it to a grid that is not")
    return (west, dx, north) if dx == -dy else None


def _grid_of(shape: tuple[int, ...], x: Array | None, down: Array | None, affine: tuple[float, float, float] | None, crs: str,
             what: str) -> _core.Grid:
    """The grid of cells with these centres, both ascending (down: -y)."""
    height, width = shape
    usual = affine[1] if affine is not None else None
    dx = _step(x, "x", what) or usual
    dy = _step(down, "y", what) or dx
    dx = dx or dy
    if dx is None or dy is None:  # no coordinates, or one cell
        dx = dy = 1.0
    if abs(dx - dy) > 1e-3 * dx or abs(dx - dy) * max(width, height) > 0.1 * dx:
        raise bad_input(what, f"{what}: cells are not square: {dx:g} x {dy:g}. Warp it to square cells first")
    west = 0.0 if x is None else float(x[0]) - 0.5 * dx
    north = height * dx if down is None else -float(down[0]) + 0.5 * dx
    if affine is not None:
        absent = x is None or down is None
        near = max(abs(affine[0] - west), abs(affine[2] - north), abs(affine[1] - dx) * max(width, height)) < 1e-3 * dx
        if absent or near:  # exactly what was written; it is stale where a part of the raster was cut out
            west, dx, north = affine
    return _core.Grid(width, height, dx, west, north, crs)


def _step(centres: Array | None, name: str, what: str) -> float | None:
    if centres is None or centres.size < 2:
        return None
    step = float(centres[-1] - centres[0]) / (centres.size - 1)
    if not np.all(np.abs(np.diff(centres) - step) <= 0.01 * step):
        raise bad_input(what, f"{what}: coordinates {name} are not evenly spaced")
    return float(f"{step:.12g}")


def _wkt_of(crs: str) -> str:
    return str(_show.need("pyproj", "python3-pyproj").CRS.from_user_input(crs).to_wkt())


def _code_of(crs: str) -> str:
    """ "EPSG:n" where a CRS is one, as files are read."""
    if not crs or crs.startswith("EPSG:"):
        return crs
    authority = _show.need("pyproj", "python3-pyproj").CRS.from_user_input(crs).to_authority(min_confidence=100)
    return ":".join(authority) if authority and authority[0] == "EPSG" else crs
