# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Run by CPack on what it has laid out: Debian wants the changelog and the manual compressed.
file(GLOB_RECURSE PLAIN ${CPACK_TEMPORARY_DIRECTORY}/*/share/man/*.1 ${CPACK_TEMPORARY_DIRECTORY}/*/doc/*/changelog
  ${CPACK_TEMPORARY_DIRECTORY}/usr/share/man/*.1 ${CPACK_TEMPORARY_DIRECTORY}/usr/share/doc/*/changelog)
list(REMOVE_DUPLICATES PLAIN)
if(NOT PLAIN)
  message(FATAL_ERROR "no manual pages in ${CPACK_TEMPORARY_DIRECTORY}")
endif()
foreach(FILE ${PLAIN})
  execute_process(COMMAND gzip -9n ${FILE} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
