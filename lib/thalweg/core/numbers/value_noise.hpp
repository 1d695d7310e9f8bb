// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/grid.hpp>

namespace thalweg {

/// \pre lattice_cells >= 1.
/// \param seed random seed
/// \param cell the cell
/// \param lattice_cells [cells] >= 1, spacing of the lattice
/// \return Smooth noise in [-1, 1]: random numbers on a lattice with this spacing, joined by x^2 (3 - 2 x).
double value_noise(std::uint64_t seed, Cell cell, double lattice_cells);

} // namespace thalweg
