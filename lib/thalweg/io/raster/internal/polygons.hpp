// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Outlines the cells of equal number, for each number in [0, count); negative cells belong to none.
/// \param numbers by cell
/// \param count limit of the numbers
/// \return by number: its parts (cells that touch only at corners are several), each a valid polygon along cell
/// borders, its outer ring first
/// \throws BadInput when a number is count or more
/// \throws IoError when GDAL fails
std::vector<std::vector<Polygon>> polygonise(Raster<std::int32_t> const& numbers, std::int64_t count,
                                             Run const& run = {});

} // namespace thalweg::io
