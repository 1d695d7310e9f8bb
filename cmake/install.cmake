# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` leaves, by component. program: bin/thalweg, the program it starts, its manual and completions. library:
# the library, its headers, and what find_package(thalweg) and pkg-config need. python: see python/CMakeLists.txt. qgis: the plugin
# of QGIS.
include(CMakePackageConfigHelpers)
set(PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/thalweg)

install(TARGETS thalweg EXPORT thalwegTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(TARGETS thalweg_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(TARGETS thalweg_program RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/thalweg COMPONENT program)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/bash-completion ${PROJECT_BINARY_DIR}/share/fish
  DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/zsh DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program)
install(DIRECTORY lib/thalweg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library FILES_MATCHING PATTERN "*.hpp"
  PATTERN internal EXCLUDE)
install(EXPORT thalwegTargets NAMESPACE thalweg:: DESTINATION ${PACKAGE_DIR} COMPONENT library)

configure_package_config_file(cmake/thalwegConfig.cmake.in ${PROJECT_BINARY_DIR}/thalwegConfig.cmake
  INSTALL_DESTINATION ${PACKAGE_DIR})
# Before 1.0 a minor version may change an interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/thalwegConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/thalwegConfig.cmake ${PROJECT_BINARY_DIR}/thalwegConfigVersion.cmake
  cmake/dependencies.cmake cmake/FindLASzip.cmake DESTINATION ${PACKAGE_DIR} COMPONENT library)

# For pkg-config: each library by name, since Requires.private would ask for all that GDAL itself was linked to.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX} OUTPUT_VARIABLE LIBDIR)
string(REGEX REPLACE "[^/]+" ".." UP "${LIBDIR}")
set(LIBRARIES "-ltbb -lgmp -lmpfr -lmuparser -lcairo -lfontconfig -lpng -lgdal -lproj -lfmt")
if(TARGET libnoise::libnoise)
  string(APPEND LIBRARIES " -lnoise")
endif()
if(OpenCL_FOUND)
  string(APPEND LIBRARIES " -lOpenCL")
endif()
if(OpenEXR_FOUND)
  string(APPEND LIBRARIES " -lOpenEXR -lIex")
endif()
if(LASzip_FOUND)
  string(APPEND LIBRARIES " -llaszip")
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/thalweg.pc @ONLY CONTENT [[
prefix=${pcfiledir}/../@UP@
libdir=${prefix}/@LIBDIR@
includedir=${prefix}/@CMAKE_INSTALL_INCLUDEDIR@

Name: thalweg
Description: @PROJECT_DESCRIPTION@ (C++20, static)
Version: @PROJECT_VERSION@
Cflags: -I${includedir}
Libs: -L${libdir} -lthalweg @LIBRARIES@ -pthread
]])
install(FILES ${PROJECT_BINARY_DIR}/thalweg.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)

set(PLUGINS ${CMAKE_INSTALL_DATADIR}/qgis/python/plugins)
configure_file(qgis/thalweg_processing/metadata.txt ${PROJECT_BINARY_DIR}/qgis/metadata.txt @ONLY)
install(DIRECTORY qgis/thalweg_processing DESTINATION ${PLUGINS} COMPONENT qgis EXCLUDE_FROM_ALL
  FILES_MATCHING PATTERN "*.py" PATTERN "*.svg" PATTERN __pycache__ EXCLUDE)
find_program(THALWEG_PYTHON3 python3) # without it, the plugin has no button Help
if(THALWEG_PYTHON3)
  install(CODE "execute_process(COMMAND ${THALWEG_PYTHON3} -B ${PROJECT_SOURCE_DIR}/qgis/manual.py
    \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${PLUGINS}/thalweg_processing/help COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT qgis EXCLUDE_FROM_ALL)
endif()
install(FILES ${PROJECT_BINARY_DIR}/qgis/metadata.txt DESTINATION ${PLUGINS}/thalweg_processing COMPONENT qgis EXCLUDE_FROM_ALL)
