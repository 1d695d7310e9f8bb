# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Every foreign library, all of them Debian packages. Also installed: find_package(thalweg) includes this file.
if(NOT TARGET PkgConfig::cairo OR NOT TARGET PkgConfig::muparser)
  find_package(PkgConfig REQUIRED)
endif()
find_package(Threads REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(CGAL 5.5 REQUIRED)
find_package(GDAL 3.6 REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser)
pkg_check_modules(cairo REQUIRED IMPORTED_TARGET cairo)
