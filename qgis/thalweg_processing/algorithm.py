# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the algorithms have in common."""
from __future__ import annotations

import contextlib
import math
import os
import tempfile
from typing import Any

from processing.core.ProcessingConfig import ProcessingConfig
from qgis.core import (QgsProcessing, QgsProcessingAlgorithm, QgsProcessingContext, QgsProcessingException,
                       QgsProcessingFeedback, QgsProcessingOutputDefinition, QgsProcessingOutputLayerDefinition,
                       QgsProcessingParameterDefinition, QgsProcessingParameterEnum, QgsProcessingParameterNumber,
                       QgsProcessingUtils)
from qgis.PyQt.QtCore import QUrl
from qgis.PyQt.QtGui import QIcon

from . import program
from .layers import File, RasterInput, VectorInput, crs_text, is_given

HERE = os.path.dirname(os.path.abspath(__file__))
MANUALS = (os.path.join(HERE, "help", "index.html"),  # of an installed plugin
           os.path.join(HERE, "..", "..", "docs", "qgis.md"))  # of the sources
NODATA = ("Treat DEM cells with this stored value as no-data, beside what the file declares; nan: treat every value as a "
          "height. Default: refuse values that look like undeclared no-data.")

LIMITS = {"at_most": "allowed", "at_least": "at least"}  # of checks, by their bound


def names(text: str) -> list[str]:
    """Return the words of a list with commas or spaces."""
    return text.replace(",", " ").split()


def ends_in(destination: Any, *endings: str) -> bool:
    """Return whether the file of a destination has one of these extensions, or gets one from QGIS."""
    said = destination.sink.staticValue() if isinstance(destination, QgsProcessingOutputLayerDefinition) else destination
    return not isinstance(said, str) or said == QgsProcessing.TEMPORARY_OUTPUT or said.lower().endswith(endings)


def is_part_of_another(feedback: QgsProcessingFeedback) -> bool:
    """Return whether another algorithm, such as a model, runs this one: it then reports a part of that one's progress."""
    return feedback.metaObject().className() == "QgsProcessingMultiStepFeedback"


