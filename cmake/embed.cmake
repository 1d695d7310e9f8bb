# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Included: thalweg_embed(TARGET FILE HEADER SPACE FUNCTION) adds to a target the function of a header, in namespace
# thalweg::SPACE, that gives the bytes of a file; they are read again whenever the file changes. As a script: writes that .cpp file.
if(CMAKE_SCRIPT_MODE_FILE)
  # Through hexadecimal digits any byte survives, and none has a meaning to CMake or C++ on the way.
  file(READ ${FILE} HEX HEX)
  string(REGEX REPLACE "(................................................)" "\\1\n" HEX "${HEX}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" HEX "${HEX}")
  string(REPLACE "\n" "\"\n    \"" HEX "${HEX}")
  file(WRITE ${OUT} "\
// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Written by cmake/embed.cmake.
#include <${HEADER}>

namespace thalweg::${SPACE} {

std::string_view ${FUNCTION}() {
    static constexpr char bytes[] =
    \"${HEX}\";
    return {bytes, sizeof bytes - 1};
}

} // namespace thalweg::${SPACE}
")
  return()
endif()

set(THALWEG_EMBED ${CMAKE_CURRENT_LIST_FILE})
function(thalweg_embed TARGET FILE HEADER SPACE FUNCTION)
  set(OUT ${PROJECT_BINARY_DIR}/generated/${FUNCTION}.cpp)
  add_custom_command(OUTPUT ${OUT}
    COMMAND ${CMAKE_COMMAND} -DFILE=${FILE} -DOUT=${OUT} -DHEADER=${HEADER} -DSPACE=${SPACE} -DFUNCTION=${FUNCTION} -P ${THALWEG_EMBED}
    DEPENDS ${FILE} ${THALWEG_EMBED} COMMENT "Embedding ${FILE}" VERBATIM)
  set_source_files_properties(${OUT} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON) # clang-tidy reads units before it is written
  target_sources(${TARGET} PRIVATE ${OUT})
endfunction()
