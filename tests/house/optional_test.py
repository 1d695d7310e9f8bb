# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Optional libraries that are half installed count as not installed, and configure says so: optional_test.py CMAKE GROUP=FOUND...
A library whose packages (a GROUP of scripts/packages) are all here was found by this build.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

cmake, groups, source = sys.argv[1], sys.argv[2:], pathlib.Path(__file__).resolve().parents[2]
PROJECT = f"""cmake_minimum_required(VERSION 3.25)
project(apart LANGUAGES CXX)
include({source}/cmake/optional.cmake)
foreach(LIBRARY OpenCL OpenEXR LASzip MPI)
  thalweg_try(${{LIBRARY}} "lib${{LIBRARY}}-dev" "no ${{LIBRARY}} here")
endforeach()
set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI COMPONENTS CXX QUIET)
find_package(OpenCL QUIET)
find_package(OpenEXR CONFIG QUIET)
list(APPEND CMAKE_MODULE_PATH {source}/cmake)
find_package(LASzip MODULE QUIET)
message(STATUS "FOUND [${{MPI_CXX_FOUND}}] [${{OpenCL_FOUND}}] [${{OpenEXR_FOUND}}] [${{LASzip_FOUND}}]")
"""
# As Debian's openmpi-bin without libopenmpi-dev: a wrapper that names folders which are not there.
WRAPPER = """#!/bin/sh
case " $* " in
*showme:command*) echo g++ ;;
*showme:compile*) echo "-I/nowhere/openmpi/include -I/nowhere/openmpi/include/openmpi" ;;
*showme:incdirs*) echo "/nowhere/openmpi/include" ;;
*showme:link*) echo "-L/nowhere/openmpi/lib -lmpi" ;;
*showme:libdirs*) echo "/nowhere/openmpi/lib" ;;
*showme:libs*) echo "mpi" ;;
*showme:version*) echo "mpicxx: Open MPI 4.1.4 (Language: C++)" ;;
*) exit 1 ;;
esac
"""
EXR = """add_library(OpenEXR::OpenEXR INTERFACE IMPORTED)
set_target_properties(OpenEXR::OpenEXR PROPERTIES INTERFACE_INCLUDE_DIRECTORIES /nowhere/imath)
"""

for group in groups:
    name, found = group.split("=")
    known, missing = (subprocess.run([source / "scripts/packages", does, name], text=True, capture_output=True, check=True).stdout
                      for does in ("--list", "--missing"))
    print(f"{name}: found {found}, missing packages: {missing.split()}")
    # A release of Debian may have no package of a library.
    assert missing or not known.split() or found.upper() in ("1", "TRUE", "ON", "YES"), f"{name} is installed, and cmake did not find it"

with tempfile.TemporaryDirectory() as place:
    place = pathlib.Path(place)
    files = {"source/CMakeLists.txt": PROJECT, "bin/mpicxx": WRAPPER, "bin/mpic++": WRAPPER, "include/CL/cl.h": "",
             "include/laszip/laszip_api.h": "",
             "lib/libOpenCL.so": "", "lib/liblaszip.so": "", "lib/libmpi.so": "", "lib/cmake/OpenEXR/OpenEXRConfig.cmake": EXR}
    for name, text in files.items():
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_text(text, "utf-8")
        (place / name).chmod(0o755)
    said = subprocess.run([cmake, "-S", place / "source", "-B", place / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={place}"],
                          env={**os.environ, "PATH": f"{place}/bin:{os.environ['PATH']}"}, text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(said.stdout)
    assert said.returncode == 0, said.returncode
    assert "FOUND [FALSE] [] [] []" in said.stdout or "FOUND [] [] [] []" in said.stdout
    for library in ("MPI", "OpenCL", "OpenEXR", "LASzip"):
        # Beside a real libopenmpi-dev CMake finds out by itself that this wrapper leads nowhere.
        in_part, none = f"-- {library} is installed in part", f"-- No {library} (lib{library}-dev): no {library} here"
        assert in_part in said.stdout or (library == "MPI" and none in said.stdout), library
        assert in_part not in said.stdout or f"no {library} here. Install lib{library}-dev" in said.stdout, library