class Algorithm(QgsProcessingAlgorithm):
    """One command of the program."""

    COMMAND = ""
    TITLE = ""
    GROUP = ""
    TEXT = ""
    TAGS: tuple[str, ...] = ()

    def __init__(self) -> None:
        super().__init__()
        self.said: dict[str, str] = {}  # help of parameters and outputs
        self.inputs: dict[str, VectorInput | RasterInput | None] = {}
        self.new_folders: list[str] = []  # of outputs, the innermost first

    def createInstance(self) -> Algorithm:
        return type(self)()

    def name(self) -> str:
        return self.COMMAND

    def displayName(self) -> str:
        return self.TITLE

    def group(self) -> str:
        return self.GROUP

    def groupId(self) -> str:
        return self.GROUP.lower()

    def tags(self) -> list[str]:
        return ["thalweg", self.COMMAND, *self.TAGS]

    def icon(self) -> QIcon:
        return QIcon(os.path.join(HERE, "icon.svg"))

    def svgIconPath(self) -> str:
        return os.path.join(HERE, "icon.svg")

    def shortDescription(self) -> str:
        return self.TEXT.split("\n", 1)[0]

    def shortHelpString(self) -> str:
        paragraphs = self.TEXT.replace("\n", "</p><p>")  # QGIS writes the outer ones
        return QgsProcessingUtils.formatHelpMapAsHtml({"ALG_DESC": paragraphs, **self.said}, self)

    def helpUrl(self) -> str:
        """Return the manual, which the button Help opens."""
        found = [os.path.normpath(manual) for manual in MANUALS if os.path.exists(manual)]
        return QUrl.fromLocalFile(found[0]).toString() if found else ""

    def canExecute(self) -> tuple[bool, str]:
        try:
            program.find()
        except program.ProgramError as why:
            return False, str(why)
        return True, ""

    def add(self, parameter: QgsProcessingParameterDefinition, text: str, advanced: bool = False) -> None:
        """Declare a parameter with its help."""
        if advanced:
            parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        parameter.setHelp(text)
        self.said[parameter.name()] = text
        self.addParameter(parameter)

    def add_load(self, titles: list[str], default: list[int], text: str = "") -> None:
        """Declare LOAD, the layers that QGIS opens when the algorithm has ended."""
        self.add(QgsProcessingParameterEnum("LOAD", "Open after running", titles, allowMultiple=True, optional=True,
                                            defaultValue=default),
                 f"Layers that QGIS opens, of those that are written. {text}A model opens its own outputs only.".strip())

    def opened(self, parameters: dict[str, Any], context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> list[int]:
        """Return which layers of LOAD are to be opened."""
        wants_none = parameters.get("LOAD") in ([], "")  # without the parameter, its default holds
        return [] if wants_none or is_part_of_another(feedback) else self.parameterAsEnums(parameters, "LOAD", context)

    def give(self, output: QgsProcessingOutputDefinition, text: str) -> None:
        """Declare an output with its help."""
        self.said[output.name()] = text
        self.addOutput(output)

    def is_set(self, parameters: dict[str, Any], name: str) -> bool:
        """Return whether the user gave a parameter."""
        return is_given(parameters.get(name))

    def word(self, parameters: dict[str, Any], name: str, context: QgsProcessingContext) -> str:
        """Return a parameter as a word for the program, "" where it is not set."""
        if not self.is_set(parameters, name):
            return ""
        definition = self.parameterDefinition(name)
        if definition.type() == "number":
            whole = definition.dataType() == definition.Integer
            return str(self.parameterAsInt(parameters, name, context)) if whole else (
                repr(self.parameterAsDouble(parameters, name, context)))
        if definition.type() == "enum":
            return self.parameterAsEnumString(parameters, name, context)
        return self.parameterAsString(parameters, name, context).strip()

    def crs(self, parameters: dict[str, Any], name: str, context: QgsProcessingContext) -> str:
        """Return a CRS as the program takes it, "" where it is not set."""
        if not self.is_set(parameters, name):
            return ""
        crs = self.parameterAsCrs(parameters, name, context)
        if not crs.isValid():
            raise QgsProcessingException(f"{name}: '{parameters[name]}' is not a CRS that QGIS knows")
        return crs_text(crs)

    def options(self, parameters: dict[str, Any], context: QgsProcessingContext, **flags: str) -> list[str]:
        """Return the options of parameters that are set, given as NAME=option."""
        found = []
        for name, flag in flags.items():
            if word := self.word(parameters, name, context):
                found.append(f"{flag}={word}")
        return found

    def fields(self, parameters: dict[str, Any], context: QgsProcessingContext) -> list[str]:
        """Return --field options of the parameter FIELDS."""
        return [f"--field={word}" for word in names(self.word(parameters, "FIELDS", context))]

    def file(self, parameters: dict[str, Any], name: str, context: QgsProcessingContext) -> str:
        """Return the absolute path of an output, "" where it is not wanted; makes the folder that it goes into."""
        if not self.is_set(parameters, name):
            return ""
        path = self.parameterAsFileOutput(parameters, name, context)
        if not path:
            return ""
        path = os.path.abspath(path)
        stem, ending = os.path.splitext(path)
        existing = [one for one in (path, f"{stem}_arcs{ending}", f"{stem}_nodes{ending}") if os.path.exists(one)]
        for taken in self.inputs.values():  # the program does not know the file of one that has been exported
            if taken is not None and os.path.exists(taken.origin) and (
                    any(os.path.samefile(one, taken.origin) for one in existing)):
                raise QgsProcessingException(f"{name}: {path} would replace the file of the layer {taken.layer_name}: name "
                                             "another")
        missing, folder = [], os.path.dirname(path)
        while not os.path.exists(folder):
            missing.append(folder)
            folder = os.path.dirname(folder)
        self.new_folders = missing + self.new_folders
        try:
            os.makedirs(os.path.dirname(path), exist_ok=True)
        except OSError as why:
            raise QgsProcessingException(f"{name}: cannot make the folder of {path}: {why.strerror}") from why
        return path

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:
        """Refuse what QGIS would silently take for 0, and what no program can be given."""
        for name, value in parameters.items():
            definition = self.parameterDefinition(name)
            if isinstance(value, str) and "\0" in value:
                return False, f"{name}: a text with a null character"
            if definition is not None and definition.type() == "number" and isinstance(value, (str, float)) and value != "":
                whole = definition.dataType() == QgsProcessingParameterNumber.Integer
                try:
                    number = float(value)
                except ValueError:
                    return False, f"{name}: '{value}' is not a number; write it as 1.5"
                if not math.isfinite(number) or (whole and number != int(number)):
                    return False, f"{name}: '{value}' is not a {'whole' if whole else 'finite'} number"
        return super().checkParameterValues(parameters, context)

    def prepareAlgorithm(self, parameters: dict[str, Any], context: QgsProcessingContext,
                         feedback: QgsProcessingFeedback) -> bool:
        self.inputs = self.take(parameters, context)
        return True

    def processAlgorithm(self, parameters: dict[str, Any], context: QgsProcessingContext,
                         feedback: QgsProcessingFeedback) -> dict[str, Any]:
        try:
            found = program.find()
        except program.ProgramError as why:
            raise QgsProcessingException(str(why)) from why
        try:
            temporary = tempfile.TemporaryDirectory(prefix="thalweg-", dir=QgsProcessingUtils.tempFolder(),
                                                    ignore_cleanup_errors=True)
        except OSError as why:
            raise QgsProcessingException(f"cannot write to the folder for temporary files, {QgsProcessingUtils.tempFolder()}: "
                                         f"{why.strerror}. Settings > Options > Processing > General names it.") from why
        try:
            with temporary as folder:
                return self.run_in(folder, found, parameters, context, feedback)
        finally:
            for made in self.new_folders:
                with contextlib.suppress(OSError):
                    os.rmdir(made)  # where nothing has come into it

    def run_in(self, folder: str, found: program.Program, parameters: dict[str, Any], context: QgsProcessingContext,
               feedback: QgsProcessingFeedback) -> dict[str, Any]:
        """Run the command with a folder for what must be written for it."""
        files = self.written(folder, context, feedback)
        if not feedback.isCanceled():
            self.settle(folder, found, parameters, context, files, feedback)
        if feedback.isCanceled():
            return {}
        arguments = [self.COMMAND, *self.arguments(parameters, context, files), "--json", "--progress"]
        threads = ProcessingConfig.getSetting(ProcessingConfig.MAX_THREADS)
        if threads and int(threads) > 0:
            arguments.append(f"--threads={int(threads)}")
        finished = program.run(found, arguments, folder, feedback)
        return {} if finished is None else self.results(finished, parameters, context, feedback)

    def written(self, folder: str, context: QgsProcessingContext, feedback: QgsProcessingFeedback) -> dict[str, File]:
        """Return the files of the inputs; those that must be written, in this folder."""
        return {name: taken.as_file(folder, context, feedback) for name, taken in self.inputs.items() if taken is not None}

    def settle(self, folder: str, found: program.Program, parameters: dict[str, Any], context: QgsProcessingContext,
               files: dict[str, File], feedback: QgsProcessingFeedback) -> None:
        """Decide what the program must be asked for before it runs."""

    def take(self, parameters: dict[str, Any], context: QgsProcessingContext) -> dict[str, VectorInput | RasterInput | None]:
        """Return the layers of the parameters, in the thread that they live in."""
        raise NotImplementedError

    def arguments(self, parameters: dict[str, Any], context: QgsProcessingContext, files: dict[str, File]) -> list[str]:
        """Return the command's arguments, without those that all commands have."""
        raise NotImplementedError

    def results(self, finished: program.Finished, parameters: dict[str, Any], context: QgsProcessingContext,
                feedback: QgsProcessingFeedback) -> dict[str, Any]:
        """Return the outputs, and let QGIS open what the user wants to see."""
        raise NotImplementedError


def warn_of_failed(report: dict[str, Any], feedback: QgsProcessingFeedback) -> None:
    """Name the checks that failed in a warning."""
    failed = [check for check in report.get("checks", []) if not check["ok"]]
    if failed:
        said = ", ".join(f"{check['name']} ({check['value']:g}, {LIMITS[check.get('bound', 'at_most')]} {check['limit']:g})"
                         for check in failed)
        feedback.pushWarning(f"These checks failed: {said}")
