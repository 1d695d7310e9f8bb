# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` leaves: bin/thalweg, the program it starts, its manual and completions, the library, its headers, and what find_package(thalweg) needs.
include(CMakePackageConfigHelpers)
set(PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/thalweg)

install(TARGETS thalweg EXPORT thalwegTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS thalweg_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(TARGETS thalweg_program RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/thalweg COMPONENT program)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/bash-completion ${PROJECT_BINARY_DIR}/share/fish
  DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/zsh DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program)
install(DIRECTORY lib/thalweg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp"
  PATTERN internal EXCLUDE)
install(EXPORT thalwegTargets NAMESPACE thalweg:: DESTINATION ${PACKAGE_DIR})

configure_package_config_file(cmake/thalwegConfig.cmake.in ${PROJECT_BINARY_DIR}/thalwegConfig.cmake
  INSTALL_DESTINATION ${PACKAGE_DIR})
# Before 1.0 a minor version may change an interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/thalwegConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/thalwegConfig.cmake ${PROJECT_BINARY_DIR}/thalwegConfigVersion.cmake
  cmake/dependencies.cmake DESTINATION ${PACKAGE_DIR})
