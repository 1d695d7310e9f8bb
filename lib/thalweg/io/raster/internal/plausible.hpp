// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// What is believed of a raster. Private to this module.
namespace thalweg::io {

/// No landscape is so high; a damaged DEFLATE tile reads without an error and gives such numbers.
inline constexpr double implausible_height = 1e30;

/// Sides of a cell that differ less are equal but for the rounding of who wrote them.
inline constexpr double square_within = 1e-6;

} // namespace thalweg::io
