# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the tests of the modules with the sanitizers of a preset and runs those of the gate.
Usage: sanitized_test.py CMAKE PRESET [MODULE...]     asan or tsan; of MODULEs alone, where there are any"""
import os
import pathlib
import platform
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = ["core", "geometry", "solver", "flow", "growth", "network", "skeleton", "surface", "fractal", "blend", "measure", "draw",
           "io", "serve", "recipe", "make", "report", "export", "ensemble", "commands", "studio"]


def environment():
    return {**os.environ,
            "ASAN_OPTIONS": "detect_stack_use_after_return=1:strict_string_checks=1",
            "LSAN_OPTIONS": f"suppressions={ROOT / 'tests' / 'house' / 'leaks.txt'}:print_suppressions=0",
            "UBSAN_OPTIONS": "print_stacktrace=1:halt_on_error=1",
            "TSAN_OPTIONS": f"suppressions={ROOT / 'tests' / 'house' / 'races.txt'}:ignore_noninstrumented_modules=1:halt_on_error=1"}


def run(*words):
    # g++ 12's thread sanitizer knows no addresses as random as newer systems give.
    fixed = ["setarch", platform.machine(), "-R"] if random_bits() > 28 else []
    subprocess.run([*fixed, *words], cwd=ROOT, env=environment(), check=True)


def random_bits():
    try:
        return int(pathlib.Path("/proc/sys/vm/mmap_rnd_bits").read_text())
    except PermissionError:  # not root
        return 32
    except FileNotFoundError:
        return 0


if len(sys.argv) < 3:
    sys.exit(__doc__)
cmake, preset, *modules = sys.argv[1:]
modules = modules or MODULES + (["bindings"] if preset == "asan" else [])  # those of Python
targets = [target for module in modules for target in (["thalweg_package", "thalweg_cli"] if module == "bindings" else [f"test_{module}"])]
made = ROOT / "build" / "full" / preset
run(cmake, "--preset", preset, "-B", made, "-DTHALWEG_UNITY=ON", "-DTHALWEG_TESTS=ON", "--log-level=WARNING")
run(cmake, "--build", made, "--target", *targets)
run("ctest", "--test-dir", made, "--label-regex", f"^({'|'.join(modules)})$", "--output-on-failure",
    "--no-tests=error", "--parallel", str(os.cpu_count()))
