#!/usr/bin/env python3
# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks for failures that the gate, which asks the same every time, cannot find: properties with new seeds, kills at random
moments, shortages of memory and processes, servers that do not answer, and the tests named in tests/flaky.txt, in random
order until the time is over. Prints each failure as the line to commit.
Usage: soak.py BUILD_DIR MINUTES"""
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
TEST = re.compile(r"^(?:TEST|TEST_F|RC_GTEST_PROP)\((\w+),\s*(\w+)", re.M)
CASES = 1000  # of each property, beside RapidCheck's 100 in the gate


def suites_with_properties():
    """(module, suite) of every suite in a file with a rapidcheck property."""
    for file in sorted((ROOT / "tests").rglob("*_test.cpp")):
        text = file.read_text()
        if "rc::check(" in text or "RC_GTEST_PROP(" in text:
            for suite in sorted({name for name, _ in TEST.findall(text)}):
                yield file.relative_to(ROOT / "tests").parts[0], suite


def failed_in(output):
    return sorted(set(re.findall(r"^\[  FAILED  \] (\S+?\.\S+?)(?: \(|,|$)", output, re.M)))


def with_new_seed(binary, module, suite):
    params = f"max_success={CASES} seed={random.SystemRandom().getrandbits(63)}"
    done = run([binary / f"test_{module}", f"--gtest_filter={suite}.*"], RC_PARAMS=params)
    if done.returncode:
        for name in failed_in(done.stdout) or [f"{suite}.*"]:
            yield f"tests/seeds.txt: {module} {name} {params}", done.stdout


def torture(program, name):
    done = run([program, f"--gtest_filter={name}"])
    if done.returncode:
        yield f"{name} of {program.name}: commit its input as a test of tests/tools/faults", done.stdout


def ranks(program, name):
    done = run(["/usr/bin/python3", ROOT / "tests/ranks/ranks_test.py", program, ROOT, name], THALWEG_KILLS="10")
    if done.returncode:
        yield f"{name} of tests/ranks/ranks_test.py: kills", done.stdout


def again(build, name):
    done = run(["ctest", "--test-dir", build, "--tests-regex", f"^{re.escape(name)}$", "--no-tests=error", "--output-on-failure"])
    if done.returncode:
        yield f"tests/flaky.txt: {name} failed again", done.stdout


def run(words, **environment):
    return subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          env={**os.environ, **environment})


def tests_of(program, suites="*"):
    listed = subprocess.run([program, "--gtest_list_tests", f"--gtest_filter={suites}"], check=True, capture_output=True, text=True).stdout
    suite = ""
    for line in listed.splitlines():
        if line.startswith("  "):
            yield suite + line.split()[0]
        elif line.rstrip().endswith("."):
            suite = line.strip()


def main(build, minutes):
    binary = build / "bin"
    flaky = [line.split()[0] for line in (ROOT / "tests/flaky.txt").read_text().splitlines() if line and line[0] != "#"]
    work = [(with_new_seed, binary, module, suite) for module, suite in suites_with_properties()]
    work += [(torture, binary / "thalweg_soak", name) for name in tests_of(binary / "thalweg_soak")]
    work += [(torture, program, name) for program in sorted(binary.glob("test_*")) for name in tests_of(program, "Soak*")]
    work += [(again, build, name) for name in flaky]
    if b"Open MPI" in subprocess.check_output([binary / "thalweg", "--version"]) and shutil.which("slurmd"):
        work += [(ranks, binary / "thalweg", f"Ranks.test_{name}") for name in (
            "a_killed_process_goes_on", "a_killed_rank_goes_on", "a_killed_task_and_a_lost_node_are_made_again")]
    end = time.monotonic() + 60 * minutes
    found, rounds, done = [], 0, 0
    while time.monotonic() < end:
        random.shuffle(work)
        for task, *words in work:
            if time.monotonic() >= end:
                break
            for line, output in task(*words):
                found.append(line)
                print(f"{output}\n{line}", flush=True)
            done += 1
        else:
            rounds += 1
    print(f"\n{done} runs, {rounds} whole rounds of {len(work)}; {len(found)} failures")
    print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), float(sys.argv[2])))
