# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian packages, one a component of what is installed, as `scripts/package deb` makes them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME thalweg)
set(CPACK_PACKAGE_VENDOR "the thalweg authors")
set(CPACK_PACKAGE_CONTACT "the thalweg authors <thalweg@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SOURCE thalweg)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_files.cmake)

# The changelog's date is that of the last commit: the same sources give the same package.
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%cD OUTPUT_VARIABLE DATE ERROR_QUIET
  OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT DATE)
  string(TIMESTAMP DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
string(REGEX MATCH "20[0-9][0-9]" YEAR "${DATE}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/changelog CONTENT "\
thalweg (${PROJECT_VERSION}) unstable; urgency=medium

  * What changed stands in CHANGELOG.md of the sources.

 -- ${CPACK_PACKAGE_CONTACT}  ${DATE}
")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/copyright CONTENT "\
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: thalweg

Files: *
Copyright: ${YEAR} the thalweg authors
License: GPL-3+

Files: web/dist/terrain.html
Copyright: 2023 MapLibre contributors
           2020 Mapbox
           2010-2016 Mike Bostock
           2011 Evan Wallace
License: GPL-3+ and BSD-3-Clause and Expat
Comment: It holds MapLibre GL JS, with its whole licence in the page.

Files: samples/*.gpkg samples/*.tif samples/points.csv
Copyright: none, data of the government of the United States of America
License: public-domain
 Rivers of NHDPlus and heights of SRTM, which samples/PROVENANCE.md traces
 to their sources.

License: GPL-3+
 This program is free software: you can redistribute it and/or modify it
 under the terms of the GNU General Public License as published by the Free
 Software Foundation, either version 3 of the License, or (at your option)
 any later version.
 .
 On Debian systems, the full text of version 3 of the license is in
 /usr/share/common-licenses/GPL-3.

License: BSD-3-Clause
 Redistribution and use in source and binary forms, with or without
 modification, are permitted provided that the following conditions are met:
 .
 * Redistributions of source code must retain the above copyright notice,
   this list of conditions and the following disclaimer.
 * Redistributions in binary form must reproduce the above copyright notice,
   this list of conditions and the following disclaimer in the documentation
   and/or other materials provided with the distribution.
 * Neither the name of the copyright holders nor the names of contributors
   may be used to endorse or promote products derived from this software
   without specific prior written permission.
 .
 THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS AS IS AND
 ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE IMPLIED
 WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE
 DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT OWNER OR CONTRIBUTORS BE LIABLE
 FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL
 DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR
 SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER
 CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY,
 OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE
 OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.

License: Expat
 Permission is hereby granted, free of charge, to any person obtaining a copy
 of this software and associated documentation files (the Software), to deal
 in the Software without restriction, including without limitation the rights
 to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
 copies of the Software, and to permit persons to whom the Software is
 furnished to do so, subject to the following conditions:
 .
 The above copyright notice and this permission notice shall be included in
 all copies or substantial portions of the Software.
 .
 THE SOFTWARE IS PROVIDED AS IS, WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
 IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
 FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
 AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
 LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
 OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
 SOFTWARE.
")

# depends_on(VARIABLE GROUP...): what scripts/packages names, as a field of a package
function(depends_on VARIABLE)
  execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/packages --list ${ARGN} OUTPUT_VARIABLE NAMES
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ", " NAMES "${NAMES}")
  set(${VARIABLE} "${NAMES}" PARENT_SCOPE)
endfunction()

# debian_package(COMPONENT NAME SECTION DESCRIPTION): the description's first line is the summary. Other fields: CPACK_DEBIAN_*.
macro(debian_package COMPONENT NAME SECTION DESCRIPTION)
  string(TOUPPER ${COMPONENT} FIELD)
  list(APPEND CPACK_COMPONENTS_ALL ${COMPONENT})
  set(CPACK_DEBIAN_${FIELD}_PACKAGE_NAME ${NAME})
  set(CPACK_DEBIAN_${FIELD}_PACKAGE_SECTION ${SECTION})
  set(CPACK_DEBIAN_${FIELD}_DESCRIPTION "${DESCRIPTION}")
  install(FILES ${PROJECT_BINARY_DIR}/debian/copyright ${PROJECT_BINARY_DIR}/debian/changelog
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${NAME} COMPONENT ${COMPONENT} EXCLUDE_FROM_ALL)
endmacro()

# compiled_by_python(COMPONENT NAME [FOLDER]): what Python compiles of a package, in a folder that is not Python's own, is no file
# of the package, and goes with it.
macro(compiled_by_python COMPONENT NAME)
  set(SCRIPTS ${PROJECT_BINARY_DIR}/debian/${NAME})
  string(TOUPPER ${COMPONENT} FIELD)
  file(CONFIGURE OUTPUT ${SCRIPTS}/postinst CONTENT "\
#!/bin/sh
set -e
if [ \"$1\" = configure ] && command -v py3compile >/dev/null; then
    py3compile -p ${NAME} ${ARGN}
fi
" @ONLY)
  file(CONFIGURE OUTPUT ${SCRIPTS}/prerm CONTENT "\
#!/bin/sh
set -e
if command -v py3clean >/dev/null; then
    py3clean -p ${NAME} ${ARGN}
fi
" @ONLY)
  set(CPACK_DEBIAN_${FIELD}_PACKAGE_CONTROL_EXTRA ${SCRIPTS}/postinst ${SCRIPTS}/prerm)
endmacro()

unset(CPACK_COMPONENTS_ALL)
depends_on(FONTS fonts)
debian_package(program thalweg science "\
terrain from its rivers outward
thalweg reads river networks from files, or grows them, and makes the terrain
around them. It writes a topology-checked river network (GeoPackage,
Shapefile), a DEM that these rivers drain, contours, pictures and a report
page.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${FONTS}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "fonts-noto-cjk")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "thalweg-doc")

set(OPTIONAL)
if(TARGET libnoise::libnoise)
  list(APPEND OPTIONAL noise)
endif()
if(OpenCL_FOUND)
  list(APPEND OPTIONAL opencl)
endif()
if(OpenEXR_FOUND)
  list(APPEND OPTIONAL exr)
endif()
if(LASzip_FOUND)
  list(APPEND OPTIONAL laszip)
endif()
debian_package(library libthalweg-dev libdevel "\
terrain from its rivers outward - C++ library
thalweg reads river networks from files, or grows them, and makes the terrain
around them.

This package contains the static library and its headers, for C++20, with
what CMake's find_package(thalweg) and pkg-config need.")
depends_on(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS library fonts ${OPTIONAL})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "thalweg-doc")

if(TARGET thalweg_python)
  debian_package(python python3-thalweg python "\
terrain from its rivers outward - Python 3 module
thalweg reads river networks from files, or grows them, and makes the terrain
around them.

This package contains the Python module thalweg: rasters are NumPy arrays,
and networks can be handed to GeoPandas and NetworkX.")
  # The extension is loaded by the minor version of Python that it was compiled for.
  execute_process(COMMAND /usr/bin/python3 -c "from sys import version_info as v; print(v[1])" OUTPUT_VARIABLE MINOR
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  math(EXPR NEXT "${MINOR} + 1")
  depends_on(NUMPY numpy fonts)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${MINOR}), python3 (<< 3.${NEXT}), ${NUMPY}")
  depends_on(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS views)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "thalweg-doc")
  compiled_by_python(python python3-thalweg)
endif()

debian_package(qgis qgis-plugin-thalweg science "\
terrain from its rivers outward - QGIS plugin
thalweg reads river networks from files, or grows them, and makes the terrain
around them.

This package contains algorithms for the Processing toolbox of QGIS: make
terrain, check, repair and convert river networks, measure drainage, make TINs,
blend DEMs and draw pictures.")
set(CPACK_DEBIAN_QGIS_PACKAGE_ARCHITECTURE all)
depends_on(PLUGIN plugin)
set(CPACK_DEBIAN_QGIS_PACKAGE_DEPENDS "thalweg, python3, ${PLUGIN}")
set(CPACK_DEBIAN_QGIS_PACKAGE_SUGGESTS "thalweg-doc")
compiled_by_python(qgis qgis-plugin-thalweg /usr/share/qgis/python/plugins/thalweg_processing)

debian_package(documentation thalweg-doc doc "\
terrain from its rivers outward - documentation
thalweg reads river networks from files, or grows them, and makes the terrain
around them.

This package contains its documentation and the samples: recipes, river files,
DEMs and programs.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SUGGESTS "thalweg, libthalweg-dev, python3-thalweg")
# Laid out as in the sources, so that links between pages and to samples hold.
set(DOC ${CMAKE_INSTALL_DATADIR}/doc/thalweg-doc)
set(IN_DOC COMPONENT documentation EXCLUDE_FROM_ALL)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff DESTINATION ${DOC} ${IN_DOC})
install(FILES web/README.md DESTINATION ${DOC}/web ${IN_DOC})
install(DIRECTORY docs samples DESTINATION ${DOC} ${IN_DOC} PATTERN CMakeLists.txt EXCLUDE PATTERN Doxyfile.in EXCLUDE
  PATTERN reference.dox EXCLUDE PATTERN "*.swp" EXCLUDE)
include(CPack)
