# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parameters of commands that read a river network."""
from __future__ import annotations

from typing import Any

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingFeedback, QgsProcessingParameterEnum,
                       QgsProcessingParameterFeatureSource, QgsProcessingParameterString)

from .algorithm import Algorithm
from .layers import File, VectorInput, file_name, free_path, vector_input

SCHEMAS = ["native", "taudem", "nhdplus", "hydrorivers", "grass"]
MAIN = ["file", "name", "area", "length", "arbolate"]
MAIN_HELP = ("What tells the main stems: the file (its level paths, names, classes and areas, as far as it has them), or its "
             "names, its areas, the length of the flow path, the arbolate sum alone. Default: file.")


class NetworkAlgorithm(Algorithm):
    """A command that reads a network."""

    def add_network(self, optional: bool = False) -> None:
        """Declare NETWORK, NETWORK_NODES, FROM and FIELDS."""
        self.add(QgsProcessingParameterFeatureSource("NETWORK", "River network", [QgsProcessing.TypeVectorLine],
                                                     optional=optional),
                 "Lines of the rivers, in any schema that thalweg knows.")
        self.add(QgsProcessingParameterFeatureSource("NETWORK_NODES", "Nodes of the network", [QgsProcessing.TypeVectorPoint],
                                                     optional=True),
                 "Points of the network's nodes. Default: those in the file of the network.", advanced=True)
        self.add(QgsProcessingParameterEnum("FROM", "Schema of the network", SCHEMAS, optional=True, usesStaticStrings=True),
                 "Field names, units and line directions of the network. Default: recognised by its fields.", advanced=True)
        self.add(QgsProcessingParameterString("FIELDS", "Fields of the network", optional=True),
                 "Fields that hold quantities of the native schema, as QUANTITY=NAME, separated by commas: "
                 "arc_id=ID, ds_arc=NEXT_DOWN.", advanced=True)

    def check_fields(self, parameters: dict[str, Any], context: QgsProcessingContext) -> str:
        """Return what is wrong with FIELDS, "" where nothing is."""
        for option in self.fields(parameters, context):
            quantity, equals, name = option.removeprefix("--field=").partition("=")
            if not (quantity and equals and name):
                return f"FIELDS: write QUANTITY=NAME, such as ds_arc=NEXT_DOWN, not '{option.removeprefix('--field=')}'"
        if self.is_set(parameters, "NETWORK_NODES") and not self.is_set(parameters, "NETWORK"):
            return "NETWORK_NODES: give the network that these nodes belong to"
        return ""

    def take_network(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | None]:
        """Return NETWORK and NETWORK_NODES."""
        return {name: vector_input(self, parameters, name, context, takes_layer_name=True, takes_source_crs=True)
                for name in ("NETWORK", "NETWORK_NODES")}

    def written(self, folder: str, context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> dict[str, File]:
        network, nodes = self.inputs.get("NETWORK"), self.inputs.get("NETWORK_NODES")
        if not isinstance(network, VectorInput) or not isinstance(nodes, VectorInput):
            return super().written(folder, context, feedback)
        if network.file is not None and nodes.file is not None and network.file.path == nodes.file.path:
            return super().written(folder, context, feedback)
        path = free_path(folder, file_name(network.layer_name), ".gpkg")
        network.written(path, "arcs", context, feedback)
        nodes.written(path, "nodes", context, feedback)
        rest = {name: taken.as_file(folder, context, feedback) for name, taken in self.inputs.items()
                if taken is not None and name not in ("NETWORK", "NETWORK_NODES")}
        return {"NETWORK": File(path, "arcs"), "NETWORK_NODES": File(path, "nodes"), **rest}

    def network_options(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File],
                        schema_option: str = "--from") -> list[str]:
        """Return the options that tell how to read the network."""
        network, nodes = files.get("NETWORK"), files.get("NETWORK_NODES")
        if network is None:
            return []
        options = self.options(parameters, context, FROM=schema_option) + self.fields(parameters, context)
        options += [f"--layer={network.layer}"] if network.layer else []
        options += [f"--nodes-layer={nodes.layer}"] if nodes is not None and nodes.layer else []
        return options + ([f"--source-crs={network.source_crs}"] if network.source_crs else [])
