#!/usr/bin/env python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets one allocation, or one call that opens, reads, writes, renames or flushes a file, fail in small runs of seven
commands: 200 allocations a command, spread by a hash over all of a run, and each of the first 500 calls. A run must give
the right bytes, or end with exit 1 in words (2 where an input cannot be read) and leave nothing; whatever it leaves, the same command must give them then.
Usage: shortages.py BUILD_DIR [ALLOCATIONS [CALLS [COMMAND ...]]]"""
import concurrent.futures
import hashlib
import os
import pathlib
import select
import shutil
import signal
import subprocess
import sys
import tempfile

LAND = "make --set grid.width=64 --set grid.height=48 --set network.dla.particles=400 --set network.prune=4 -q --threads 1 -o"
HANGS_S = 60
# Words of a command, with the place of what it reads for @; and what it leaves: a file or a folder, or "" for its output.
COMMANDS = {
    "make": (f"{LAND} out", "out"),
    "check": ("check @/land/network.gpkg --dem @/land/dem.tif", ""),
    "tin": ("tin @/points.csv -q -o out.ply", "out.ply"),
    "draw": ("draw @/land -q -o out", "out"),
    "export": ("export @/land --for unity -q -o out", "out"),
    "ensemble": (f"{LAND} out --ensemble 2 --only table", "out"),
    "studio": ("studio @/recipe.toml -o out -q --no-browser", "out"),
}
AGAIN = "studio out -q --no-browser"
VARYING = ("report.json", "report.html", "timings.csv")  # they hold times
INNER = (".ensemble", "history.lock")  # journals and locks


def bytes_of(place):
    """What a run left, by name: bytes, without what differs between two runs."""
    if place.is_file():
        return {"": place.read_bytes()}
    return {str(path.relative_to(place)): path.read_bytes() for path in sorted(place.rglob("*"))
            if path.is_file() and path.name not in VARYING and not set(path.relative_to(place).parts) & set(INNER)}


class Trial:
    def __init__(self, build, inputs, name):
        self.program = build / "bin/thalweg"
        self.spy = next(build.rglob("libspy.so"))
        self.inputs = inputs
        self.name = name
        words, self.left = COMMANDS[name]
        self.words = [str(self.program), *words.replace("@", str(inputs)).split()]

    def run(self, folder, again=False, **environment):
        """(exit code, None for a hang, standard output, standard error)"""
        words = [str(self.program), *AGAIN.split()] if again and self.name == "studio" else self.words
        setting = {**os.environ, **environment}
        if environment:
            setting["LD_PRELOAD"] = str(self.spy)
        process = subprocess.Popen(words, cwd=folder, env=setting, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if self.name == "studio":  # it ends at Ctrl-C, once it has printed its address, or by itself
            told, _, _ = select.select([process.stdout], [], [], HANGS_S)
            if told and process.stdout.readline():
                process.send_signal(signal.SIGINT)
        try:
            out, err = process.communicate(timeout=HANGS_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return None, b"", b""
        return process.returncode, b"" if self.name == "studio" else out, err

    def reference(self):
        with tempfile.TemporaryDirectory() as folder:
            count = pathlib.Path(folder) / "count"
            code, out, err = self.run(folder, SPY_COUNT=str(count))
            if code != 0:
                sys.exit(f"{self.name}: exit {code}: {err.decode()}")
            self.right = (out, bytes_of(pathlib.Path(folder) / self.left) if self.left else {})
            return [int(number) for number in count.read_text().split()]

    def fault(self, variable, number):
        """(what is wrong with a run in which this one fails, or "", whether it ended well)"""
        with tempfile.TemporaryDirectory() as folder:
            code, out, err = self.run(folder, **{variable: str(number)})
            place = pathlib.Path(folder) / self.left
            words = err.decode(errors="replace").strip()
            if code is None:
                return "it hangs", False
            if code == 0:
                whole = (out, bytes_of(place) if self.left else {}) == self.right
                return "" if whole else f"exit 0 and other bytes: {words}", True
            if code not in (1, 2) or "error: " not in words:  # 2: an input that cannot be read
                return f"exit {code}: {words}", False
            beside = [path.name for path in pathlib.Path(folder).iterdir() if path != place and ".thalweg-tmp-" not in path.name]
            is_there = bool(self.left) and place.exists()
            if is_there and self.name in ("ensemble", "studio"):  # they go on with what is there
                code, _, err = self.run(folder, again=True)
                if code != 0:
                    return f"{words}; again: exit {code}, {err.decode()}", False
            if is_there and bytes_of(place) != self.right[1]:  # whole, if only what follows could not be done
                beside.append(place.name)
            return f"{words}; it left {beside}" if beside else "", False


def positions(name, all_of_run, count):
    """Positions spread by a fixed hash."""
    spread = (int.from_bytes(hashlib.sha256(f"{name} {i}".encode()).digest()[:8], "big") for i in range(count))
    return sorted({1 + word % all_of_run for word in spread})


def main(build, most_allocations=200, most_calls=500, names=()):
    faults = 0
    with tempfile.TemporaryDirectory() as inputs, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        inputs = pathlib.Path(inputs)
        subprocess.run([build / "bin/thalweg", *LAND.split(), inputs / "land"], check=True, stdout=subprocess.DEVNULL)
        shutil.copy(inputs / "land/recipe.toml", inputs / "recipe.toml")
        (inputs / "points.csv").write_text("x,y,z\n" + "".join(
            f"{500000 + 37 * (i % 20)},{5000000 + 41 * (i // 20)},{100 + i * i % 97}\n" for i in range(200)))
        for name in names or COMMANDS:
            trial = Trial(build, inputs, name)
            allocations, calls = trial.reference()
            for variable, chosen, of in (("SPY_ONE", positions(name, allocations, most_allocations), allocations),
                                         ("SPY_IO", range(1, min(calls, most_calls) + 1), calls)):
                ended = list(pool.map(lambda number: trial.fault(variable, number), chosen))
                wrong = [(number, why) for number, (why, _) in zip(chosen, ended) if why]
                whole = sum(is_whole and not why for why, is_whole in ended)
                print(f"{name:9} {'allocations' if variable == 'SPY_ONE' else 'calls':11} {len(ended):4} of {of:7}: {whole} whole, "
                      f"{len(ended) - whole - len(wrong)} refused, {len(wrong)} wrong", flush=True)
                for number, why in wrong:
                    print(f"    {variable}={number}: {why[:400]}", flush=True)
                faults += len(wrong)
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    most = [int(word) for word in sys.argv[2:4]] + [200, 500][len(sys.argv[2:4]):]
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), *most, sys.argv[4:]))
