# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# LASzip has no file for CMake in its Debian package (liblaszip-dev, from Debian 13 on).
include(FindPackageHandleStandardArgs)
find_path(LASZIP_INCLUDE laszip/laszip_api.h)
find_library(LASZIP_LIBRARY laszip)
mark_as_advanced(LASZIP_INCLUDE LASZIP_LIBRARY)
find_package_handle_standard_args(LASzip REQUIRED_VARS LASZIP_LIBRARY LASZIP_INCLUDE)
if(LASzip_FOUND AND NOT TARGET LASzip::LASzip)
  add_library(LASzip::LASzip INTERFACE IMPORTED GLOBAL)
  set_target_properties(LASzip::LASzip PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${LASZIP_INCLUDE} INTERFACE_LINK_LIBRARIES ${LASZIP_LIBRARY})
endif()
