// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Outlines of the cells of equal number, for each of the numbers [0, count); what is below 0 belongs to none.
/// Gives: by number its parts, cells that touch in corners only being several; each a valid polygon of corners of
/// cells, its outer ring first. Throws: BadInput when a number is count or more; IoError; Cancelled.
std::vector<std::vector<Polygon>> polygonise(Raster<std::int32_t> const& numbers, std::int64_t count,
                                             Run const& run = {});

} // namespace thalweg::io
