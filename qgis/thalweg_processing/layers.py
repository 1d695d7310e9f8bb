# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Layers for the program, as the user sees them in QGIS, and layers of what it wrote."""
from __future__ import annotations

import os
import pathlib
import re
import threading
from dataclasses import dataclass
from typing import Any

from osgeo import gdal, ogr
from qgis.core import (NULL, QgsCoordinateReferenceSystem, QgsFeatureRequest, QgsFeatureSink, QgsField, QgsFields,
                       QgsLayerTreeLayer, QgsMapLayer, QgsMeshLayer, QgsProcessingAlgorithm, QgsProcessingContext,
                       QgsProcessingException, QgsProcessingFeatureSource, QgsProcessingFeatureSourceDefinition, QgsProcessingFeedback,
                       QgsProcessingLayerPostProcessorInterface,
                       QgsProcessingUtils, QgsProject, QgsProviderRegistry, QgsRasterLayer, QgsVectorFileWriter, QgsVectorLayer,
                       QgsWkbTypes)
from qgis.PyQt import sip

from .styles import Style

ITS_OWN_ID, ITS_SHAPE = "thalweg_fid", "thalweg_shape"  # of an exported feature: fields fid and geom of the layer stay fields


def is_given(value: Any) -> bool:
    """Return whether a parameter has a value; dialogs leave it out as "", None or QGIS's NULL."""
    return value is not None and value != NULL and value != "" and value != []


def crs_text(crs: QgsCoordinateReferenceSystem) -> str:
    """Return a CRS as the program takes it: EPSG:N, or WKT."""
    name = crs.authid()
    return name if name.startswith("EPSG:") else crs.toWkt(QgsCoordinateReferenceSystem.WKT_PREFERRED)


def file_name(layer_name: str) -> str:
    """Return a layer's name as the name of a file."""
    return re.sub(r'[/\\:*?"<>|\0-\x1f]', "_", layer_name).strip(" .")[:80] or "layer"


def table_name(layer_name: str) -> str:
    """Return a layer's name as a GeoPackage takes it."""
    return layer_name if re.match(r"(?!gpkg|sqlite_|rtree_)\w", layer_name, re.IGNORECASE) else f"layer {layer_name}"


def told_apart(fields: QgsFields) -> QgsFields:
    """Return fields whose names differ in more than their case, as those of a GeoPackage must."""
    found, taken = QgsFields(), {ITS_OWN_ID, ITS_SHAPE}
    for field in fields:
        name, number = field.name(), 2
        while name.lower() in taken:
            name, number = f"{field.name()}_{number}", number + 1
        taken.add(name.lower())
        renamed = QgsField(field)
        renamed.setName(name)
        found.append(renamed)
    return found


@dataclass
class File:
    """A file for the program."""

    path: str
    layer: str = ""  # "": it has one layer, or the program chooses
    source_crs: str = ""  # of a file that has no CRS; "": it has one, or nobody knows


