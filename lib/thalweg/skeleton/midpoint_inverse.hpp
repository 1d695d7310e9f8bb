// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/skeleton.hpp>

namespace thalweg::skeleton {

/// Options of midpoint_inverse().
struct MidpointInverseParams {
    double longest_cells = 1.5; ///< [cells] >= 0, L: no cell takes its height from farther ones; 0: none does
};

/// Midpoint displacement run backwards: from the finest level up, the parents that a known cell would have in the
/// diamond-square scheme get heights from it where they have none.
/// \param skeleton a skeleton of any size; it lies in the north-west of a square of 2^n + 1 cells a side, whose other
/// cells are empty and may pass heights on
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the skeleton's cells bit for bit; a new cell is the mean of its known children at one distance d <= L: for
/// half-steps h = 1, 2, 4, ... first of edges' midpoints (d = h), then of squares' centres (d = h sqrt 2); heights
/// within the skeleton's range; the more cells the larger L.
/// \throws BadParameter
/// \throws BadInput naming the cell: an infinite height
///
/// Source: \cite nenu2015, section 3.2; \cite belhadj2005; specification 3.6.
Skeleton midpoint_inverse(Skeleton const& skeleton, MidpointInverseParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
