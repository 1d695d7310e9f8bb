# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds lib, tools and python to .clang-tidy. Files are read in the units of a unity build, where thirty share what they include.
Usage: tidy_test.py CMAKE CLANG_TIDY [MODULE...]     of MODULEs (or tools, python) alone, where there are any"""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MADE = ROOT / "build" / "full" / "tidy"


def units():
    """What is compiled of lib, tools and python, in order, but for what is generated."""
    subprocess.run([CMAKE, "--preset", "tidy", "-B", MADE, "--log-level=WARNING"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    commands = json.loads((MADE / "compile_commands.json").read_text())
    generated = (f"{MADE}/generated/", f"{MADE}/python/")
    files = sorted({command["file"] for command in commands if not command["file"].startswith(generated)})
    if any(file.startswith(f"{ROOT}/python/") for file in files):  # they include what bind.py writes
        subprocess.run([CMAKE, "--build", MADE, "--target", "thalweg_bindings"], check=True, stdout=subprocess.DEVNULL)
    return files


def findings(unit):
    """What clang-tidy says of a unit; None where it finds nothing."""
    done = subprocess.run([CLANG_TIDY, "--quiet", "-p", MADE, unit], cwd=ROOT, capture_output=True, text=True)
    return None if done.returncode == 0 else done.stdout or done.stderr


if len(sys.argv) < 3:
    sys.exit(__doc__)
CMAKE, CLANG_TIDY, *modules = sys.argv[1:]
chosen = units()
if modules:
    chosen = [unit for unit in chosen if any(f"/thalweg_{name}.dir/" in unit or f"/{name}/" in unit for name in modules)]
if not chosen:
    sys.exit("no unit to look at")
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    found = [said for said in pool.map(findings, chosen) if said]
print(*found, sep="\n")
print(f"{len(chosen)} units, {len(found)} with findings")
sys.exit(1 if found else 0)
