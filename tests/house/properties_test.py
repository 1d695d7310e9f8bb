# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs every suite with a rapidcheck property with new seeds, twenty times as many cases as the fast tests, which must have
one seed for good: a build does not fail by chance. With THALWEG_SAMPLE those of one small module.
Usage: properties_test.py BIN       BIN has test_<module>"""
import json
import os
import pathlib
import random
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLE = "geometry"
TEST = re.compile(r"^(?:TEST|TEST_F|RC_GTEST_PROP)\((\w+),", re.M)

if len(sys.argv) != 2:
    sys.exit(__doc__)
told = subprocess.run(["ctest", "--test-dir", pathlib.Path(sys.argv[1]).parent, "--show-only=json-v1"], stdout=subprocess.PIPE, check=True)
for test in json.loads(told.stdout)["tests"]:
    has = {p["name"]: p["value"] for p in test["properties"]}
    program = pathlib.Path(test.get("command", [""])[0]).name  # none where a test's program is not on this machine
    if program.startswith("test_") and "long" not in has["LABELS"] and "RC_PARAMS=seed=16" not in has.get("ENVIRONMENT", []):
        sys.exit(f"{test['name']}: has a new seed each time")
suites = {}
for file in sorted((ROOT / "tests").rglob("*_test.cpp")):
    text = file.read_text()
    if "rc::check(" in text or "RC_GTEST_PROP(" in text:
        suites.setdefault(file.relative_to(ROOT / "tests").parts[0], set()).update(TEST.findall(text))
if SAMPLE not in suites:
    sys.exit(f"no properties in {SAMPLE}")
failed = []
for module, names in suites.items():
    if os.environ.get("THALWEG_SAMPLE") and module != SAMPLE:
        continue
    params = f"max_success=2000 seed={random.SystemRandom().getrandbits(63)}"
    wanted = ":".join(f"{name}.*" for name in sorted(names)) + "-Long*"
    print(f"RC_PARAMS='{params}' test_{module} --gtest_filter='{wanted}'", flush=True)
    done = subprocess.run([pathlib.Path(sys.argv[1]) / f"test_{module}", f"--gtest_filter={wanted}", "--gtest_brief=1"],
                          env={**os.environ, "RC_PARAMS": params})
    if done.returncode != 0:
        failed.append(module)
sys.exit(f"properties fail in {', '.join(failed)}" if failed else 0)
