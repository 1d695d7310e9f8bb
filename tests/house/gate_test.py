# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How scripts/packages and .ci/run end where a mirror or a machine fails, with stand-ins for apt-get and the machine.
Usage: gate_test.py"""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Stage(unittest.TestCase):
    """A folder with programs that stand in for others; each notes its words in `log`."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.place = pathlib.Path(self.folder.name)
        self.log = self.place / "log"

    def program(self, name, body):
        path = self.place / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f'#!/bin/sh\necho "{path.name} $*" >>"{self.log}"\n{body}\n')
        path.chmod(0o755)

    def noted(self, word):
        return [line for line in self.log.read_text().splitlines() if word in line] if self.log.exists() else []

    def run_here(self, *words):
        return subprocess.run(words, env={**os.environ, "PATH": f"{self.place}/bin:{os.environ['PATH']}"}, text=True,
                              capture_output=True, stdin=subprocess.DEVNULL)


class Packages(Stage):
    """apt-get fails where one of these words is among its own."""

    def packages(self, *failing):
        self.program("bin/dpkg-query", "exit 1")  # nothing is installed
        self.program("bin/sleep", "")
        self.program("bin/id", "echo 0")
        self.program("bin/apt-get", 'case " $* " in ' + "".join(f"*' {word} '*) exit 100 ;; " for word in failing) + "esac")
        return self.run_here(ROOT / "scripts/packages", "fresh").returncode

    def test_all_well(self):
        self.assertEqual(self.packages("never"), 0)
        self.assertEqual(len(self.noted("apt-get")), 4)  # lists, trial, download, installation

    def test_a_package_that_does_not_exist_is_no_fault_of_the_mirror(self):
        self.assertEqual(self.packages("--simulate"), 1)
        self.assertEqual(self.noted("--download-only"), [])

    def test_lists_are_tried_three_times_and_old_ones_do(self):
        self.assertEqual(self.packages("update"), 0)
        self.assertEqual(len(self.noted(" update")), 3)

    def test_no_lists(self):
        self.assertEqual(self.packages("update", "--simulate"), 125)

    def test_an_installation_that_fails(self):
        self.program("bin/df", "echo head; echo / 9 9 900000 9% /")
        self.assertEqual(self.packages("-qq --yes --no-install-recommends -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 install"), 1)
        self.program("bin/df", "echo head; echo / 9 9 9 99% /")
        self.assertEqual(self.packages("-qq --yes --no-install-recommends -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 install"), 125)

    def test_downloads_are_tried_three_times(self):
        self.assertEqual(self.packages("--download-only"), 125)
        self.assertEqual(len(self.noted("--download-only")), 3)


class Machine(Stage):
    def machine(self, *options):
        return self.run_here(ROOT / "tests/fresh/machine", *options, ROOT, "true")

    def test_another_release_has_the_hosts_sources(self):
        """mmdebstrap's last word is the file of sources."""
        self.program("bin/id", "echo 0")
        self.program("bin/mmdebstrap", f'for word; do :; done; cp "$word" "{self.place}/sources"; exit 1')
        texts = {}
        for suite in ("bookworm", "trixie"):
            os.environ["XDG_CACHE_HOME"] = str(self.place / suite)
            self.addCleanup(os.environ.pop, "XDG_CACHE_HOME", None)
            self.assertEqual(self.machine("-s", suite).returncode, 125)
            texts[suite] = (self.place / "sources").read_text()
        self.assertIn("trixie", texts["trixie"])
        self.assertNotIn("bookworm", texts["trixie"])
        self.assertEqual(texts["trixie"], texts["bookworm"].replace("bookworm", "trixie"))

    def test_needs_root(self):
        self.program("bin/id", "echo 1000")
        self.assertEqual(self.machine().returncode, 125)

    def test_a_disk_that_fails(self):
        self.program("bin/id", "echo 0")
        self.program("bin/mkdir", "exit 1")
        self.assertEqual(self.machine().returncode, 125)


