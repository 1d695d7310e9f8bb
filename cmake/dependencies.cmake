# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Every foreign library, all of them Debian packages. Included by the build and by find_package(thalweg), which say
# how to look for one: macro thalweg_find(NAME VERSION).
thalweg_find(PkgConfig)
thalweg_find(Threads)
thalweg_find(Boost 1.74)
thalweg_find(CGAL 5.5)
thalweg_find(GDAL 3.6)
thalweg_find(Eigen3 3.4 CONFIG)
thalweg_find(TBB)
thalweg_find(fmt)
thalweg_find(nlohmann_json)
foreach(LIBRARY muparser cairo)
  if(NOT TARGET PkgConfig::${LIBRARY})
    pkg_check_modules(${LIBRARY} REQUIRED IMPORTED_TARGET GLOBAL ${LIBRARY})
  endif()
endforeach()
