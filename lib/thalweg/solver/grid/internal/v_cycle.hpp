// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/internal/grid_levels.hpp>
#include <thalweg/solver/grid/internal/grid_rows.hpp>

namespace thalweg::solver {

/// z = M r with M one V(1,1) cycle: symmetric and positive definite, near the inverse of the problem's matrix.
/// On every level one red-black Gauss-Seidel sweep from zero, the correction of the coarser level, and the sweep
/// backwards; the coarser levels' edges are halved for what constant pieces lack. Legs run down and up the rows once,
/// so that of the sweeps only z is ever stored. Gives: the sum of r z. The same bytes for any number of threads: a
/// range of rows makes the rows around it anew. Source: Braess 1995, Towards
/// algebraic multigrid for elliptic problems of second order (aggregation).
double v_cycle(TopLevel const& top, std::vector<CoarseLevel>& coarse, TwoColours<float> const& r, TwoColours<float>& z,
               GridRows const& rows, Run const& run);

} // namespace thalweg::solver
