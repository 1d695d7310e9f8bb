#!/usr/bin/python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""run_docs.py THALWEG SOURCE_DIR [PAGE ...]: runs every command of README.md and docs/**/*.md, or of the PAGEs, and compares
what pages quote of runs with what came of them (figures.py). THALWEG_RENEW=1 writes that into the pages instead; it runs only
those that quote something.

A command is a line that begins with "$ " in a fenced block marked sh. Each page runs in a folder of its own that
holds a copy of samples/, with thalweg in PATH; what the commands of a page leave, later ones find. A command whose
line ends in "# exit N" must exit with N, every other with 0. build/release/bin/thalweg stands for the thalweg in PATH.
`thalweg studio` is interrupted once it serves. Commands of scripts/ and the compilers' build are run by scripts/test itself and
only checked to exist; mpirun is for tests/ranks. python3 is Debian's, whose packages the pages speak of; psql, createdb and
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
import figures

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


class Folder:
    """Where the commands of a page run."""

    def __init__(self, place, thalweg, source, variables):
        self.place, self.said_by = pathlib.Path(place), {}
        shutil.copytree(source / "samples", self.place / "samples")
        bin_dir = self.place / ".bin"
        bin_dir.mkdir()
        (bin_dir / "thalweg").symlink_to(thalweg)
        (bin_dir / "python3").symlink_to("/usr/bin/python3")
        self.environment = dict(os.environ, PATH=f"{bin_dir}:{os.environ['PATH']}", **variables)

    def run(self, command):
        """Runs a command; returns what is wrong with it, else None."""
        wanted = int((re.search(r"#\s*exit (\d+)\s*$", command) or [0, 0])[1])
        if command.startswith("thalweg studio"):  # it serves until it is interrupted
            done = served(command, self.place, self.environment)
        else:
            done = subprocess.run(["bash", "-c", command], cwd=self.place, env=self.environment, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        self.said_by[figures.plain(command)] = done.stdout
        return None if done.returncode == wanted else f"{command}\nexit {done.returncode}, wanted {wanted}\n{done.stdout}"

    def said(self, command):
        """What a command printed, of the page or not."""
        if command not in self.said_by and (fault := self.run(command)):
            raise figures.Fault(fault)
        return self.said_by[command]


def is_elsewhere(command, source):
    """Whether a command is run by another test; the script that it runs has to be there."""
    script = command.split()[0]
    if script.startswith("scripts/") and not os.access(source / script, os.X_OK):
        raise figures.Fault(f"{command}: no such script")
    return elsewhere.match(command) is not None


def run_page(page, thalweg, source, renew):
    """Runs a page's commands and looks at what it quotes. Returns how many were run, and what is wrong."""
    text = page.read_text(encoding="utf-8")
    commands = [command.removeprefix("build/release/bin/") for command in figures.commands_of(text)]
    if renew and not figures.quotes(text):
        return 0, []
    faults = []
    with tempfile.TemporaryDirectory(prefix="thalweg-docs-") as place, server(any(map(databases.search, commands))) as found:
        folder = Folder(place, thalweg, source, found)
        for command in commands:
            try:
                if is_elsewhere(command, source):
                    continue
            except figures.Fault as fault:
                faults.append(f"{page.name}: {fault}")
                continue
            if fault := folder.run(command):
                faults.append(f"{page.name}: {fault}")
        try:
            right = figures.with_figures(figures.with_blocks(text, folder.said), figures.values_of(place, folder.said))
        except Exception as fault:  # also what the page's own expressions raise, such as for a key that report.json lacks
            return len(folder.said_by), [*faults, f"{page.name}: {type(fault).__name__}: {fault}"]
    if renew and not faults:
        page.write_text(right, encoding="utf-8")
        return len(folder.said_by), []
    return len(folder.said_by), faults + figures.differences(page.name, text, right)


def main():
    thalweg, source, *names = map(pathlib.Path, sys.argv[1:])
    thalweg, source = thalweg.resolve(), source.resolve()
    renew = os.environ.get("THALWEG_RENEW") == "1"
    run = failed = 0
    for page in [name.resolve() for name in names] or [source / "README.md", *sorted((source / "docs").rglob("*.md"))]:
        ran, faults = run_page(page, thalweg, source, renew)
        run, failed = run + ran, failed + len(faults)
        print(*faults, sep="\n", end="\n" if faults else "", flush=True)
    print(f"{run} commands run, {failed} faults" + ("" if renew or not failed else "; THALWEG_RENEW=1 renews what is stale"))
    return 1 if failed or run == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