@dataclass
class VectorInput:
    """A vector layer: its file where that holds what the user sees, else features to be written to a file."""

    layer_name: str
    file: File | None
    source: QgsProcessingFeatureSource | None
    origin: str = ""  # the file that the features come from; "": none
    is_selection: bool = False  # whether they are the selected ones

    def written(self, path: str, layer_name: str, context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> None:
        """Add the features to a GeoPackage as a layer of this name."""
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.driverName = "GPKG"
        options.layerName = table_name(layer_name)
        options.layerOptions = [f"FID={ITS_OWN_ID}", f"GEOMETRY_NAME={ITS_SHAPE}", "SPATIAL_INDEX=NO"]
        if os.path.exists(path):
            options.actionOnExistingFile = QgsVectorFileWriter.CreateOrOverwriteLayer
        source = self.source
        assert source is not None
        writer = QgsVectorFileWriter.create(path, told_apart(source.fields()), source.wkbType(), source.sourceCrs(),
                                            context.transformContext(), options)
        if writer.hasError() != QgsVectorFileWriter.NoError:
            raise QgsProcessingException(f"cannot write the features of {self.layer_name}: {writer.errorMessage()}")
        features = source.getFeatures(QgsFeatureRequest(), QgsProcessingFeatureSource.FlagSkipGeometryValidityChecks)
        is_empty = True
        for feature in features:
            if feedback.isCanceled():
                return
            is_empty = False
            if not writer.addFeature(feature, QgsFeatureSink.FastInsert):
                raise QgsProcessingException(f"cannot write feature {feature.id()} of {self.layer_name}: "
                                             f"{writer.errorMessage()}")
        if is_empty:
            raise QgsProcessingException(f"the selection of layer {self.layer_name} holds no features: select some, or untick "
                                         "Selected features only" if self.is_selection else
                                         f"the layer {self.layer_name} shows no features: look at its filter")
        if not writer.flushBuffer():
            raise QgsProcessingException(f"cannot write the features of {self.layer_name}: {writer.errorMessage()}")
        del writer

    def as_file(self, folder: str, context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> File:
        """Return the file; where it must be written, in this folder."""
        if self.file is not None:
            return self.file
        path = free_path(folder, file_name(self.layer_name), ".gpkg")
        self.written(path, self.layer_name, context, feedback)
        return File(path)


@dataclass
class RasterInput:
    """A raster layer: its file, and what QGIS says of it that the file does not."""

    layer_name: str
    path: str  # of the file, or what else GDAL opens: a table of a GeoPackage, a file in a ZIP
    crs: str = ""  # WKT; "": as in the file
    nodata: float | None = None  # beside what the file declares; None: nothing

    @property
    def origin(self) -> str:
        """The file of the layer."""
        return self.path

    def as_file(self, folder: str, context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> File:
        """Return the file; where it must be described again, in this folder."""
        if os.path.exists(self.path) and not self.crs and self.nodata is None:
            return File(self.path)
        in_memory = "/vsimem/" in self.path or self.path.startswith("MEM:")  # of this process only
        ending, kind = (".tif", "GTiff") if in_memory else (".vrt", "VRT")
        path = free_path(folder, file_name(self.layer_name), ending)
        try:
            made = gdal.Translate(path, self.path, format=kind, outputSRS=self.crs or None, noData=self.nodata)
        except RuntimeError:  # where the user's GDAL raises
            made = None
        if made is None:
            raise QgsProcessingException(f"cannot read {self.path}: {gdal.GetLastErrorMsg()}")
        made = None
        return File(path)


def free_path(folder: str, stem: str, ending: str) -> str:
    """Return the path of a new file in a folder."""
    path, number = os.path.join(folder, stem + ending), 2
    while os.path.exists(path):
        path, number = os.path.join(folder, f"{stem}_{number}{ending}"), number + 1
    return path


def opened_vector(path: str) -> Any:
    """Return a file of vector layers, or None where GDAL cannot read it."""
    try:
        return gdal.OpenEx(path, gdal.OF_VECTOR)
    except RuntimeError:  # where the user's GDAL raises
        return None


def _origin(layer: QgsVectorLayer | None) -> str:
    """The file of a layer, "" where it has none."""
    if layer is None or layer.providerType() != "ogr":
        return ""
    return str(QgsProviderRegistry.instance().decodeUri("ogr", layer.source()).get("path") or "")


def _is_part(definition: Any) -> bool:
    """Whether a parameter takes a part of a layer's features."""
    if not isinstance(definition, QgsProcessingFeatureSourceDefinition):
        return False
    has_filter = bool(getattr(definition, "filterExpression", ""))  # since QGIS 3.32
    return definition.selectedFeaturesOnly or definition.featureLimit != -1 or has_filter


def _file_of(layer: QgsVectorLayer, takes_layer_name: bool) -> File | None:
    """The file that holds what a layer shows; None where no file does."""
    provider = layer.dataProvider()
    if layer.providerType() != "ogr" or layer.isModified() or layer.subsetString():
        return None
    if layer.fields().count() != provider.fields().count():  # joined and virtual fields
        return None
    parts = QgsProviderRegistry.instance().decodeUri("ogr", layer.source())
    path = str(parts.get("path") or "")
    if os.path.isabs(path) and not path.startswith("/vsi") and not os.path.exists(path):
        raise QgsProcessingException(f"{layer.name()}: its file {path} does not exist any more")
    if not os.path.exists(path) or parts.get("openOptions") or "|geometrytype=" in layer.source().lower():
        return None
    path = os.path.abspath(path)
    name = str(parts.get("layerName") or "")
    if not takes_layer_name:
        opened = opened_vector(path)
        if opened is None or opened.GetLayerCount() != 1:
            return None
        name = ""
    elif not name and parts.get("layerId"):
        return None
    theirs = provider.crs()
    if theirs.isValid() and theirs != layer.crs():
        return None
    return File(path, name, crs_text(layer.crs()) if layer.crs().isValid() and not theirs.isValid() else "")


def vector_input(algorithm: QgsProcessingAlgorithm, parameters: dict[str, Any], name: str, context: QgsProcessingContext,
                 takes_layer_name: bool = False, takes_source_crs: bool = False) -> VectorInput | None:
    """Return the vector layer of a parameter, in the thread that the layer lives in.

    Parameters
    ----------
    algorithm, parameters, name, context
        As QGIS gives them.
    takes_layer_name : bool
        Whether the program can be given the name of a layer of this file.
    takes_source_crs : bool
        Whether it can be given the CRS of a file without one.
    """
    if not is_given(parameters.get(name)):
        return None
    layer = algorithm.parameterAsVectorLayer(parameters, name, context)
    source = algorithm.parameterAsSource(parameters, name, context)
    if source is None:
        raise QgsProcessingException(algorithm.invalidSourceError(parameters, name))
    if layer is not None and not layer.isValid():
        raise QgsProcessingException(f"{layer.name()}: QGIS cannot read this layer")
    file = _file_of(layer, takes_layer_name) if layer is not None and not _is_part(parameters[name]) else None
    if file is not None and file.source_crs and not takes_source_crs:
        file = None
    is_selection = isinstance(value := parameters[name], QgsProcessingFeatureSourceDefinition) and value.selectedFeaturesOnly
    return VectorInput(layer.name() if layer is not None else source.sourceName(), file, source, _origin(layer), is_selection)


def map_layer_input(algorithm: QgsProcessingAlgorithm, parameters: dict[str, Any], name: str,
                    context: QgsProcessingContext) -> VectorInput | RasterInput | None:
    """Return the vector or raster layer of a parameter."""
    if not is_given(parameters.get(name)):
        return None
    layer = algorithm.parameterAsLayer(parameters, name, context)
    if isinstance(layer, QgsRasterLayer):
        return _raster_of(layer)
    if isinstance(layer, QgsVectorLayer):
        file = _file_of(layer, takes_layer_name=False)
        if file is not None and file.source_crs:
            file = None
        return VectorInput(layer.name(), file, algorithm.parameterAsSource(parameters, name, context), _origin(layer))
    raise QgsProcessingException(f"{name}: {parameters[name]} is neither a vector nor a raster layer that QGIS can read")


def raster_input(algorithm: QgsProcessingAlgorithm, parameters: dict[str, Any], name: str,
                 context: QgsProcessingContext) -> RasterInput | None:
    """Return the raster layer of a parameter.

    Raises
    ------
    QgsProcessingException
        When QGIS cannot read it, or it does not come from a file that GDAL reads.
    """
    if not is_given(parameters.get(name)):
        return None
    layer = algorithm.parameterAsRasterLayer(parameters, name, context)
    if layer is None or not layer.isValid():
        raise QgsProcessingException(algorithm.invalidRasterError(parameters, name))
    return _raster_of(layer)


def _raster_of(layer: QgsRasterLayer) -> RasterInput:
    if layer.providerType() != "gdal":
        raise QgsProcessingException(f"{layer.name()} does not come from a file: save it as a GeoTIFF and take that")
    provider = layer.dataProvider()
    path = str(QgsProviderRegistry.instance().decodeUri("gdal", layer.source()).get("path") or "")
    is_file = os.path.exists(path) and path == layer.source()  # not a table of a GeoPackage or a part of another file
    path = os.path.abspath(path) if is_file else layer.source().split("|", 1)[0]
    crs = layer.crs().toWkt(QgsCoordinateReferenceSystem.WKT_PREFERRED) if (
        layer.crs().isValid() and layer.crs() != provider.crs()) else ""
    ranges = provider.userNoDataValues(1)
    if len(ranges) > 1 or any(part.min() != part.max() for part in ranges):
        raise QgsProcessingException(f"{layer.name()} has several no-data values of its own in QGIS: save it as a GeoTIFF and "
                                     "take that")
    return RasterInput(layer.name(), path, crs, ranges[0].min() if ranges else None)


HEIGHTS = {QgsWkbTypes.PolygonGeometry: 1, QgsWkbTypes.LineGeometry: 2, QgsWkbTypes.PointGeometry: 3}  # of layers of a run


def load_style(layer: QgsMapLayer) -> bool:
    """Load the style that lies in a layer's file or beside it, as FILE.qml. QGIS 3.40 does not find that of a mesh, whose source
    has its driver before the path.

    Return whether there is one."""
    beside = pathlib.Path(re.sub(r'^\w+:"(.*)"$', r"\1", layer.source())).with_suffix(".qml")
    is_beside = isinstance(layer, QgsMeshLayer) and beside.is_file()
    _, loaded = layer.loadNamedStyle(str(beside)) if is_beside else layer.loadDefaultStyle()
    return bool(loaded)


class _AsMade(QgsProcessingLayerPostProcessorInterface):
    """Gives a new layer the style that lies in or beside its file, else one of its own, a CRS that its format has no place
    for, and its place among the layers of the run: those that hide most are at the bottom."""

    def __init__(self, crs: QgsCoordinateReferenceSystem, on_top: bool, style: Style | None) -> None:
        super().__init__()
        self.crs = crs
        self.on_top = on_top
        self.style = style
        self.layer_id = ""
        self.height = 0

    def postProcessLayer(self, layer: QgsMapLayer, context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> None:
        if self.crs.isValid() and not layer.crs().isValid():
            layer.setCrs(self.crs)
        if not load_style(layer) and self.style is not None:
            self.style(layer)
        layer.triggerRepaint()
        self.layer_id = layer.id()
        self.height = 4 if self.on_top else HEIGHTS.get(layer.geometryType(), 0) if isinstance(layer, QgsVectorLayer) else 0
        self.place(layer.project(), context)

    def place(self, project: QgsProject, context: QgsProcessingContext) -> None:
        """Move the layer over those of the run that it hides less than they hide it (QGIS opens them by their names)."""
        node = project.layerTreeRoot().findLayer(self.layer_id) if project is not None else None
        if node is None:
            return
        siblings = node.parent().children()
        heights = {one.layer_id: one.height for one in _kept if not sip.isdeleted(one) and one.layer_id and any(
            details.postProcessor() is one for details in context.layersToLoadOnCompletion().values())}
        places = {at: heights[one.layerId()] for at, one in enumerate(siblings)
                  if isinstance(one, QgsLayerTreeLayer) and one.layerId() in heights}
        here = siblings.index(node)
        below = [at for at, height in places.items() if height < self.height and at < here]
        above = [at for at, height in places.items() if height > self.height and at > here]
        if below or above:
            moved = node.clone()
            node.parent().insertChildNode(min(below) if below else max(above) + 1, moved)
            node.parent().removeChildNode(node)
            moved.setExpanded(True)  # as a layer that has just been opened


_kept: list[_AsMade] = []  # until their contexts, which own them, have gone: QGIS holds no reference to them
_keeping = threading.Lock()  # algorithms run in threads


def _show_as_made(details: QgsProcessingContext.LayerDetails, crs: str, on_top: bool = False,
                  style: Style | None = None) -> None:
    its = QgsCoordinateReferenceSystem()
    if crs:
        its.createFromUserInput(crs)
    processor = _AsMade(its, on_top, style)
    details.setPostProcessor(processor)
    with _keeping:
        _kept[:] = [one for one in _kept if not sip.isdeleted(one)] + [processor]


HINTS = {"raster": QgsProcessingUtils.LayerHint.Raster, "vector": QgsProcessingUtils.LayerHint.Vector,
         "mesh": QgsProcessingUtils.LayerHint.Mesh}


def open_after(context: QgsProcessingContext, source: str, title: str, output: str, kind: str, crs: str = "",
               project: QgsProject | None = None, on_top: bool = False, style: Style | None = None) -> None:
    """Let QGIS open a layer when the algorithm has ended.

    Parameters
    ----------
    context : QgsProcessingContext
        The run's.
    source : str
        The layer's file, with |layername= where it has several.
    title, output : str
        The layer's name for the user, and that of the output.
    kind : str
        raster, vector or mesh.
    crs : str
        Of a file that names none.
    project : QgsProject or None
        Where it is opened; None: in that of the run.
    on_top : bool
        Whether it lies over all others of the run.
    style : Style or None
        Of a layer whose file has none.
    """
    project = project or context.project()
    if project is None:
        return
    details = QgsProcessingContext.LayerDetails(title, project, output, HINTS[kind])
    details.forceName = True
    _show_as_made(details, crs, on_top, style)
    context.addLayerToLoadOnCompletion(source, details)


def style_after(context: QgsProcessingContext, source: str, style: Style) -> None:
    """Let a layer that QGIS opens anyway have its style."""
    if context.willLoadLayerOnCompletion(source):
        _show_as_made(context.layerToLoadOnCompletionDetails(source), "", style=style)


KINDS = {ogr.wkbLineString: "arcs", ogr.wkbMultiLineString: "arcs", ogr.wkbPoint: "nodes"}


def network_layers(written: list[str]) -> dict[str, str]:
    """Return the sources of the layers with arcs and with nodes in what the program wrote, by "arcs" and "nodes"."""
    found: dict[str, str] = {}
    for path in written:
        if not path.lower().endswith((".gpkg", ".shp", ".fgb", ".geojson")):
            continue
        opened = opened_vector(path)
        for number in range(opened.GetLayerCount() if opened is not None else 0):
            layer = opened.GetLayer(number)
            kind = KINDS.get(ogr.GT_Flatten(layer.GetGeomType()), "")
            if kind and kind not in found:
                found[kind] = f"{path}|layername={layer.GetName()}" if path.lower().endswith(".gpkg") else path
    return found
