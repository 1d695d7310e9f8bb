#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""run_docs.py THALWEG SOURCE_DIR: runs every command of README.md and docs/**/*.md.

A command is a line that begins with "$ " in a fenced block marked sh. Each page runs in a folder of its own that
holds a copy of samples/, with thalweg in PATH; what the commands of a page leave, later ones find. A command whose
line ends in "# exit N" must exit with N, every other with 0. build/release/bin/thalweg stands for the thalweg in PATH.
`thalweg studio` is interrupted once it serves. Commands of scripts/ and the compilers' build are run by scripts/test itself and only checked to exist; mpirun is for tests/ranks. python3 is Debian's, whose packages the pages speak of; psql, createdb and
databases "PG:dbname=..." are those of a PostgreSQL of this run's own.
"""
import contextlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.request

import cluster

thalweg, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
elsewhere = re.compile(r"^(\./)?(scripts/|cmake |git clone|cd |ctest |build/|mpirun )")
databases = re.compile(r"\bPG:|\bpsql\b|\bcreatedb\b")


@contextlib.contextmanager
def server(wanted):
    """The environment in which libpq finds a server, where one is wanted."""
    if not wanted:
        yield {}
        return
    with tempfile.TemporaryDirectory(prefix="thalweg-docs-") as place:
        state = pathlib.Path(place) / "cluster.json"
        try:
            cluster.start(state)
            found = cluster.connection(state)
            yield {"PGHOST": found["host"], "PGUSER": found["user"]}
        finally:
            cluster.stop(state)


def served(command, place, environment):
    """Runs a command that serves until it has printed its address, which is opened, and a SIGINT."""
    words = ["bash", "-c", f"exec {command.split('#')[0]} --no-browser"]
    with subprocess.Popen(words, cwd=place, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL) as process:
        said = ""
        for line in process.stdout:
            said += line
            if line.startswith("http://127.0.0.1:"):
                with urllib.request.urlopen(line.strip()) as answer:
                    said += f"{len(answer.read())} bytes\n"
                process.send_signal(signal.SIGINT)
        return subprocess.CompletedProcess(words, process.wait(), said)


pages = [source / "README.md", *sorted((source / "docs").rglob("*.md"))]
run = failed = 0
for page in pages:
    blocks = re.findall(r"^```sh\n(.*?)^```", page.read_text(), re.S | re.M)
    commands = [line[2:] for block in blocks for line in block.splitlines() if line.startswith("$ ")]
    if not commands:
        continue
    with tempfile.TemporaryDirectory(prefix="thalweg-docs-") as place, server(any(map(databases.search, commands))) as found:
        shutil.copytree(source / "samples", pathlib.Path(place) / "samples")
        bin_dir = pathlib.Path(place) / ".bin"
        bin_dir.mkdir()
        (bin_dir / "thalweg").symlink_to(thalweg)
        (bin_dir / "python3").symlink_to("/usr/bin/python3")
        environment = dict(os.environ, PATH=f"{bin_dir}:{os.environ['PATH']}", **found)
        for command in commands:
            command = command.removeprefix("build/release/bin/")
            if elsewhere.match(command):
                script = command.split()[0]
                if script.startswith("scripts/") and not os.access(source / script, os.X_OK):
                    print(f"{page.name}: {command}: no such script")
                    failed += 1
                continue
            wanted = int((re.search(r"#\s*exit (\d+)\s*$", command) or [0, 0])[1])
            if command.startswith("thalweg studio"):  # it serves until it is interrupted
                done = served(command, place, environment)
            else:
                done = subprocess.run(["bash", "-c", command], cwd=place, env=environment, text=True,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
            run += 1
            if done.returncode != wanted:
                failed += 1
                print(f"{page.name}: {command}\nexit {done.returncode}, wanted {wanted}\n{done.stdout}")
print(f"{run} commands run, {failed} failed")
sys.exit(1 if failed or run == 0 else 0)
