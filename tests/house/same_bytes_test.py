# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds a fingerprint to tests/data/fingerprint.txt; THALWEG_RENEW=1 writes that file again.
Usage: same_bytes_test.py plain FINGERPRINT
       same_bytes_test.py threads FINGERPRINT
       same_bytes_test.py masked FINGERPRINT LIBM_PROBE     with AVX2 and FMA hidden from the C library
       same_bytes_test.py build CMAKE PRESET TARGET...       of another build, made here; fingerprint is among the targets"""
import os
import pathlib
import platform
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "data" / "fingerprint.txt"
MASK = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX,-FMA,-FMA4"}


def said(program, *words, **environment):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True,
                          env={**os.environ, **environment}).stdout


def hold(what, fingerprint):
    golden = GOLDEN.read_text()
    if fingerprint == golden:
        print(f"{what}: the same bytes")
        return
    for expected, got in zip(golden.splitlines(), fingerprint.splitlines()):
        if expected != got:
            sys.exit(f"{what}: other bytes, first here:\n  expected {expected}\n  got      {got}")
    sys.exit(f"{what}: {len(fingerprint.splitlines())} lines, expected {len(golden.splitlines())}")


def masked(fingerprint, probe):
    cpu = pathlib.Path("/proc/cpuinfo")
    if platform.machine() == "x86_64" and cpu.exists() and " fma " in cpu.read_text():
        if said(probe) == said(probe, **MASK):
            sys.exit("masking changes nothing in libm: this test shows nothing here; are the names of the tunables right?")
    else:
        print("this processor has no FMA to mask")
    hold("AVX2 and FMA masked", said(fingerprint, **MASK))


def build(cmake, preset, *targets):
    unity = "ON" if preset == "clang" else "OFF"  # the build by g++ beside it is as one unit: each way is compiled here
    made = ROOT / "build" / "full" / f"bytes-{preset}"  # not in the folder where somebody works with this preset
    subprocess.run([cmake, "--preset", preset, "-B", made, f"-DTHALWEG_UNITY={unity}", "--log-level=WARNING"], cwd=ROOT, check=True)
    subprocess.run([cmake, "--build", made, "--target", *targets], cwd=ROOT, check=True)
    hold(preset, said(made / "bin" / "fingerprint"))


match sys.argv[1:]:
    case ["plain", fingerprint]:
        if os.environ.get("THALWEG_RENEW") == "1":
            GOLDEN.write_text(said(fingerprint))
        hold("plain", said(fingerprint))
    case ["threads", fingerprint]:
        for threads in "1", "2", "5":
            hold(f"{threads} threads", said(fingerprint, threads))
    case ["masked", fingerprint, probe]:
        masked(fingerprint, probe)
    case ["build", cmake, preset, *targets]:
        build(cmake, preset, *targets)
    case _:
        sys.exit(__doc__)
