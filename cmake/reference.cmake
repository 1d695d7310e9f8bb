# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Target `reference`: the library's documentation by Doxygen in build/docs/html, where a warning is an error
# (scripts/test --full docs).
find_program(DOXYGEN doxygen)
find_program(BIBTEX bibtex) # Doxygen's \cite runs it
if(NOT DOXYGEN OR NOT BIBTEX)
  return()
endif()
set(REFERENCE_DIR ${PROJECT_BINARY_DIR}/docs)
set(REFERENCE_WARN_AS_ERROR FAIL_ON_WARNINGS) # after all of them are printed
configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${REFERENCE_DIR}/Doxyfile @ONLY)
# Debian's bibtex alone has no configuration that says where it looks.
set(WRITE_REFERENCE ${CMAKE_COMMAND} -E env BIBINPUTS=. BSTINPUTS=. ${DOXYGEN} ${REFERENCE_DIR}/Doxyfile)
add_custom_target(reference COMMAND ${WRITE_REFERENCE} COMMENT "Writing ${REFERENCE_DIR}/html/index.html"
  USES_TERMINAL VERBATIM)
