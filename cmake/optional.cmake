# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Optional libraries. find_package reports some that are half installed as found, and with others it ends configure
# altogether: Open MPI's runtime without its headers. So each is tried in a project apart, and one that fails there counts as
# not installed.

# thalweg_try(LIBRARY PACKAGES LOSS): what cannot be used is not found by any find_package that follows. PACKAGES install the
# library; LOSS says what there is not without it.
function(thalweg_try LIBRARY PACKAGES LOSS)
  if(THALWEG_TRIED_${LIBRARY})
    return()
  endif()
  set(PLACE ${PROJECT_BINARY_DIR}/optional/${LIBRARY})
  file(REMOVE_RECURSE ${PLACE})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/optional -B ${PLACE} -G ${CMAKE_GENERATOR}
    -D LIBRARY=${LIBRARY} -D CMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -D CMAKE_MAKE_PROGRAM=${CMAKE_MAKE_PROGRAM}
    "-DCMAKE_PREFIX_PATH=${CMAKE_PREFIX_PATH}"
    RESULT_VARIABLE CODE OUTPUT_VARIABLE SAID ERROR_VARIABLE SAID)
  if(CODE EQUAL 0)
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${PLACE} RESULT_VARIABLE CODE OUTPUT_VARIABLE SAID ERROR_VARIABLE SAID)
  endif()
  if(CODE EQUAL 0)
    set(THALWEG_TRIED_${LIBRARY} ON CACHE INTERNAL "a program with ${LIBRARY} compiles and links")
    return()
  endif()
  file(WRITE ${PLACE}.txt "${SAID}")
  set(CMAKE_DISABLE_FIND_PACKAGE_${LIBRARY} ON PARENT_SCOPE)
  if(SAID MATCHES "not installed")
    message(STATUS "No ${LIBRARY} (${PACKAGES}): ${LOSS}")
  else()
    message(STATUS "${LIBRARY} is installed in part (${PLACE}.txt): without it, ${LOSS}. Install ${PACKAGES}")
  endif()
endfunction()
