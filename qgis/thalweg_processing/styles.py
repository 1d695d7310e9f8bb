# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Styles of layers for which the program writes none."""
from __future__ import annotations

import math
from collections.abc import Callable

from qgis.core import (QgsColorRampShader, QgsMapLayer, QgsPalettedRasterRenderer, QgsRasterLayer, QgsRasterShader,
                       QgsSingleBandPseudoColorRenderer, QgsVectorLayer, QgsWkbTypes)
from qgis.PyQt.QtGui import QColor

Style = Callable[[QgsMapLayer], None]

HEIGHTS = ("#7ea688", "#89ad8c", "#94b58f", "#9fbd93", "#aac496", "#b9ca9b", "#c7d09f", "#d6d6a4", "#e7d2a6", "#e3c9a2", "#dec1a0",
           "#e1c9b1", "#e4d1c2", "#e9dacf", "#eee3db", "#f3ede7", "#f8f6f3")  # those of dem.tif
AMOUNTS = ("#f7fbff", "#c6dbef", "#6baed6", "#2171b5", "#08306b")
ANGLES = ("#d7642c", "#e8c547", "#4f9d69", "#3b6fb6", "#8e4a9e", "#d7642c")  # the last is the first
DIRECTIONS = {1: "east", 2: "south-east", 4: "south", 8: "south-west", 16: "west", 32: "north-west", 64: "north",
              128: "north-east"}
SIDE = 256  # [cells] of the sample that tells the range of a raster's values; statistics of GDAL would leave a file


def _sample(layer: QgsRasterLayer) -> list[float]:
    """Values of cells, ascending."""
    block = layer.dataProvider().block(1, layer.extent(), min(layer.width(), SIDE), min(layer.height(), SIDE))
    values = (block.value(row, column) for row in range(block.height()) for column in range(block.width())
              if not block.isNoData(row, column))
    return sorted(value for value in values if math.isfinite(value))


def _shade(layer: QgsMapLayer, low: float, high: float, colours: tuple[str, ...]) -> None:
    high = high if high > low else low + 1
    places = 0 if high - low > 20 else 2
    shade = QgsColorRampShader(low, high)
    steps = [low + (high - low) * number / (len(colours) - 1) for number in range(len(colours))]
    shade.setColorRampItemList([QgsColorRampShader.ColorRampItem(step, QColor(colour), f"{step:.{places}f}")
                                for step, colour in zip(steps, colours)])
    shader = QgsRasterShader(low, high)
    shader.setRasterShaderFunction(shade)
    renderer = QgsSingleBandPseudoColorRenderer(layer.dataProvider(), 1, shader)
    renderer.setClassificationMin(low)
    renderer.setClassificationMax(high)
    layer.setRenderer(renderer)


def heights(layer: QgsMapLayer) -> None:
    """Tint heights as those of dem.tif."""
    if values := _sample(layer):
        _shade(layer, values[0], values[-1], HEIGHTS)


def amounts(layer: QgsMapLayer) -> None:
    """Shade amounts, without the highest hundredth."""
    if values := _sample(layer):
        low, high = values[0], values[len(values) * 99 // 100]
        _shade(layer, low, high, AMOUNTS)


def angles(layer: QgsMapLayer) -> None:
    """Colour directions in radians, by the circle."""
    _shade(layer, 0, 2 * math.pi, ANGLES)


def _classes(layer: QgsMapLayer, classes: list[tuple[int, str, str]]) -> None:
    made = [QgsPalettedRasterRenderer.Class(value, QColor(colour), label) for value, colour, label in classes]
    layer.setRenderer(QgsPalettedRasterRenderer(layer.dataProvider(), 1, made))


def directions(layer: QgsMapLayer) -> None:
    """Colour D8 directions, by the circle."""
    colours = ("#d7642c", "#e0a83c", "#e8c547", "#9cb158", "#4f9d69", "#3b6fb6", "#8e4a9e", "#b3575f")
    _classes(layer, [(value, colour, name) for (value, name), colour in zip(DIRECTIONS.items(), colours)])


def orders(layer: QgsMapLayer) -> None:
    """Colour stream orders, darker with their number."""
    colours = ("#9ecae1", "#6baed6", "#4292c6", "#2171b5", "#08519c", "#08306b")
    _classes(layer, [(order, colours[min(order, len(colours)) - 1], str(order)) for order in range(1, 13)])


def cells(colour: str, label: str) -> Style:
    """Return a style that colours the cells that are 1."""
    return lambda layer: _classes(layer, [(1, colour, label)])


def network(layer: QgsMapLayer) -> None:
    """Draw rivers as blue lines, and nodes as small points."""
    if not isinstance(layer, QgsVectorLayer) or layer.renderer() is None or layer.renderer().type() != "singleSymbol":
        return
    symbol = layer.renderer().symbol()
    symbol.setColor(QColor("#2171b5"))
    if layer.geometryType() == QgsWkbTypes.PointGeometry:
        symbol.setSize(1.2)
    elif layer.geometryType() == QgsWkbTypes.LineGeometry:
        symbol.setWidth(0.4)
