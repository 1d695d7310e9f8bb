// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/io/raster/contours.hpp>
#include <thalweg/io/raster/hillshade.hpp>
#include <thalweg/io/raster/read_dem.hpp>
#include <thalweg/io/raster/write_dem.hpp>
