# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""thalweg check."""
from __future__ import annotations

from collections import Counter
from typing import Any

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingException, QgsProcessingFeedback,
                       QgsProcessingOutputBoolean, QgsProcessingOutputLayerDefinition, QgsProcessingOutputNumber,
                       QgsProcessingOutputVectorLayer,
                       QgsProcessingParameterEnum, QgsProcessingParameterNumber, QgsProcessingParameterRasterLayer,
                       QgsProcessingParameterString, QgsProcessingParameterVectorDestination, QgsProject)

from .advice import in_qgis
from .algorithm import LIMITS, NODATA, ends_in, warn_of_failed
from .layers import File, RasterInput, VectorInput, network_layers, open_after, raster_input
from .network_input import MAIN, MAIN_HELP, NetworkAlgorithm
from .program import Finished

SHOWN = 20  # findings, and repairs, in the log


class Check(NetworkAlgorithm):
    """Check a network, and repair it."""

    COMMAND = "check"
    TITLE = "Check river network"
    GROUP = "Networks"
    TEXT = ("Check the topology of a river network, and its drainage on a DEM.\n"
            "Every arc is checked: it runs from node to node and downhill, meets other arcs at its ends only, and has the "
            "right orders and downstream arc. A network in another schema is checked for what it contains. A fault is "
            "reported once, without its consequences. The network itself is never changed.\n"
            "With a DEM these also fail: depressions, rivers along the border of the DEM, sources whose water does not reach "
            "their outlet, and rivers that flow paths do not follow.")
    TAGS = ("topology", "validate", "repair", "fix", "rivers", "streams")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:
        self.add_network()
        self.add(QgsProcessingParameterRasterLayer("DEM", "DEM", optional=True),
                 "Also check that this DEM drains, and by these rivers; the repair finds the flow direction of lines by it. "
                 "It must have the network's CRS or, of a network in degrees, be in its UTM zone: the network is then "
                 "reprojected.")
        self.add(QgsProcessingParameterNumber("NEAR", "Distance of near line ends [m]", QgsProcessingParameterNumber.Double,
                                              optional=True, minValue=0),
                 "Report line ends closer than this to a line that they do not meet; the repair joins those that meet no other "
                 "line. Default: a millionth of the network's extent.")
        self.add(QgsProcessingParameterEnum("MAIN", "Main stems of the repaired network by", MAIN, optional=True,
                                            usesStaticStrings=True), MAIN_HELP, advanced=True)
        self.add(QgsProcessingParameterString("NODATA", "No-data value of the DEM", optional=True), NODATA, advanced=True)
        self.add(QgsProcessingParameterVectorDestination("FIX", "Repaired network", QgsProcessing.TypeVectorLine, optional=True,
                                                         createByDefault=False),
                 "A repaired copy in the native schema: arcs, and nodes in a second layer. Nothing is written if faults "
                 "remain. The network may then be any lines.")
        self.add(QgsProcessingParameterVectorDestination("FINDINGS", "Findings", QgsProcessing.TypeVectorPoint, optional=True),
                 "The findings as points (GeoPackage). Without findings, QGIS does not open it.")
        self.give(QgsProcessingOutputBoolean("OK", "Every check passed"), "Whether every check passed.")
        self.give(QgsProcessingOutputNumber("FINDINGS_COUNT", "Number of findings"), "Number of findings.")
        self.give(QgsProcessingOutputVectorLayer("FIXED_NODES", "Nodes of the repaired network", QgsProcessing.TypeVectorPoint),
                  "Nodes of the repaired network.")

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:
        if wrong := self.check_fields(parameters, context):
            return False, wrong
        if self.is_set(parameters, "FINDINGS") and not ends_in(parameters["FINDINGS"], ".gpkg"):
            return False, "FINDINGS: thalweg writes findings to a GeoPackage (.gpkg)"
        if self.is_set(parameters, "FIX") and not ends_in(parameters["FIX"], ".gpkg", ".shp"):
            return False, "FIX: thalweg writes a repaired network to a GeoPackage (.gpkg) or shapefiles (.shp)"
        return super().checkParameterValues(parameters, context)

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        return {**self.take_network(parameters, context), "DEM": raster_input(self, parameters, "DEM", context)}

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        self.fix = self.file(parameters, "FIX", context)
        self.findings = self.file(parameters, "FINDINGS", context)
        if self.fix and self.fix == self.findings:
            raise QgsProcessingException("FIX and FINDINGS: name two files")
        options = self.network_options(parameters, context, files)
        options += self.options(parameters, context, NEAR="--near", MAIN="--main", NODATA="--nodata")
        options += [f"--dem={files['DEM'].path}"] if "DEM" in files else []
        options += [f"--fix={self.fix}"] if self.fix else []
        options += [f"--findings={self.findings}"] if self.findings else []
        return [files["NETWORK"].path, *options, "--overwrite"]

    def results(self, finished: Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        report = finished.report
        warn_of_failed(report, feedback)
        say(report["findings"], "finding", feedback)
        if finished.passed and report["findings"]:
            feedback.pushInfo(f"All checks passed. {allowance(report['checks'])}")
        say(report["mended"], "repair", feedback)
        for note in report["notes"]:
            if not any(note["text"] in line for line in finished.heard):
                feedback.pushInfo(f"note: {in_qgis(note['text'])}")
        found: dict[str, Any] = {"OK": finished.passed, "FINDINGS_COUNT": len(report["findings"])}
        if self.findings:
            found["FINDINGS"] = self.findings
            project = project_of(parameters, "FINDINGS")
            if project and report["findings"]:
                open_after(context, self.findings, "Findings", "FINDINGS", "vector", project=project, on_top=True)
        if self.fix:
            if not any(path.startswith(self.fix.rpartition(".")[0]) for path in report["written"]):
                feedback.pushWarning("Faults remain: no repaired network was written")
                return found
            layers = network_layers(report["written"])
            for name, kind, title in (("FIX", "arcs", "Repaired arcs"), ("FIXED_NODES", "nodes", "Repaired nodes")):
                if kind in layers:
                    found[name] = layers[kind]
                    if project := project_of(parameters, "FIX"):
                        open_after(context, layers[kind], title, name, "vector", project=project)
        return found


def say(found: list[dict[str, Any]], what: str, feedback: QgsProcessingFeedback) -> None:
    """Count findings or repairs by kind, and list the first: those of rare kinds before those of common ones."""
    if not found:
        return
    kinds = Counter(one["kind"] for one in found)
    counted = ", ".join(f"{number} {kind}" for kind, number in kinds.most_common())
    feedback.pushInfo(f"{len(found)} {what}{'s' if len(found) > 1 else ''}: {counted}")
    for one in sorted(found, key=lambda one: kinds[one["kind"]])[:SHOWN]:
        feedback.pushInfo(f"  {in_qgis(one['text'])}")
    if len(found) > SHOWN:
        feedback.pushInfo(f"  and {len(found) - SHOWN} more")


def allowance(checks: list[dict[str, Any]]) -> str:
    """Return which checks, with which limits, let findings pass."""
    bounds = [f"{check['name']} is {check['value']:g}, {LIMITS[check['bound']]} {check['limit']:g}" for check in checks
              if check["bound"] == "at_least" or 0 < check["value"] <= check["limit"]]
    return f"They allow findings within limits: {'; '.join(bounds)}" if bounds else "No check counts these findings."


def project_of(parameters: dict[str, Any], name: str) -> QgsProject | None:
    """Return the project that the user wants to have a destination in."""
    value = parameters.get(name)
    return value.destinationProject if isinstance(value, QgsProcessingOutputLayerDefinition) else None
