#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancelling ends the program and leaves nothing; what is wrong with a program is said in words."""
import json
import os
import re
import signal
import subprocess
import threading
import time

from support import COAST, PROGRAM, ROOT, Case, main, start

application, plugin = start()

from qgis.core import (QgsApplication, QgsProcessingContext, QgsProcessingException, QgsProcessingFeedback,  # noqa: E402
                       QgsProcessingUtils, QgsSettings)
from thalweg_processing import advice, program  # noqa: E402

LONG = {"GRID_WIDTH": 3000, "GRID_HEIGHT": 3000}
REPORT = ('{"findings": [], "mended": [], "notes": [], "written": [], '
          '"checks": [{"name": "spike", "value": 2, "limit": 0, "ok": false}]}')


class Said(QgsProcessingFeedback):
    def __init__(self):
        super().__init__()
        self.warnings, self.lines, self.commands, self.shares = [], [], [], []
        self.progressChanged.connect(self.shares.append)

    def pushWarning(self, text):
        self.warnings.append(text)

    def pushInfo(self, text):
        self.lines.append(text)

    def pushCommandInfo(self, text):
        self.commands.append(text)


def children():
    """The processes that this one started and that have not ended."""
    said = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(os.getpid())], capture_output=True, text=True).stdout
    return [line for line in said.splitlines() if line.split()[1] != "ps"]


def run(name, parameters, feedback):
    """As processing.run(), which does not tell the words of what failed before the algorithm itself ran."""
    algorithm = QgsApplication.processingRegistry().createAlgorithmById(f"thalweg:{name}")
    return algorithm.run(parameters, QgsProcessingContext(), feedback, {}, False)[0]


class WithSetting(Case):
    def use(self, path):
        QgsSettings().setValue(f"Processing/Configuration/{program.SETTING}", str(path))
        self.addCleanup(QgsSettings().remove, f"Processing/Configuration/{program.SETTING}")

    def fake(self, script, asked=True):
        """A program that answers as thalweg does to what the plugin asks, and else does as the script says."""
        path = self.folder / "fake"
        answers = f'case "$*" in --help | "recipe --json" | --version) exec {PROGRAM} "$@" ;; esac\n' if asked else ""
        path.write_text(f"#!/bin/sh\n{answers}{script}\n")
        path.chmod(0o755)
        self.use(path)
        return path


class Cancel(WithSetting):
    def cancelled(self, name, parameters, after, words=""):
        """Seconds from the cancelling to the end."""
        said = Said()
        at = []

        def cancel():
            at.append(time.monotonic())
            said.cancel()

        timer = threading.Timer(after, cancel)
        timer.start()
        results = run(name, parameters, said)
        timer.join()
        self.assertEqual(results, {})
        self.assertEqual(children(), [])
        self.assertEqual([name for name in os.listdir(QgsProcessingUtils.tempFolder()) if name.startswith("thalweg-")], [])
        return time.monotonic() - at[0]

    def test_a_long_make_ends_and_leaves_nothing(self):
        QgsProcessingUtils.tempFolder()
        temporary = set(os.listdir(os.environ["TMPDIR"]))
        for after in (0.05, 0.6, 2.5):
            self.assertLess(self.cancelled("make", {"OUTPUT": str(self.folder / "out"), **LONG}, after), 2.0)
            self.assertEqual(os.listdir(self.folder), [])
        self.assertEqual(set(os.listdir(os.environ["TMPDIR"])), temporary)

    def test_a_program_that_does_not_listen_is_killed(self):
        self.fake("trap '' INT\necho '{\"stage\": \"fill\", \"share\": 0.5}' >&2\nexec sleep 60")
        seconds = self.cancelled("check", {"NETWORK": str(COAST)}, 2)
        self.assertTrue(program.ENDS_WITHIN - 0.5 < seconds < program.ENDS_WITHIN + 2, seconds)

    def test_cancelled_before_it_runs(self):
        said = Said()
        said.cancel()
        self.assertEqual(run("check", {"NETWORK": str(COAST)}, said), {})
        self.assertEqual(said.commands, [])


