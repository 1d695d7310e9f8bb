// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <span>

#include <thalweg/core/run/lanes.hpp>

namespace thalweg::portable {

/// The angles of the vectors (x, y[i]): atan2 of many numbers at a time, with the bits of one at a time.
/// \param y [0, infinity]; not -0
/// \param x (0, infinity)
/// \param angles [rad] [0, pi/2]; NaN where y is; as many as y
/// \param lanes instruction set
void atan2_row(std::span<double const> y, double x, std::span<double> angles, Lanes lanes = widest_lanes());

} // namespace thalweg::portable
