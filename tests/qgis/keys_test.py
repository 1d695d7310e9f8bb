#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the plugin offers is what the program takes."""
import html
import json
import pathlib
import re

from support import COAST, JACKSBORO, PLUGINS, PROGRAM, SMALL, Case, main, program, start

application, plugin = start()

from qgis.core import (QgsApplication, QgsProcessingContext, QgsProcessingParameterNumber,  # noqa: E402
                       QgsProcessingParameterDefinition)
from processing.gui.AlgorithmDialog import AlgorithmDialog  # noqa: E402
from thalweg_processing import make, program as runner, rebuild  # noqa: E402
from thalweg_processing.keys import GROUPS, group_of, label_of  # noqa: E402

KEYS = json.loads(program("recipe", "--json").stdout)["keys"]
SOURCES = {path.stem: path.read_text() for path in pathlib.Path(PLUGINS, "thalweg_processing").glob("*.py")}


def algorithm(name):
    return QgsApplication.processingRegistry().createAlgorithmById(f"thalweg:{name}")


def value_of(key):
    """A value that a key takes, other than its default where it can be."""
    least, greatest = make.bounds(key)
    if key["type"] == "integer":
        return int(greatest) if greatest is not None and greatest < 99 else int((least or 0) + 9)
    if key["type"] == "number":
        return ((least or 0) + min(greatest if greatest is not None else 1, (least or 0) + 1)) / 2
    numbers = {"two numbers": "3, 4.5", "three numbers": "[3,4,5]", "four numbers": "0 0 9 9"}
    return key["choices"][-1] if key["choices"] else numbers.get(key["type"], "x")


