#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The ZIP of scripts/package qgis: the same bytes twice, and QGIS lists and runs the algorithms that were installed from it."""
import configparser
import html
import json
import os
import re
import subprocess
import sys
import zipfile

from support import ENVIRONMENT, JACKSBORO, ROOT, Case, main, qgis_process


HELP = """
import os, sys
sys.path[:0] = [os.environ["PLUGINS"], "/usr/share/qgis/python", "/usr/share/qgis/python/plugins"]
from qgis.core import QgsApplication
application = QgsApplication([], False)
application.initQgis()
from qgis.PyQt.QtCore import QUrl
from thalweg_processing.check import Check
print(QUrl(Check().helpUrl()).toLocalFile(), flush=True)
os._exit(0)
"""


class Package(Case):
    def packed(self, name, **environment):
        """A ZIP that the script makes in a new folder."""
        folder = self.folder / name
        folder.mkdir()
        done = subprocess.run([sys.executable, ROOT / "qgis/pack.py", folder], check=True, capture_output=True, text=True,
                              env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000", **environment})
        path, = folder.iterdir()
        self.assertEqual(done.stdout.strip(), str(path))
        return path

    def test_same_bytes_twice(self):
        one, other = self.packed("one"), self.packed("other", TZ="Asia/Tokyo", PYTHONHASHSEED="5", LC_ALL="C")
        self.assertEqual(one.name, other.name)
        self.assertEqual(one.read_bytes(), other.read_bytes())
        with zipfile.ZipFile(one) as packed:
            names = packed.namelist()
            self.assertEqual(names, sorted(names))
            self.assertEqual({name.split("/")[0] for name in names}, {"thalweg_processing"})
            self.assertLessEqual({f"thalweg_processing/{name}"
                                  for name in ("metadata.txt", "__init__.py", "icon.svg", "LICENSE")}, set(names))
            self.assertEqual({info.date_time for info in packed.infolist()}, {(2023, 11, 14, 22, 13, 20)})
            metadata = configparser.ConfigParser(interpolation=None)
            metadata.read_string(packed.read("thalweg_processing/metadata.txt").decode())
        version = re.search(r"^project\(thalweg VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
        self.assertEqual(metadata["general"]["version"], version)
        self.assertIn(version, one.name)
        self.assertEqual((metadata["general"]["qgisMinimumVersion"], metadata["general"]["hasProcessingProvider"]),
                         ("3.22", "yes"))

    def test_it_has_a_manual(self):
        """The button Help opens it; its pictures and links are there."""
        plugins = self.folder / "plugins"
        with zipfile.ZipFile(self.packed("one")) as packed:
            packed.extractall(plugins)
        page = plugins / "thalweg_processing/help/index.html"
        text = page.read_text("utf-8")
        for name in re.findall(r'<img src="([^"]+)"', text):
            self.assertTrue((page.parent / name).read_bytes().startswith(b"\x89PNG"), name)
        for name in re.findall(r'<a href="([^"]+)"', text):
            self.assertTrue(name.startswith("https://") or f'id="{name[1:]}"' in text, name)
        shown = html.unescape(re.sub(r"<[^>]+>", "", re.sub(r"(?s)<style>.*?</style>", "", text)))
        for mark in ("`", "**", "](", "\n#", "|--"):
            self.assertNotIn(mark, re.sub(r"(?s)<pre>.*?</pre>", "", text))
        for words in ("Check river network", "When something is wrong", "thalweg:make", "750 × 965 cells of 75 m"):
            self.assertIn(words, shown)
        said = subprocess.run([sys.executable, "-c", HELP], env={**ENVIRONMENT, "PLUGINS": str(plugins)}, capture_output=True,
                              text=True, check=True)
        self.assertEqual(said.stdout.strip(), str(page), said.stderr)

    def test_installed_into_an_empty_profile(self):
        home = self.folder / "home"
        plugins = home / ".local/share/QGIS/QGIS3/profiles/default/python/plugins"
        plugins.mkdir(parents=True)
        with zipfile.ZipFile(self.packed("one")) as packed:
            packed.extractall(plugins)
        environment = {name: value for name,
                       value in ENVIRONMENT.items() if name not in ("QGIS_PLUGINPATH", "QGIS_CUSTOM_CONFIG_PATH")}
        environment["HOME"] = str(home)
        self.assertEqual(qgis_process("plugins", "enable", "thalweg_processing", environment=environment).returncode, 0)
        listed = json.loads(qgis_process("--json", "list", environment=environment).stdout)
        self.assertEqual(len(listed["providers"]["thalweg"]["algorithms"]), 8)
        done = qgis_process("run", "thalweg:tin", "--", f"DEM={JACKSBORO}", "ERROR=30", f"OUTPUT={self.folder / 'tin.2dm'}",
                            environment=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / "tin.2dm").exists())


if __name__ == "__main__":
    main()
