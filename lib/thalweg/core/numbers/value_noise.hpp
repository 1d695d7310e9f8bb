// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/grid.hpp>

namespace thalweg {

/// Evaluates smooth noise: random numbers on a lattice, interpolated by x^2 (3 - 2 x).
/// \param seed random seed
/// \param cell where
/// \param lattice_cells [cells] >= 1, spacing of the lattice
/// \return in [-1, 1]
double value_noise(std::uint64_t seed, Cell cell, double lattice_cells);

} // namespace thalweg
