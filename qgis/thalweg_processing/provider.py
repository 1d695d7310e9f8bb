# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The provider of thalweg's algorithms."""
from __future__ import annotations

import os

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from . import program
from .blend import Blend
from .check import Check
from .convert import Convert
from .draw import Draw
from .make import Make
from .measure import Measure
from .rebuild import Rebuild
from .tin import Tin

ICON = os.path.join(os.path.dirname(__file__), "icon.svg")


class Provider(QgsProcessingProvider):
    """Algorithms that run the program thalweg."""

    def id(self) -> str:
        return "thalweg"

    def name(self) -> str:
        return "thalweg"

    def longName(self) -> str:
        """Return the name with the version of the program, where there is one."""
        version = self.versionInfo()
        return f"thalweg ({version})" if version else "thalweg"

    def versionInfo(self) -> str:
        try:
            return program.find().version
        except program.ProgramError:
            return ""

    def icon(self) -> QIcon:
        return QIcon(ICON)

    def svgIconPath(self) -> str:
        return ICON

    def load(self) -> bool:
        """Add the setting and the algorithms."""
        ProcessingConfig.settingIcons[self.name()] = self.icon()
        ProcessingConfig.addSetting(Setting(self.name(), program.SETTING, "Program thalweg (empty: that in PATH)", "",
                                            valuetype=Setting.FILE))
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self) -> None:
        ProcessingConfig.removeSetting(program.SETTING)
        ProcessingConfig.settingIcons.pop(self.name(), None)

    def loadAlgorithms(self) -> None:
        for algorithm in (Make, Rebuild, Check, Convert, Measure, Tin, Blend, Draw):
            self.addAlgorithm(algorithm())

    def supportsNonFileBasedOutput(self) -> bool:
        return False

    def defaultVectorFileExtension(self, hasGeometry: bool = True) -> str:
        return "gpkg"

    def defaultRasterFileExtension(self) -> str:
        return "tif"

    def supportedOutputVectorLayerExtensions(self) -> list[str]:
        return ["gpkg", "shp"]  # of check: convert has its own

    def supportedOutputRasterLayerExtensions(self) -> list[str]:
        return ["tif"]
