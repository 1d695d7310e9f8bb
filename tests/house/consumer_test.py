# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs thalweg into an empty prefix and builds and runs a program against it, by CMake and by hand, all outside the tree.
Usage: consumer_test.py CMAKE BUILD_DIR CXX_COMPILER"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

cmake, build_dir, compiler = sys.argv[1:4]
with tempfile.TemporaryDirectory() as room:
    room = pathlib.Path(room)
    prefix = room / "prefix"
    subprocess.run([cmake, "--install", build_dir, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
    shutil.copytree(pathlib.Path(__file__).parent / "consumer", room / "consumer")
    # Moved after the installation: nothing may hold the path it was installed to.
    moved = prefix.rename(room / "moved")
    subprocess.run([cmake, "-G", "Ninja", "-S", room / "consumer", "-B", room / "build", f"-DCMAKE_PREFIX_PATH={moved}",
                    f"-DCMAKE_CXX_COMPILER={compiler}", "-DCMAKE_BUILD_TYPE=Release"], check=True)
    subprocess.run([cmake, "--build", room / "build"], check=True)
    flags = subprocess.check_output(["pkg-config", "--static", "--cflags", "--libs", "thalweg"], text=True,
                                    env={**os.environ, "PKG_CONFIG_PATH": str(next(moved.rglob("pkgconfig")))}).split()
    subprocess.run([compiler, "-std=c++20", room / "consumer" / "main.cpp", "-o", room / "by_hand", *flags], check=True)
    for program in (room / "build" / "consumer", room / "by_hand"):
        said = subprocess.run([program], check=True, capture_output=True, text=True).stdout
        if said != "1.2\n":
            sys.exit(f"{program} says {said!r}, not 1.2")
    for name in ("man/man1/thalweg-make.1", "man/man5/thalweg-recipe.5", "bash-completion/completions/thalweg",
                 "zsh/site-functions/_thalweg", "fish/vendor_completions.d/thalweg.fish"):
        if not (moved / "share" / name).is_file():
            sys.exit(f"share/{name} is not installed")
    version = subprocess.run([moved / "bin" / "thalweg", "--version"], check=True, capture_output=True, text=True).stdout
    print(f"consumer built and ran; installed: {version.strip()}")
