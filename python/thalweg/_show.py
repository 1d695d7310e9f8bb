# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures, progress, and packages that are imported only where they are used."""
from __future__ import annotations

import base64
import contextlib
import html
import importlib
import re
import sys
import warnings
from collections.abc import Callable, Sequence
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg import _core, io

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from thalweg._raster import Raster

Progress = Callable[[float, str], object] | bool | None
LARGEST_PICTURE = 800  # [px] of a raster in a notebook


def need(module: str, package: str) -> Any:
    """Import a module that thalweg can do without.

    Parameters
    ----------
    module : str
        Name of the module.
    package : str
        Debian package that holds it.

    Raises
    ------
    ImportError
        When it is not installed; names the package.
    """
    try:
        return importlib.import_module(module)
    except ImportError as missing:
        raise ImportError(f"this needs the Python module {module}: install the package {package}") from missing


def bad_input(where: str, text: str) -> _core.BadInput:
    """Return the error of a wrong input, to be raised."""
    error = _core.BadInput(text)
    error.where = where
    return error


# What the program advises in a shell, and how Python says it; the first that fits holds.
IN_PYTHON = [
    (re.compile(r"\S*/thalweg-\w+/(\w+)\.(?:gpkg|tif)\b"), r"\1"),  # a table or raster that was given in place of a file
    (re.compile(r"--set ([\w.]+)=(\S*)"), r"\1 = \2"),
    (re.compile(r"--overwrite\b"), "overwrite=True"),
    (re.compile(r"--device opencl\b"), 'device="opencl"'),
    (re.compile(r"(?<![\w-])--([a-z][a-z-]*)[ =](EPSG:\w+|[A-Z]{2,}\w*|-?\d[\w.]*|nan\b)(?![.\w])"), None),
    (re.compile(r"(?<![\w-])--([a-z][a-z-]*)(?![.\w-])"), None),
]


def in_python(words: str) -> str:
    """Return a message with the options of the program as arguments of Python."""
    for known, there in IN_PYTHON:
        words = known.sub(there or _argument, words)
    return words


def _argument(option: re.Match[str]) -> str:
    name = option[1].replace("-", "_")
    if option.re.groups < 2:
        return name
    value = option[2]
    return f'{name}="{value}"' if value.startswith("EPSG") else f"{name}={value}"


def progress_of(progress: Progress) -> Callable[[float, str], object] | None:
    """Return what shows progress.

    Parameters
    ----------
    progress : bool, callable or None
        True for a bar of tqdm, or a line on standard error where tqdm is not installed; a callable is returned as it is;
        None or False for nothing.

    Returns
    -------
    callable or None
        Takes the share of a stage that is done, from 0 to 1, and its name.

    Raises
    ------
    TypeError
        For anything else.
    """
    if progress is None or progress is False:
        return None
    if progress is True:
        return _bar() or _line
    if callable(progress):
        return progress
    raise TypeError(f"progress takes a function of (share, stage), True or None, not {type(progress).__name__}")


def _bar() -> Callable[[float, str], None] | None:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # tqdm warns where a notebook has no widgets, and shows text
            from tqdm.auto import tqdm
    except ImportError:
        return None
    bar = tqdm(total=100, leave=False, bar_format="{desc} {percentage:3.0f}%|{bar}| {elapsed}")
    current = ""

    def show(share: float, stage: str) -> None:
        nonlocal current
        if _name_of(stage) != current:
            current = _name_of(stage)
            bar.reset()
            bar.set_description_str(f"{current:10}", refresh=False)
        bar.update(100.0 * share - bar.n)

    return show


def _line(share: float, stage: str) -> None:
    print(f"\r{_name_of(stage):10} {100.0 * share:3.0f}%", end="\n" if share >= 1.0 else "", file=sys.stderr, flush=True)


def _name_of(stage: str) -> str:
    """The name alone: once a stage announces its amount with it ("grow 100000 particles")."""
    return stage.split(" ", 1)[0]


def html_of(png: bytes | None, words: str) -> str:
    """Return a picture and a line of text as HTML; without a picture the line alone. As JPEG where Pillow is installed: a
    notebook keeps every picture that it shows."""
    line = f"<div>{html.escape(words)}</div>"
    if png is None:
        return line
    kind, picture = "png", png
    with contextlib.suppress(ImportError):
        image = importlib.import_module("PIL.Image")
        out = BytesIO()
        image.open(BytesIO(png)).convert("RGB").save(out, "jpeg", quality=85)
        if len(out.getvalue()) < len(png):
            kind, picture = "jpeg", out.getvalue()
    data = base64.b64encode(picture).decode("ascii")
    return f'<img alt="{html.escape(words)}" style="max-width: 100%" src="data:image/{kind};base64,{data}">{line}'


def axes_of(ax: Axes | None) -> Axes:
    """Return the given axes, or new ones."""
    if ax is not None:
        return ax
    new: Axes = need("matplotlib.pyplot", "python3-matplotlib").subplots()[1]
    return new


def is_heights(raster: Raster) -> bool:
    """Return whether a raster is shown with a hillshade: float32 and not without data."""
    return raster.dtype == np.float32 and bool(np.isfinite(raster.values).any()) and not bool(np.isinf(raster.values).any())


def plot_raster(raster: Raster, ax: Axes | None) -> Axes:
    """Draw a raster: heights as a hillshade under a tint, other values in colours."""
    ax = axes_of(ax)
    west, south, east, north = raster.bounds
    extent = (west, east, south, north)
    if is_heights(raster):
        shade = io.hillshade(raster).values
        ax.imshow(np.where(shade == 0, np.nan, shade), cmap="gray", vmin=0, vmax=255, extent=extent)
        low, high = float(np.nanmin(raster.values)), float(np.nanmax(raster.values))
        # The lowest two fifths of these colours are the sea.
        ax.imshow(raster.values, cmap="gist_earth", alpha=0.4, extent=extent, vmin=low - 0.67 * (high - low), vmax=high)
    else:
        ax.imshow(raster.values, extent=extent, interpolation="nearest")
    with contextlib.suppress(AttributeError):  # of axes whose ticks a user has set
        ax.ticklabel_format(style="plain", useOffset=False)
    return ax


def plot_lines(lines: Sequence[Any], orders: Any, ax: Axes | None, color: str = "#1f6fb2") -> Axes:
    """Draw rivers, wider where their Strahler order is higher.

    Parameters
    ----------
    lines : sequence of ndarray, shape (k, 2)
        [m] Vertices by arc.
    orders : array_like of int, shape (m,)
        Strahler orders by arc.
    """
    ax = axes_of(ax)
    collections = need("matplotlib.collections", "python3-matplotlib")
    widths = 0.4 + 0.5 * np.asarray(orders, dtype=np.float64)
    ax.add_collection(collections.LineCollection(lines, linewidths=widths, colors=color, capstyle="round"))
    ax.autoscale_view()
    ax.set_aspect("equal")
    return ax


def png_of(raster: Raster) -> bytes | None:
    """Return a small picture of a raster as PNG; None without matplotlib."""
    try:
        image = importlib.import_module("matplotlib.image")
    except ImportError:
        return None
    values, colours = (io.hillshade(raster).values, "gray") if is_heights(raster) else (raster.values, "viridis")
    step = -(-max(values.shape) // LARGEST_PICTURE)
    out = BytesIO()
    image.imsave(out, np.asarray(values[::step, ::step], dtype=np.float64), cmap=colours, format="png")
    return out.getvalue()