class WhatTheProgramTakes(Case):
    def test_every_option_is_one_of_its_command(self):
        shared = ("algorithm", "program")
        for command in runner.STAGES:
            said = program("help", command).stdout
            files = [command, *shared] + (["network_input"] if command in ("check", "convert", "measure") else [])
            files += ["make"] if command == "rebuild" else []
            options = {found for file in files for found in re.findall(r"(?<![\w-])--[a-z][a-z-]+", SOURCES[file])}
            options -= {"--help", "--version"}
            if command not in ("check", "convert", "measure"):
                options.discard("--field")
            self.assertGreater(len(options), 5)
            for option in options:
                self.assertRegex(said, rf"(?m){option}(?![\w-])", f"{command} has no {option}")

    def test_every_option_of_a_command_is_offered_or_left_out_with_a_reason(self):
        left_out = {"--help", "--threads", "--quiet", "--verbose", "--progress", "--json", "--overwrite", "--output",
                    "--device",  # the program's own default
                    "--set", "--seed", "--crs", "--units", "--schema", "--field", "--where", "--only",  # of make: keys
                    "--dry-run",  # no run
                    "--ensemble", "--seeds", "--vary", "--shards", "--share",  # many terrains, for which QGIS has batch runs
                    "--source-crs", "--layer", "--arcs-layer", "--nodes-layer",  # of the layer
                    "--band", "--encoding",  # of files of several bands, of which QGIS takes one: Raster > Translate
                    "--raw-size", "--raw-cell", "--raw-heights",  # of heightmaps, which QGIS does not show
                    "--from", "--table"}  # FROM; a database is no file
        for command in runner.STAGES:
            sources = SOURCES[command] + SOURCES["network_input"] + SOURCES["algorithm"]
            for option in set(re.findall(r"(?m)^ {2,6}(?:-\w, )?(--[a-z-]+)", program("help", command).stdout)) - left_out:
                self.assertIn(f'"{option}', sources.replace("f\"", "\"").replace("[\"", "\""), f"{command} {option}")

    def test_every_word_of_a_choice_is_taken(self):
        for command, option, words in (("tin", "--format", "FORMATS"), ("convert", "--format", "FORMATS"),
                                       ("draw", "--what", "WHAT"),
                                       ("measure", "--what", "WHAT"), ("check", "--schema", "SCHEMAS")):
            module = __import__(f"thalweg_processing.{command if words != 'SCHEMAS' else 'network_input'}", fromlist=[words])
            said = re.search(rf"(?m:^ +{option}).*?(?=\n +-|\n\n)", program("help", command).stdout, re.DOTALL)[0]
            for word in getattr(module, words):
                self.assertRegex(said, rf"\b{word}\b", f"{command} {option} {word}")

    def test_every_key_is_a_parameter_of_its_type(self):
        instance = algorithm("make")
        names = [definition.name() for definition in instance.parameterDefinitions()]
        self.assertEqual(len(names), len({name.lower() for name in names}))
        kinds = {"integer": {"number"}, "number": {"number"}, "yes/no": {"enum"},
                 "text": {"string", "enum", "layer", "file", "field", "crs"},
                 "integer or text": {"enum"}, "two numbers": {"string"}, "three numbers": {"string"},
                 "four numbers": {"string"}, "list of words": {"string"}}
        for key in KEYS:
            if key["key"] in make.LEFT_OUT:
                self.assertTrue(make.LEFT_OUT[key["key"]])
                continue
            definition = instance.parameterDefinition(make.parameter_name(key["key"]))
            self.assertIsNotNone(definition, key["key"])
            self.assertIn(definition.type(), kinds[key["type"]], key["key"])
            self.assertTrue(definition.flags() & QgsProcessingParameterDefinition.FlagOptional, key["key"])
            self.assertIsNone(definition.defaultValue(), key["key"])
            if key["key"] not in make.PLAIN:
                self.assertTrue(definition.flags() & QgsProcessingParameterDefinition.FlagAdvanced, key["key"])
                self.assertEqual(definition.description().split(" [")[0], label_of(key["key"]))
                self.assertTrue(definition.help().endswith(f"Key: {key['key']}."))
            if definition.type() == "number":
                self.assertEqual(definition.dataType() == QgsProcessingParameterNumber.Integer, key["type"] == "integer",
                                 key["key"])
                self.assertLess(definition.minimum(), definition.maximum())
                numbers = re.findall(r"[-\d.e+]+", key["range"])
                self.assertEqual(definition.minimum(), float(numbers[0]), key["key"])
                if len(numbers) > 1:
                    self.assertEqual(definition.maximum(), min(float(numbers[1]), definition.maximum()), key["key"])
            elif definition.type() == "enum":
                self.assertEqual(definition.options(), key["choices"], key["key"])
                self.assertTrue(definition.usesStaticStrings())
            if key["key"] != "grid.crs":
                self.assertIn(html.escape(key["meaning"][1:], quote=False), definition.help())
        for key in [*make.PLAIN, *make.LEFT_OUT, *make.FIELDS, *make.TEXT_FILES]:
            self.assertIn(key, [known["key"] for known in KEYS])

    def test_keys_are_in_groups(self):
        """Each key has one; those of a group follow one another, those for rivers of a layer first, and the help has titles."""
        for command in ("make", "rebuild"):
            instance = algorithm(command)
            keys = {make.parameter_name(key["key"]): key["key"] for key in KEYS if key["key"] not in make.PLAIN}
            groups = [group_of(keys[definition.name()]) for definition in instance.parameterDefinitions()
                      if definition.name() in keys]
            self.assertEqual(groups, sorted(groups))
            self.assertLess(groups[-1], len(GROUPS))
            said = instance.shortHelpString()
            places = [said.index(f"<h2>{GROUPS[group][0]}</h2>") for group in sorted(set(groups))]
            self.assertEqual(places, sorted(places))
        self.assertEqual({group_of(key["key"]) for key in KEYS if key["key"] not in make.PLAIN}, set(range(len(GROUPS))))
        for key in KEYS:  # other ways to make terrain have groups of their own
            if key["key"].startswith("surface.") and 'surface.method = "equilibrium"' in key["used_by"]:
                self.assertEqual(GROUPS[group_of(key["key"])][0], "Terrain", key["key"])
            if key["used_by"].startswith('surface.method = "diffuse"'):
                self.assertEqual(GROUPS[group_of(key["key"])][0], "Diffused terrain", key["key"])
        self.assertEqual(label_of("network.dla.particles"), "Grown rivers, DLA: particles")

    def test_a_dialog_as_it_opens_sets_nothing(self):
        for command in ("make", "tin"):  # the others want a layer
            instance = algorithm(command)
            dialog = AlgorithmDialog(algorithm(command))  # which owns that one
            parameters = dialog.createProcessingParameters()
            self.assertLessEqual({"OUTPUT", "LOAD"}, set(parameters))
            context = QgsProcessingContext()
            if command == "make":
                self.assertEqual(instance.checkParameterValues(parameters, context), (True, ""))
                instance.inputs = instance.take(parameters, context)
                self.assertEqual(instance.settings(parameters, context, {}), {})
                self.assertEqual([word.split("=")[0] for word in instance.arguments(parameters, context, {})],
                                 ["--output", "--overwrite"])
            else:
                self.assertIn("not none", instance.checkParameterValues(parameters, context)[1])

    def test_every_value_is_read_as_it_was_given(self):
        """A dry run takes one value of each key; what it refuses is not how the value is written."""
        for key in KEYS:
            if key["key"] in make.LEFT_OUT or key["is_file"] or key["key"] in (*make.FIELDS, "grid.crs"):
                continue
            instance = algorithm("make")
            instance.grid = {}
            value = value_of(key)
            settings = instance.settings({make.parameter_name(key["key"]): value}, QgsProcessingContext(), {})
            self.assertEqual(list(settings), [key["key"]])
            done = program("make", "--dry-run", "--set", f"{key['key']}={settings[key['key']]}", "-o", self.folder / "x")
            self.assertNotRegex(done.stderr, "is required|must be one of|unknown key|cannot read the value",
                                f"{key['key']} {value}")

    def test_rebuild_has_the_keys_of_make_that_are_of_use(self):
        """A dry run takes one value of each key; a key of no use is refused with the rivers or the method that it needs."""
        made, instance = self.folder / "made", algorithm("rebuild")
        self.assertEqual(program("make", *SMALL, "-o", made).returncode, 0)
        useless = r"it needs (network\.source|source|surface\.method|no \[network\])|do not go together|does not go with"
        for key in KEYS:
            if key["key"] in (*make.LEFT_OUT, *rebuild.LEFT_OUT):
                self.assertIsNone(instance.parameterDefinition(make.parameter_name(key["key"])))
                continue
            value = value_of(key)
            value = make.numbers_of(value, make.COUNTS[key["type"]]) if key["type"] in make.COUNTS else value
            done = program("rebuild", made, "--dry-run", "--set", f"{key['key']}={value}", "-o", self.folder / "x")
            if instance.parameterDefinition(make.parameter_name(key["key"])) is not None:
                self.assertNotRegex(done.stderr, useless, key["key"])
            elif done.returncode:  # 0: the value is the default
                self.assertRegex(done.stderr, useless, key["key"])
        for key in rebuild.LEFT_OUT:
            self.assertIn(key, [known["key"] for known in KEYS])

    def test_help_is_complete(self):
        for command in runner.STAGES:
            instance = algorithm(command)
            said = instance.shortHelpString()
            for definition in [*instance.parameterDefinitions(), *instance.outputDefinitions()]:
                self.assertTrue(definition.description()[:1], definition.name())
                self.assertTrue(instance.said.get(definition.name()), f"{command} {definition.name()} has no help")
            for definition in instance.parameterDefinitions():
                self.assertIn(definition.help()[:30], said)
            self.assertTrue(instance.shortDescription().endswith("."))
            self.assertTrue(instance.canExecute()[0])
            self.assertFalse(instance.icon().isNull())

    def test_versions(self):
        provider = QgsApplication.processingRegistry().providerById("thalweg")
        version, = re.findall(r"^thalweg (\S+) \(GDAL .*\)$", program("--version").stdout, re.MULTILINE)
        self.assertEqual((provider.versionInfo(), provider.longName()), (version, f"thalweg ({version})"))
        self.assertEqual(runner.find().path, str(PROGRAM))

    def test_shared_checks_come_before_the_program(self):
        context = QgsProcessingContext()
        for command, parameters, words in (
                ("blend",
                 {"TARGET": str(JACKSBORO), "SOURCE": str(JACKSBORO), "MASK": str(COAST), "MASK_RASTER": str(JACKSBORO)},
                 "Give MASK or MASK_RASTER, not both"),
                ("check", {"NETWORK": str(COAST), "FINDINGS": str(self.folder / "x.shp")}, "GeoPackage"),
                ("make", {"EXTENT": "0,1,0,1 [EPSG:4326]", "CRS": "EPSG:4326", "OUTPUT": "x"},
                 "CRS: give a projected CRS in metres, or leave it empty"),
                ("make", {"EXTENT": "0,1,0,1", "OUTPUT": "x"}, "CRS: give the CRS of this extent"),
                ("make", {"EXTENT": "0,900,0,900 [EPSG:32631]", "GRID_ORIGIN": "1,2", "OUTPUT": "x"},
                 "Give EXTENT or GRID_ORIGIN, not both"),
                ("make", {"DEM": str(JACKSBORO), "SURFACE_SOURCE": str(JACKSBORO), "OUTPUT": "x"}, "SURFACE_SOURCE"),
                ("tin", {"OUTPUT": "x.2dm"}, "not none"),
                ("tin", {"DEM": str(JACKSBORO), "BREAKLINES": str(COAST), "OUTPUT": "x.2dm"}, "takes no breaklines")):
            can, why = algorithm(command).checkParameterValues(parameters, context)
            self.assertFalse(can, parameters)
            self.assertIn(words, why)


if __name__ == "__main__":
    main()
