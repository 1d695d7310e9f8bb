// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/network/planform/internal/meander.hpp>

/// One step of meander. Private to this module.
namespace thalweg::network {

/// How far each point shall move [m] so that tributaries come down beside the river they join: those that would meet
/// the river above at more than 50 to 80 degrees (by chance) turn about their mouth, less and less up to 40 cells from
/// it. Gives: by point; 0 where rivers end.
/// Source: mean junction angles of 45 to 72 degrees, \cite seybold2017.
std::vector<Vec2> lean_in(Stems const& stems, std::vector<Vec2> const& at, double cell_m, std::uint64_t seed);

} // namespace thalweg::network
