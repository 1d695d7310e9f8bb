# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Run by CPack on what it has laid out: Debian wants the changelog and the manual compressed and the library without what
# linking does not need, and zsh looks elsewhere.
file(GLOB_RECURSE PLAIN ${CPACK_TEMPORARY_DIRECTORY}/*)
list(FILTER PLAIN INCLUDE REGEX "/share/man/.*[.][1-9]$|/share/doc/[^/]+/changelog$")
if(NOT PLAIN)
  message(FATAL_ERROR "no manual page or changelog in ${CPACK_TEMPORARY_DIRECTORY}")
endif()
foreach(FILE ${PLAIN})
  execute_process(COMMAND gzip -9n ${FILE} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(GLOB_RECURSE LIBRARY ${CPACK_TEMPORARY_DIRECTORY}/libthalweg.a)
execute_process(COMMAND strip --strip-debug --remove-section=.comment --remove-section=.note
  --enable-deterministic-archives ${LIBRARY} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB_RECURSE ZSH ${CPACK_TEMPORARY_DIRECTORY}/_thalweg)
string(REPLACE /site-functions/ /vendor-completions/ VENDOR ${ZSH})
cmake_path(GET VENDOR PARENT_PATH FOLDER)
file(MAKE_DIRECTORY ${FOLDER})
file(RENAME ${ZSH} ${VENDOR})
cmake_path(GET ZSH PARENT_PATH FOLDER)
file(REMOVE_RECURSE ${FOLDER})
