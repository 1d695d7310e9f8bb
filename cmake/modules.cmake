# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
add_library(thalweg_options INTERFACE)
# No contraction, no fast-math, no -march: the same recipe gives the same bytes on every machine.
target_compile_options(thalweg_options INTERFACE
  -Wall -Wextra -Wconversion -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(thalweg_options INTERFACE -Wno-sign-conversion) # not in g++'s -Wconversion
endif()
# Other versions have false positives.
if(THALWEG_WERROR AND "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" MATCHES "^(GNU 12|Clang 14)\\.")
  set(THALWEG_STRICT -Werror)
endif()
target_compile_options(thalweg_options INTERFACE ${THALWEG_STRICT})
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Files that are compiled as one see one another's names, and g++ knows no main file whose types are its own;
  # at -O3 it takes an inlined vector for memory that was never allocated (12) or for too small (14).
  target_compile_options(thalweg_options INTERFACE -Wshadow=local -Wno-subobject-linkage -Wno-free-nonheap-object
    -Wno-stringop-overflow)
elseif(NOT CMAKE_UNITY_BUILD) # clang++ has no warning of local names alone
  target_compile_options(thalweg_options INTERFACE -Wshadow)
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_definitions(thalweg_options INTERFACE _GLIBCXX_ASSERTIONS)
endif()
if(THALWEG_SANITIZE)
  # g++ with sanitizers takes Boost's named_graph for uninitialised.
  target_compile_options(thalweg_options INTERFACE
    -fsanitize=${THALWEG_SANITIZE} -fno-omit-frame-pointer $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-error=uninitialized>)
  target_link_options(thalweg_options INTERFACE -fsanitize=${THALWEG_SANITIZE})
  if(THALWEG_SANITIZE MATCHES "undefined") # g++ takes comparisons of constant addresses for not constant (bug 71962)
    target_compile_options(thalweg_options INTERFACE
      $<$<CXX_COMPILER_ID:GNU>:-fno-sanitize=null,nonnull-attribute,returns-nonnull-attribute>)
  endif()
  if(THALWEG_SANITIZE STREQUAL "thread")
    target_compile_definitions(thalweg_options INTERFACE THALWEG_TSAN)
    target_compile_options(thalweg_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>) # fences of Boost and oneTBB
  endif()
endif()
if(THALWEG_COVERAGE)
  target_compile_options(thalweg_options INTERFACE --coverage)
  target_link_options(thalweg_options INTERFACE --coverage)
endif()

# thalweg_precompile(TARGET KIND HEADER...): what most files of a kind include is read once for all of its targets, which are
# compiled with the same flags. g++ alone: with clang++ a difference in -D or -O forbids it.
function(thalweg_precompile TARGET KIND)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  target_compile_options(${TARGET} PRIVATE -fpch-preprocess) # for ccache
  get_property(FIRST GLOBAL PROPERTY THALWEG_PRECOMPILED_${KIND})
  if(FIRST)
    target_precompile_headers(${TARGET} REUSE_FROM ${FIRST})
  else()
    set_property(GLOBAL PROPERTY THALWEG_PRECOMPILED_${KIND} ${TARGET})
    target_precompile_headers(${TARGET} PRIVATE <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <limits>
      <map> <memory> <numeric> <optional> <set> <sstream> <string> <vector> <fmt/format.h> <thalweg/core/stream_network.hpp>
      ${ARGN})
  endif()
endfunction()

# thalweg_module(NAME [foreign libraries its .cpp files may use]): one folder of lib/thalweg, compiled apart, without the
# files that THALWEG_LEFT_OUT names (regular expression).
function(thalweg_module NAME)
  if(THALWEG_MODULES AND NOT NAME IN_LIST THALWEG_MODULES)
    return()
  endif()
  file(GLOB_RECURSE SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/thalweg/${NAME}/*.cpp)
  if(THALWEG_LEFT_OUT)
    list(FILTER SOURCES EXCLUDE REGEX "${THALWEG_LEFT_OUT}")
  endif()
  if(NOT SOURCES)
    return()
  endif()
  add_library(thalweg_${NAME} OBJECT ${SOURCES})
  set_target_properties(thalweg_${NAME} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(thalweg_${NAME} PRIVATE ${PROJECT_SOURCE_DIR}/lib ${PROJECT_BINARY_DIR}/generated)
  target_link_libraries(thalweg_${NAME} PRIVATE thalweg_options Boost::headers fmt::fmt ${ARGN})
  if(THALWEG_UNITY)
    thalweg_precompile(thalweg_${NAME} library)
  endif()
  target_sources(thalweg PRIVATE $<TARGET_OBJECTS:thalweg_${NAME}>)
  target_link_libraries(thalweg PRIVATE ${ARGN})
endfunction()

# thalweg_tests(MODULE [NOT_IN_GATE FILTER=LABEL ...] [NEED_LIBNOISE FILTER ...]): one executable test_MODULE of tests/MODULE/*.cpp
# with ctest label MODULE; tests that a filter of GoogleTest names have the label of a part of `scripts/test --full` instead, or
# are left out where libnoise is missing.
function(thalweg_tests NAME)
  cmake_parse_arguments(ARG "" "" "NOT_IN_GATE;NEED_LIBNOISE" ${ARGN})
  file(GLOB_RECURSE SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${NAME}/*.cpp)
  list(FILTER SOURCES EXCLUDE REGEX "/spy/") # a library of its own
  if(THALWEG_TESTS_LEFT_OUT)
    list(FILTER SOURCES EXCLUDE REGEX "${THALWEG_TESTS_LEFT_OUT}")
  endif()
  if(NOT SOURCES)
    return()
  endif()
  add_executable(test_${NAME} ${SOURCES})
  target_include_directories(test_${NAME} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${NAME})
  target_compile_definitions(test_${NAME} PRIVATE
    THALWEG_SOURCE_DIR="${PROJECT_SOURCE_DIR}" THALWEG_EXE="$<TARGET_FILE:thalweg_cli>" THALWEG_VERSION="${PROJECT_VERSION}")
  target_compile_options(test_${NAME} PRIVATE -O1) # the library keeps its own level
  target_link_libraries(test_${NAME} PRIVATE thalweg thalweg_options GTest::gtest GTest::gtest_main rapidcheck
    fmt::fmt nlohmann_json::nlohmann_json GDAL::GDAL)
  if(THALWEG_UNITY)
    set_target_properties(test_${NAME} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    thalweg_precompile(test_${NAME} tests <gtest/gtest.h> <rapidcheck.h>)
  endif()
  set(GATE -Soak*)
  if(NOT TARGET libnoise::libnoise)
    foreach(FILTER IN LISTS ARG_NEED_LIBNOISE)
      string(APPEND GATE ":${FILTER}")
    endforeach()
  endif()
  foreach(OUT IN LISTS ARG_NOT_IN_GATE)
    string(REGEX MATCH "(.*)=(.*)" OUT "${OUT}")
    set(FILTER ${CMAKE_MATCH_1})
    string(APPEND GATE ":${FILTER}")
    gtest_discover_tests(test_${NAME} TEST_PREFIX ${NAME}. TEST_FILTER ${FILTER} TEST_LIST test_${NAME}_${CMAKE_MATCH_2} NO_PRETTY_VALUES
      PROPERTIES LABELS ${CMAKE_MATCH_2} TIMEOUT 3600 ENVIRONMENT "RC_PARAMS=seed=16" DISCOVERY_TIMEOUT 60)
  endforeach()
  # The same inputs every time: `scripts/test --soak` takes others, and what it finds stands in seeds.txt.
  gtest_discover_tests(test_${NAME} TEST_PREFIX ${NAME}. TEST_FILTER ${GATE}
    NO_PRETTY_VALUES PROPERTIES LABELS ${NAME} TIMEOUT 1800 ENVIRONMENT "RC_PARAMS=seed=16" DISCOVERY_TIMEOUT 60)
  file(STRINGS ${CMAKE_CURRENT_SOURCE_DIR}/seeds.txt SEEDS REGEX "^${NAME} ")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/seeds.txt)
  foreach(LINE IN LISTS SEEDS)
    string(REGEX MATCH "^[^ ]+ ([^ ]+) (.+)$" LINE "${LINE}")
    string(MAKE_C_IDENTIFIER "${CMAKE_MATCH_2}" PARAMS)
    add_test(NAME ${NAME}.${CMAKE_MATCH_1}.${PARAMS} COMMAND test_${NAME} --gtest_filter=${CMAKE_MATCH_1})
    set_tests_properties(${NAME}.${CMAKE_MATCH_1}.${PARAMS} PROPERTIES LABELS ${NAME} TIMEOUT 1800
      ENVIRONMENT "RC_PARAMS=${CMAKE_MATCH_2}" FAIL_REGULAR_EXPRESSION "Running 0 tests")
  endforeach()
endfunction()
