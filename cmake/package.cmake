# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian package of the program, as `scripts/package deb` makes it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME thalweg)
set(CPACK_PACKAGE_VENDOR "the thalweg authors")
set(CPACK_PACKAGE_CONTACT "the thalweg authors <thalweg@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "terrain from its rivers outward")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "\
thalweg reads river networks from files, or grows them, and makes the terrain
around them. It writes a topology-checked river network (GeoPackage,
Shapefile), a DEM that these rivers drain, contours, pictures and a report
page.")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "fonts-noto-cjk")
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

License: GPL-3+
 This program is free software: you can redistribute it and/or modify it
 under the terms of the GNU General Public License as published by the Free
 Software Foundation, either version 3 of the License, or (at your option)
 any later version.
 .
 On Debian systems, the full text of version 3 of the license is in
 /usr/share/common-licenses/GPL-3.
")
install(FILES ${PROJECT_BINARY_DIR}/debian/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT debian)
install(FILES ${PROJECT_BINARY_DIR}/debian/changelog DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT debian)
# Of what is installed, the program and these: the library has no package yet.
set(CPACK_COMPONENTS_ALL program debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
include(CPack)
