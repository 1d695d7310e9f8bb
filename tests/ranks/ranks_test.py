# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ensembles over threads, MPI ranks and a Slurm array: one table, also after kills. 10 000 pairs in tar files.
Usage: ranks_test.py THALWEG SOURCE [unittest's words]. THALWEG_KILLS: how often each kind is killed (default 1)."""
import csv
import hashlib
import io
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tarfile
import tempfile
import time
import unittest

from osgeo import gdal, ogr

import slurm_cluster

THALWEG, SOURCE = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
KILLS = int(os.environ.get("THALWEG_KILLS", "1"))
RECIPE = [SOURCE / "samples/relief.toml", "--set", "grid.width=128", "--set", "grid.height=128", "--vary", "surface.mean_slope=10..35"]
MANY = 500
FEW = 60
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
gdal.UseExceptions()


def words(folder, members, *more):
    return list(map(str, [THALWEG, "make", *RECIPE, "--ensemble", members, "-o", folder, "-q", *more]))


def over(ranks, command):
    return ["mpirun", "-n", str(ranks), "--oversubscribe", *command]


def hash_of(folder):
    return hashlib.sha256((folder / "table.csv").read_bytes()).hexdigest()


def numbers_of(folder):
    with open(folder / "table.csv", newline="", encoding="utf-8") as file:
        return [(int(row["member"]), row["status"]) for row in csv.DictReader(file)]


def committed(folder):
    return len(list(folder.glob("member_*")))


class Ranks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory(prefix="thalweg-ranks-", dir="/var/tmp")
        cls.path = pathlib.Path(cls.place.name)
        cls.run_whole(words(cls.path / "whole", FEW, "--threads", 1))
        cls.few = hash_of(cls.path / "whole")

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    @staticmethod
    def run_whole(command, timeout=300, **options):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, env=ENVIRONMENT, timeout=timeout, **options)
        if done.returncode:
            raise AssertionError(f"{' '.join(command)}: {done.returncode}\n{done.stdout}")
        return done.stdout

    def test_version_and_help_speak_of_mpi(self):
        self.assertIn("Open MPI", self.run_whole([str(THALWEG), "--version"]))

    def test_one_table_of_500_members(self):
        hashes = {}
        with slurm_cluster.cluster() as slurm:
            for threads in (1, 2, 4):
                self.run_whole(words(self.path / f"threads{threads}", MANY, "--threads", threads, "--only", "table"))
                hashes[f"{threads} threads"] = hash_of(self.path / f"threads{threads}")
            for ranks in (1, 2, 4):
                self.run_whole(over(ranks, words(self.path / f"ranks{ranks}", MANY, "--only", "table")))
                hashes[f"{ranks} ranks"] = hash_of(self.path / f"ranks{ranks}")
            self.submit(slurm, "array", MANY, "--only", "table")
            hashes["array of 5"] = hash_of(self.path / "array")
        print(hashes)
        self.assertEqual(len(set(hashes.values())), 1, hashes)
        self.assertEqual(numbers_of(self.path / "array"), [(i, "ok") for i in range(MANY)])

    def submit(self, slurm, name, members, *more, waits=True):
        command = [str(SOURCE / "scripts/slurm"), "--tasks", "5", "--program", str(THALWEG), *(["--wait"] if waits else []), "--",
                   *words(self.path / name, members, *more)[2:]]
        return subprocess.run(command, env=slurm.environment, check=True, capture_output=True, text=True).stdout

    def expect_whole(self, name):
        self.assertEqual(numbers_of(self.path / name), [(i, "ok") for i in range(FEW)])
        self.assertEqual(committed(self.path / name), FEW)
        self.assertEqual(hash_of(self.path / name), self.few)
        self.assertEqual([p.name for p in (self.path / name).iterdir() if "thalweg-tmp" in p.name], [])

    def kill_and_resume(self, name, command, victim):
        """Kills the victim of each run once some members more are there, then lets one run end."""
        folder = self.path / name
        for turn in range(KILLS):
            least = committed(folder) + random.Random(turn).randrange(1, 4) if folder.exists() else 1
            with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=ENVIRONMENT, start_new_session=True) as run:
                while committed(folder) < min(least, FEW) and run.poll() is None:
                    time.sleep(0.002)
                found = victim(run.pid)
                if found:
                    os.kill(found, signal.SIGKILL)
                run.wait()
        self.assertLessEqual(committed(folder), FEW)
        self.run_whole(command)
        self.expect_whole(name)

    def test_a_killed_process_goes_on(self):
        self.kill_and_resume("process", words(self.path / "process", FEW), lambda pid: pid)

    def test_a_killed_rank_goes_on(self):
        def last_rank(pid):
            children = subprocess.run(["pgrep", "-P", str(pid), "-x", "thalweg"], capture_output=True, text=True, check=False).stdout.split()
            return int(children[-1]) if children else None

        self.kill_and_resume("rank", over(3, words(self.path / "rank", FEW)), last_rank)

    def test_a_killed_task_and_a_lost_node_are_made_again(self):
        with slurm_cluster.cluster() as slurm:
            for turn in range(max(KILLS, 2)):
                name = f"array{turn}"
                folder = self.path / name
                self.submit(slurm, name, FEW, waits=False)
                least = random.Random(turn).randrange(1, FEW // 2)
                slurm.wait_for(lambda: committed(folder) >= least, "a member")
                if turn % 2 == 0:  # one task
                    found = subprocess.run(["pgrep", "-f", f"make .*-o '?{folder}"], capture_output=True, text=True, check=False).stdout.split()
                    os.kill(int(found[0]), signal.SIGKILL)
                else:
                    slurm.lose_node()
                    slurm.start_node()
                self.assertLess(committed(folder), FEW)
                slurm.wait_for(lambda: not slurm.said("squeue", "-h").strip(), "the end of the jobs", 400)
                self.expect_whole(name)

    def test_the_commands_of_the_docs(self):
        place = self.path / "docs"
        (place / "bin").mkdir(parents=True)
        (place / "bin/thalweg").symlink_to(THALWEG)
        found = re.findall(r"^\$ ((?:mpirun|scripts/slurm) .*)$", (SOURCE / "docs/scale.md").read_text(encoding="utf-8"), re.M)
        self.assertEqual(len(found), 2)
        with slurm_cluster.cluster() as slurm:
            for command in found:
                done = subprocess.run(["bash", "-c", command.replace("mpirun", "mpirun --oversubscribe").replace("scripts/slurm", f"{SOURCE}/scripts/slurm --wait")],
                                      cwd=place, capture_output=True, text=True, check=False, timeout=300,
                                      env={**ENVIRONMENT, **slurm.environment, "PATH": f"{place}/bin:{os.environ['PATH']}",
                                           "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
                self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(list((place / "out/array").glob("shard-*.tar"))), 5)
        self.assertEqual(hash_of(place / "out/ranks"), hash_of(place / "out/array"))

    def test_wrong_words_to_slurm_are_refused(self):
        with slurm_cluster.cluster() as slurm:
            for given in [[], ["--tasks", "0", "--"], ["--"], ["--", "-o", "x"], ["--", "--ensemble", "2", "--share", "1/2"],
                          ["--tasks", "2"], ["--", "--ensemble", "2", "--set", "grid.width=-1"]]:
                done = subprocess.run([SOURCE / "scripts/slurm", *given], cwd=self.path, env=slurm.environment, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 2, given)
                self.assertRegex(done.stderr, "scripts/slurm: |error: ")
            self.assertEqual(slurm.said("squeue", "-h"), "")

    def test_a_wrong_command_is_refused_once(self):
        for command, code in [(over(2, words(self.path / "none", FEW, "--vary", "x=1")), 2), (over(2, [str(THALWEG), "make", "-o", "x"]), 2)]:
            done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn("error: ", done.stderr)
        self.assertFalse((self.path / "none").exists())

    def test_a_full_disk(self):
        disk = self.path / "disk"
        disk.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=3m", "thalweg", disk], check=True)
        try:
            for command in (words(disk / "out", FEW), over(2, words(disk / "out", FEW))):
                done = subprocess.run(command, capture_output=True, text=True, check=False, env=ENVIRONMENT, timeout=60)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertRegex(done.stderr, r"error: .*(No space left on device|disk is full).*of 60 members are in .*/out")
            whole = sorted((disk / "out").glob("member_*"))
            self.assertGreater(len(whole), 3)
            for member in whole:
                kept = {p.name: p.read_bytes() for p in member.iterdir() if p.name != "report.json"}
                other = {p.name: p.read_bytes() for p in (self.path / "whole" / member.name).iterdir() if p.name != "report.json"}
                self.assertEqual(kept.keys(), other.keys())
                self.assertTrue(kept == other, member)
            subprocess.run(["mount", "-o", "remount,size=60m", disk], check=True)
            self.run_whole(words(disk / "out", FEW))
            self.assertEqual(hash_of(disk / "out"), self.few)
            subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
            for folder in ("out", "other"):
                done = subprocess.run(words(disk / folder, FEW), capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("Read-only file system", done.stderr)
        finally:
            subprocess.run(["umount", disk], check=True)

    def test_ten_thousand_pairs(self):
        folder = self.path / "pairs"
        began = time.monotonic()
        self.run_whole([str(THALWEG), "make", "--set", "grid.width=128", "--set", "grid.height=128", "--ensemble", "10000", "--shards", "1000",
                        "-q", "-o", str(folder)], timeout=1800)
        print(f"10 000 members of 128x128 in shards: {10000 / (time.monotonic() - began):.0f} a second, load {os.getloadavg()[0]:.1f}")
        shards = sorted(folder.glob("*.tar"))
        self.assertEqual([p.name for p in shards], [f"shard-{i:06}.tar" for i in range(10)])
        number = 0
        for shard in shards:
            with tarfile.open(shard) as tar:
                members = iter(tar)
                for dem, rivers, row in zip(members, members, members):
                    key = f"{number:08}"
                    self.assertEqual([dem.name, rivers.name, row.name], [f"{key}.dem.tif", f"{key}.rivers.png", f"{key}.json"])
                    about = json.load(io.TextIOWrapper(tar.extractfile(row)))
                    self.assertEqual(about["seed"], 7 + number)
                    if number % 10 == 0:
                        self.expect_pair(tar.extractfile(dem).read(), tar.extractfile(rivers).read(), about)
                    number += 1
        self.assertEqual(number, 10000)
        # The mask is that of the network: the cells of network.tif, and each cell is within one of a line of network.gpkg.
        for number in (0, 4321, 9999):
            self.expect_network(folder, number)

    def expect_pair(self, dem, rivers, about):
        with tempfile.TemporaryDirectory() as place:
            (pathlib.Path(place) / "dem.tif").write_bytes(dem)
            (pathlib.Path(place) / "rivers.png").write_bytes(rivers)
            heights = gdal.Open(f"{place}/dem.tif").ReadAsArray()
            mask = gdal.Open(f"{place}/rivers.png").ReadAsArray()
        self.assertEqual(heights.shape, (128, 128))
        self.assertEqual(mask.shape, (128, 128))
        self.assertEqual(set(mask.ravel().tolist()), {0, 255})
        self.assertGreaterEqual(int((mask == 255).sum()) * 30, 0.7 * about["values"]["rivers.length_m"])
        self.assertLess(heights[mask == 255].mean(), heights[mask == 0].mean())

    def expect_network(self, folder, number):
        made = self.path / f"alone{number}"
        self.run_whole([str(THALWEG), "make", "--set", "grid.width=128", "--set", "grid.height=128", "--seed", str(7 + number), "--only", "dem,network",
                        "-q", "-o", str(made)])
        with tarfile.open(folder / f"shard-{number // 1000:06}.tar") as tar:
            (made / "mask.png").write_bytes(tar.extractfile(f"{number:08}.rivers.png").read())
            self.assertEqual(tar.extractfile(f"{number:08}.dem.tif").read(), (made / "dem.tif").read_bytes())
        mask = gdal.Open(str(made / "mask.png")).ReadAsArray() == 255
        raster = gdal.Open(str(made / "network.tif"))
        self.assertTrue((mask == (raster.ReadAsArray() != 0)).all())
        west, cell, _, north, _, _ = raster.GetGeoTransform()
        network = ogr.Open(str(made / "network.gpkg"))
        lines = [feature.GetGeometryRef().Clone() for feature in network.GetLayer("arcs")]
        for row, col in zip(*mask.nonzero()):
            centre = ogr.CreateGeometryFromWkt(f"POINT ({west + (col + 0.5) * cell} {north - (row + 0.5) * cell})")
            self.assertLessEqual(min(line.Distance(centre) for line in lines), cell)


if __name__ == "__main__":
    unittest.main(verbosity=2)
