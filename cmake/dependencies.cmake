# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Every foreign library, all of them Debian packages. Included by the build and by find_package(thalweg), which say
# how to look for one: macro thalweg_find(NAME VERSION).
set(CMAKE_POLICY_DEFAULT_CMP0167 NEW) # CGAL asks for Boost in CMake's old way, and newer CMakes warn of it
thalweg_find(PkgConfig)
thalweg_find(Threads)
thalweg_find(Boost 1.74 CONFIG)
thalweg_find(CGAL 5.5)
unset(CMAKE_POLICY_DEFAULT_CMP0167)
thalweg_find(GDAL 3.6)
thalweg_find(PROJ CONFIG)
thalweg_find(Eigen3 3.4 CONFIG)
thalweg_find(TBB)
thalweg_find(fmt)
thalweg_find(nlohmann_json)
find_package(OpenCL QUIET) # optional: --device opencl
find_package(OpenEXR CONFIG QUIET) # optional: the format exr of `thalweg export`
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
find_package(LASzip MODULE QUIET) # optional: point clouds in LAZ and COPC
list(POP_BACK CMAKE_MODULE_PATH)
foreach(LIBRARY muparser cairo fontconfig libpng)
  if(NOT TARGET PkgConfig::${LIBRARY})
    pkg_check_modules(${LIBRARY} REQUIRED IMPORTED_TARGET GLOBAL ${LIBRARY})
  endif()
endforeach()
if(NOT TARGET libnoise::libnoise) # optional: skeleton.ridge_noise; its package has no file for CMake or pkg-config
  find_path(LIBNOISE_INCLUDE libnoise/noise.h)
  find_library(LIBNOISE_LIBRARY noise)
  if(LIBNOISE_INCLUDE AND LIBNOISE_LIBRARY)
    add_library(libnoise::libnoise INTERFACE IMPORTED GLOBAL)
    set_target_properties(libnoise::libnoise PROPERTIES
      INTERFACE_INCLUDE_DIRECTORIES ${LIBNOISE_INCLUDE} INTERFACE_LINK_LIBRARIES ${LIBNOISE_LIBRARY})
  elseif(PROJECT_NAME STREQUAL "thalweg")
    message(STATUS "No libnoise (libnoise-dev): no skeleton.ridge_noise")
  endif()
endif()