class Wrong(WithSetting):
    def refused(self, words):
        """Every algorithm stays and says so, before it runs and when it is run."""
        for algorithm in QgsApplication.processingRegistry().providerById("thalweg").algorithms():
            can, why = algorithm.canExecute()
            self.assertFalse(can)
            self.assertRegex(why, words)
            self.assertIsNotNone(algorithm.create())
        with self.assertRaisesRegex(QgsProcessingException, words):
            run("make", {"OUTPUT": str(self.folder / "out")}, Said())
        self.assertFalse((self.folder / "out").exists())
        self.assertEqual(len(QgsApplication.processingRegistry().providerById("thalweg").algorithms()), 8)

    def test_not_in_path(self):
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = str(self.folder)
        self.refused("not in PATH. Install it .*Options > Processing > Providers > thalweg")

    def test_missing(self):
        self.use(self.folder / "none")
        self.refused("there is no program .*/none. Correct its name in Settings")

    def test_a_folder(self):
        self.use(self.folder)
        self.refused("is a folder. Name the program")

    def test_not_executable(self):
        self.fake("true").chmod(0o644)
        self.refused("fake is not executable")

    def test_too_old(self):
        self.fake("echo Usage: thalweg make", asked=False)
        self.refused("older than this plugin needs: it has no command rebuild")

    def test_another_program(self):
        self.use("/bin/false")
        self.refused("/bin/false --help: it ended with exit status 1")

    def test_no_program_at_all(self):
        path = self.folder / "text"
        path.write_bytes(b"\x7fELF nothing")
        path.chmod(0o755)
        self.use(path)
        self.refused("text does not start: ")

    def test_does_not_answer(self):
        self.addCleanup(setattr, program, "ASKED_WITHIN", program.ASKED_WITHIN)
        program.ASKED_WITHIN = 0.5
        self.fake("exec sleep 60", asked=False)
        began = time.monotonic()
        self.refused("does not answer within 0.5 s")
        self.assertLess(time.monotonic() - began, 3)  # it is asked once

    def test_a_program_mended_later_is_asked_again(self):
        path = self.fake("echo Usage", asked=False)
        with self.assertRaises(program.ProgramError):
            program.find()
        self.fake("true")
        os.utime(path, (1, 1))
        self.assertEqual(program.find().path, str(path))
        self.assertTrue(program.find().version)

    def fails(self, script, words):
        self.fake(script)
        with self.assertRaisesRegex(QgsProcessingException, words):
            run("check", {"NETWORK": str(COAST)}, Said())
        self.assertEqual(children(), [])

    def test_crash(self):
        self.fails("kill -SEGV $$", "thalweg failed: it was ended by SIGSEGV")

    def test_killed(self):
        self.fails("kill -KILL $$", "thalweg failed: it was ended by SIGKILL")

    def test_its_own_words(self):
        self.fails("echo 'warning: w' >&2; echo 'error: first line' >&2; echo '  second line' >&2; exit 1",
                   "^first line\n  second line$")

    def test_wrong_option(self):
        self.fails("exit 2", "it ended with exit status 2")

    def test_no_json(self):
        self.fails("echo done", "printed no JSON")

    def test_checks_that_fail_are_a_result(self):
        self.fake(f"echo '{REPORT}'; exit 3")
        said = Said()
        self.assertFalse(run("check", {"NETWORK": str(COAST)}, said)["OK"])
        self.assertEqual(said.warnings, ["These checks failed: spike (2, allowed 0)"])

    def test_the_log_has_no_columns_and_no_bare_stages(self):
        self.fake("echo 'read       60 lines of a  b.gpkg       0.1 s' >&2\necho '{\"stage\": \"check\", \"share\": 0}' >&2\n"
                  f"echo '{REPORT}'")
        said = Said()
        said.setProgressText = self.fail  # the dialog writes it to the log
        run("check", {"NETWORK": str(COAST)}, said)
        self.assertEqual(said.lines, ["read: 60 lines of a  b.gpkg, 0.1 s"])

    def test_the_bar_follows_what_a_run_expects(self):
        """Stages of one name share the time of both; one that was not expected leaves the bar where it is."""
        planned = [{"stage": name, "seconds": seconds} for name, seconds in (("grow", 1), ("blend", 2), ("blend", 2), ("write", 5))]
        lines = [{"stage": "read", "share": 1}, {"stages": planned}, {"stage": "grow", "share": 0.5}, {"stage": "blend", "share": 0.5},
                 {"stage": "contours", "share": 1}, {"stage": "write", "share": 1}]
        said = Said()
        listener = program._Listener("make", str(self.folder), said, frozenset())
        for line in lines:
            listener.hear(json.dumps(line))
        self.assertEqual([share for share in said.shares if share], [5.0, 30.0, 100.0])
        self.assertEqual(said.lines, [])

    def test_the_bar_of_a_run_ends_full(self):
        said = Said()
        run("make", {"WIDTH": 64, "HEIGHT": 64, "OUTPUT": str(self.folder / "out")}, said)
        shares = [share for share in said.shares if share]
        self.assertGreater(len(shares), 10)
        self.assertEqual(shares, sorted(shares))
        self.assertGreater(shares[-1], 99.9)

    def test_findings_are_those_of_the_report(self):
        """Word for word, with what to do; a river file with a height of 0 has two warnings."""
        text = (ROOT / "tests/zero_height.hpp").read_text("utf-8")
        rivers = self.folder / "r.geojson"
        rivers.write_text(re.search(r'R"\((.*)\)";', text, re.DOTALL)[1], "utf-8")
        said = Said()
        run("make", {"RIVERS": str(rivers), "CELL": 50, "OUTPUT": str(self.folder / "out")}, said)
        with open(self.folder / "out/report.json", encoding="utf-8") as file:
            findings = json.load(file)["findings"]
        warnings = [". ".join((one["text"], one["remedy"])) for one in findings if one["severity"] == "warning"]
        self.assertEqual([one["kind"] for one in findings if one["severity"] == "warning"][:2],
                         ["placeholder_heights", "filled_heights"])
        keys = [key["key"] for key in program.find().keys]
        self.assertEqual(said.warnings, [advice.in_qgis(words, keys) for words in warnings])
        self.assertIn('"Rivers: slope" beyond the last one known', said.warnings[1])
        self.assertIn("grid: 88x49 cells of 50 m", said.lines)
        self.assertFalse([line for line in said.lines if line.startswith("{")])

    def test_advice_is_for_qgis_alone(self):
        for words, there in (
                ("a.shp has no CRS; assign one (ogr2ogr -a_srs EPSG:n) or name it (--source-crs EPSG:n)",
                 "a.shp has no CRS; assign one (right-click the layer, Layer CRS > Set Layer CRS, and run again)"),
                ("a.tif is in feet: warp it (gdalwarp -t_srs)", "a.tif is in feet: warp it (Raster > Projections > Warp)"),
                ("too coarse: --set grid.cell=3 keeps them apart", 'too coarse: the parameter "Cell size" = 3 keeps them apart'),
                ("If they should meet: --set network.lines.snap=3.5.",
                 'If they should meet: the parameter "Rivers of a layer: snap" = 3.5.'),
                ("it runs outside the grid. Enlarge it, or set grid.clip = true.",
                 'it runs outside the grid. Enlarge it, or set "Grid: clip" = true.'),
                ("cannot read network.gpkg", "cannot read network.gpkg"),
                ("give --dem or --cell", 'give the parameter "DEM" or the parameter "Cell size of a raster"'),
                ("it looks like no-data. If it is terrain, use --nodata nan, or declare it (gdal_edit.py -a_nodata 0 a.tif)",
                 'it looks like no-data. If it is terrain, use the parameter "No-data value" = nan, or declare it (the parameter '
                 '"No-data value")'),
                ("2 rivers; run thalweg check on the file; its --fix writes a mended copy",
                 "2 rivers; run Check river network and take its Repaired network"),
                ("2 arcs leave the node at (1, 2)",
                 "2 arcs leave the node at (1, 2)\nIn QGIS: run Check river network and take its Repaired network."),
                ("assign its CRS by gdal_edit.py -a_srs",
                 "In QGIS: right-click the layer, Layer CRS > Set Layer CRS, and run again.\n"
                 "assign its CRS by gdal_edit.py -a_srs")):
            self.fails(f"echo 'error: {words}' >&2; exit 1", f"^{re.escape(there)}$")

    def test_a_note_is_written_once(self):
        note = "GeoJSON is written in degrees; --format geojson2008 keeps its coordinates"
        finding = json.dumps({"kind": "in_degrees", "severity": "note", "text": note})
        report = json.dumps({"written": [], "findings": [{"text": note}, {"text": "another"}]})
        self.fake(f"echo 'in_degrees {note}' >&2; echo '{{\"finding\": {finding}}}' >&2; echo '{report}'")
        said = Said()
        run("convert", {"NETWORK": str(COAST), "OUTPUT": str(self.folder / "x.geojson")}, said)
        self.assertEqual(said.lines, ['in degrees: GeoJSON is written in degrees; the parameter "Format" = geojson2008 keeps its '
                                      "coordinates", "another"])

    def test_full_pipes(self):
        self.fake("head -c 3000000 /dev/zero | tr '\\0' x | fold -w 1000 >&2\n"
                  "printf '{\"a\": \"'; head -c 3000000 /dev/zero | tr '\\0' y; "
                  "printf '\", \"findings\": [], \"mended\": [], \"notes\": []}'")
        said = Said()
        self.assertTrue(run("check", {"NETWORK": str(COAST)}, said)["OK"])
        self.assertEqual(len(said.lines), 3000)

    def test_lines_that_are_almost_progress(self):
        self.fake("printf '{\"stage\": 1}\\n{broken\\n\\377\\n{\"stage\": \"check\", \"share\": 7}\\n' >&2\n"
                  f"echo '{REPORT}'")
        said = Said()
        self.assertTrue(run("check", {"NETWORK": str(COAST)}, said)["OK"])
        self.assertEqual(said.lines[:3], ['{"stage": 1}', "{broken", "\ufffd"])
        self.assertLessEqual(said.progress(), 100)


if __name__ == "__main__":
    signal.alarm(600)
    main()