class Gate(Stage):
    def gate(self, packages=0, machine=0, test=0):
        (self.place / ".ci").mkdir()
        shutil.copy(ROOT / ".ci/run", self.place / ".ci/run")
        self.program("scripts/packages", f"exit {packages}")
        self.program("tests/fresh/machine", f"exit {machine}")
        for name in ("tests/fresh/demo.sh", "tests/fresh/readme.sh"):
            self.program(name, "")
        self.program("scripts/test", f"exit {test}")
        return self.run_here("sh", self.place / ".ci/run")

    def test_the_machine_decides(self):
        for code in (0, 8):
            with self.subTest(code=code):
                self.setUp()
                self.assertEqual(self.gate(machine=code, test=3).returncode, code)
                self.assertEqual([line.split()[0] for line in self.noted("")], ["packages", "machine"])

    def test_where_there_is_no_machine_the_commands_run_here(self):
        for packages, machine in ((125, 0), (0, 125)):
            for code in (0, 8):
                with self.subTest(packages=packages, machine=machine, code=code):
                    self.setUp()
                    done = self.gate(packages, machine, code)
                    self.assertEqual(done.returncode, code)
                    self.assertIn("no fresh machine", done.stderr.splitlines()[-1])
                    self.assertEqual(len([line for line in self.noted("") if line.startswith(("demo.sh ", "readme.sh ", "test "))]), 3)

    def test_a_package_that_does_not_exist_fails(self):
        self.assertEqual(self.gate(packages=1).returncode, 1)
        self.assertEqual(self.noted("machine"), [])


class Full(Stage):
    """scripts/test --full in a repository of its own, where what a part runs is a stand-in."""

    def setUp(self):
        super().setUp()
        self.repo = self.place / "repo"
        for name in ("scripts", "tests"):
            (self.repo / name).mkdir(parents=True)
        shutil.copy(ROOT / "scripts/test", self.repo / "scripts/test")
        (self.repo / "tests/full.txt").write_text("# head\n")
        self.program("repo/scripts/packages", "")
        self.program("bin/cmake", "")
        self.program("bin/ctest", "case $* in *notebooks*) exit 8 ;; esac")
        self.program("bin/date", 'case "$*" in *%F*) echo 2026-01-02 ;; *) echo 1000 ;; esac')
        self.git("init", "-q")
        self.commit()

    def git(self, *words):
        done = self.run_here("git", "-C", self.repo, "-c", "user.name=n", "-c", "user.email=e", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip()

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "m")
        return self.git("rev-parse", "--short=8", "HEAD")

    def full(self, *words):
        return self.run_here(self.repo / "scripts/test", "--full", *words)

    def lines(self):
        return (self.repo / "tests/full.txt").read_text().splitlines()

    def test_each_part_writes_its_line(self):
        head = self.git("rev-parse", "--short=8", "HEAD")
        self.assertEqual(self.full("samples").returncode, 0)
        self.assertEqual(self.lines(), ["# head", f"samples      {head}  2026-01-02    0 min  passed"])
        self.assertEqual(self.full("page", "notebooks").returncode, 1)
        self.assertEqual([line.split()[0] + line.split()[-1] for line in self.lines()[1:]],
                         ["notebooksFAILED", "pagepassed", "samplespassed"])
        self.assertIn(f" {head} ", self.lines()[1])  # tests/full.txt itself has changed, and nothing else
        self.program("repo/scripts/packages", "# changed")
        self.full("samples")
        self.assertIn(f" {head}+ ", self.lines()[-1])

    def test_a_cause_stays_while_the_part_is_red(self):
        (self.repo / "tests/full.txt").write_text("# head\nnotebooks    x y 1 min FAILED # its kernel\nsamples x y 1 min FAILED # z\n")
        self.full("notebooks", "samples")
        self.assertTrue(self.lines()[1].endswith("FAILED # its kernel"), self.lines())
        self.assertTrue(self.lines()[2].endswith("passed"), self.lines())

    def test_the_three_oldest(self):
        parts = next(line for line in (ROOT / "scripts/test").read_text().splitlines() if line.startswith("parts=")).split("'")[1]
        old = self.commit()
        young = self.commit()
        self.commit()
        old_parts = ["page", "shells", "samples"]
        (self.repo / "tests/full.txt").write_text("# head\n" + "".join(
            f"{name} {old if name in old_parts else young + '+'} 2026-01-01 1 min passed\n" for name in parts.split()))
        self.commit()
        done = self.full("--stale")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("3 commits ago: page\n3 commits ago: shells\n3 commits ago: samples\n2 commits ago: clients\n", done.stdout)
        self.assertEqual([line.split()[0] for line in self.lines() if "2026-01-02" in line], sorted(old_parts))

    def test_parts_that_were_never_run_come_first(self):
        done = self.full("--stale")
        self.assertEqual(done.stdout.splitlines()[0], "never run: clients")


if __name__ == "__main__":
    unittest.main()
