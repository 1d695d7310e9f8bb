# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The real QGIS for the tests of its plugin: a private profile, qgis_process, and QGIS itself without a window.
The environment's THALWEG is the program; PLUGINS, if set, the folder that holds the plugin instead of the sources."""
import atexit
import filecmp
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "samples"
COAST = SAMPLES / "coastal_nhdplus.gpkg"
JACKSBORO = SAMPLES / "jacksboro_utm16.tif"
BIGTUJUNGA = SAMPLES / "bigtujunga_srtm1_utm11.tif"
PROGRAM = pathlib.Path(os.environ["THALWEG"]).resolve()
PLUGINS = os.environ.get("PLUGINS", str(ROOT / "qgis"))
PROFILE = pathlib.Path(tempfile.mkdtemp(prefix="thalweg qgis ü-"))  # a user's folder may have such a name
atexit.register(shutil.rmtree, PROFILE, ignore_errors=True)
SMALL = ("--set=grid.width=128", "--set=grid.height=128", "--set=network.forest.outlet_spacing=0")  # a second's work

for name in ("home", "run", "temp"):
    (PROFILE / name).mkdir(mode=0o700)
ENVIRONMENT = {**os.environ, "HOME": str(PROFILE / "home"), "XDG_RUNTIME_DIR": str(PROFILE / "run"),
               "TMPDIR": str(PROFILE / "temp"),
               "QT_QPA_PLATFORM": "offscreen", "QGIS_CUSTOM_CONFIG_PATH": str(PROFILE / "home"), "QGIS_PLUGINPATH": PLUGINS,
               "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", "PYTHONDONTWRITEBYTECODE": "1", "LC_ALL": "C.UTF-8",
               "GDAL_PAM_ENABLED": "NO"}  # statistics beside the samples
# Debian 12 has a wrapper that passes an option which QGIS does not know.
QGIS_PROCESS = shutil.which("qgis_process.bin") or shutil.which("qgis_process")


def program(*arguments):
    """Run the program by itself."""
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, env=ENVIRONMENT,
                          stdin=subprocess.DEVNULL)


def qgis_process(*arguments, environment=None):
    """Run qgis_process."""
    return subprocess.run([QGIS_PROCESS, *map(str, arguments)], capture_output=True, text=True, env=environment or ENVIRONMENT,
                          stdin=subprocess.DEVNULL, timeout=300)


def run(algorithm, **parameters):
    """Run an algorithm of thalweg by qgis_process.

    Returns
    -------
    dict
        Its results; "error" and "log" hold what it said.
    """
    words = [f"{name}={value}" for name, value in parameters.items()]
    done = qgis_process("--json", "run", f"thalweg:{algorithm}", "--", *words)
    try:
        results = json.loads(done.stdout)["results"]
    except (ValueError, KeyError):
        results = {}
    return {**results, "error": done.stderr + done.stdout if done.returncode or not results else "", "log": done.stderr}


def same_files(test, one, other, without=("report.html", "report.json")):
    """Two folders hold the same files."""
    names = [sorted(p.relative_to(folder).as_posix() for p in pathlib.Path(folder).rglob("*") if p.is_file())
             for folder in (one, other)]
    names = [[name for name in some if name not in without] for some in names]
    test.assertEqual(*names)
    test.assertTrue(names[0])
    for name in names[0]:
        test.assertTrue(filecmp.cmp(pathlib.Path(one) / name, pathlib.Path(other) / name, shallow=False), name)


class Case(unittest.TestCase):
    """A test with a folder of its own; its name has a space and a quote."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="a b's ", dir=PROFILE))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def assert_layers(self, results, vectors=(), rasters=()):
        """Outputs are valid layers that are not empty."""
        from qgis.core import QgsRasterLayer, QgsVectorLayer
        for name in vectors:
            layer = QgsVectorLayer(results[name], name, "ogr")
            self.assertTrue(layer.isValid() and layer.featureCount() > 0 and layer.crs().isValid(), f"{name}: {results[name]}")
        for name in rasters:
            layer = QgsRasterLayer(results[name], name, "gdal")
            self.assertTrue(layer.isValid() and layer.width() > 1 and layer.crs().isValid(), f"{name}: {results[name]}")


def start():
    """Start QGIS in this process, with Processing and the plugin."""
    os.environ.update(ENVIRONMENT)
    tempfile.tempdir = str(PROFILE / "temp")
    sys.path += ["/usr/share/qgis/python", "/usr/share/qgis/python/plugins", PLUGINS]
    from qgis.core import QgsApplication
    application = QgsApplication([], True)  # styles need fonts
    application.initQgis()
    from processing.core.Processing import Processing
    Processing.initialize()
    from thalweg_processing import classFactory
    plugin = classFactory(None)
    plugin.initProcessing()
    return application, plugin


def main():
    """Run the tests of the script; QGIS may crash while Python takes its objects apart, so it does not."""
    done = unittest.main(module="__main__", exit=False, verbosity=2)
    shutil.rmtree(PROFILE, ignore_errors=True)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0 if done.result.wasSuccessful() and done.result.testsRun and not done.result.skipped else 1)
