# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the installed Python module into a wheel, for scripts/package. The same build gives the same bytes.
Usage: wheel.py BUILD_DIR OUTPUT_DIR"""
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile

import packaging.tags

ROOT = pathlib.Path(__file__).resolve().parents[1]


def named(*groups: str) -> list[str]:
    """Debian's packages of these groups of scripts/packages."""
    return subprocess.check_output([ROOT / "scripts/packages", "--list", *groups], text=True).split()


def needed(extension: pathlib.Path, room: pathlib.Path) -> list[str]:
    """Debian's packages of the libraries that an extension is linked to."""
    (room / "debian").mkdir()
    (room / "debian/control").touch()  # dpkg-shlibdeps wants one
    said = subprocess.check_output(["dpkg-shlibdeps", "-O", extension], cwd=room, text=True)
    names = [re.split(r"[ |]", package)[0] for package in said.strip().removeprefix("shlibs:Depends=").split(", ")]
    return sorted(set(names))


def metadata(version: str, summary: str, external: list[str]) -> str:
    major, minor = sys.version_info[:2]
    lines = ["Metadata-Version: 2.1", "Name: thalweg", f"Version: {version}", f"Summary: {summary}",
             "Author: the thalweg authors", "License: GPL-3.0-or-later", "License-File: LICENSE",
             f"Requires-Python: >={major}.{minor},<{major}.{minor + 1}"]
    lines += [f"Requires-External: {name}" for name in external]
    lines += [f"Requires-Dist: {name.removeprefix('python3-')}" for name in named("numpy")]
    lines += ["Provides-Extra: all"]
    lines += [f"Requires-Dist: {name.removeprefix('python3-')}; extra == \"all\"" for name in named("views")]
    return "\n".join(lines) + """

thalweg makes terrain from its rivers outward: a topology-checked river network, a DEM that these rivers drain, and a report.
This wheel is for the release of Debian that it was built on: each Requires-External is a package of Debian that it needs, and
each Requires-Dist is there as python3-NAME.
"""


build, output = (pathlib.Path(word).resolve() for word in sys.argv[1:])
cache = dict(re.findall(r"^(CMAKE_PROJECT_\w+):STATIC=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE))
version = cache["CMAKE_PROJECT_VERSION"]
with tempfile.TemporaryDirectory() as folder:
    room = pathlib.Path(folder)
    subprocess.run(["cmake", "--install", build, "--component", "python", "--strip", "--prefix", room / "prefix"], check=True,
                   stdout=subprocess.DEVNULL)
    extensions = list(room.glob("prefix/**/thalweg/_core" + sysconfig.get_config_var("EXT_SUFFIX")))
    if len(extensions) != 1:
        sys.exit(f"wheel.py: {build} has no extension for {sys.executable} {sysconfig.get_python_version()}")
    wheel = room / "wheel"
    shutil.copytree(extensions[0].parent, wheel / "thalweg", ignore=shutil.ignore_patterns("__pycache__"))
    info = wheel / f"thalweg-{version}.dist-info"
    info.mkdir()
    shutil.copy(ROOT / "LICENSE", info)
    external = needed(extensions[0], room) + named("fonts")
    (info / "METADATA").write_text(metadata(version, cache["CMAKE_PROJECT_DESCRIPTION"], external))
    tag = next(tag for tag in packaging.tags.sys_tags() if tag.platform.startswith("linux_"))
    (info / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: thalweg {version}\nRoot-Is-Purelib: false\nTag: {tag}\n")
    output.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, "-m", "wheel", "pack", "--dest-dir", output, wheel], check=True, stdout=subprocess.DEVNULL)
