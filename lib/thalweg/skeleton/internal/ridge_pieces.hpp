// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/ridge_lines.hpp>
#include <thalweg/geometry/diagram.hpp>

/// Private to this module.
namespace thalweg::skeleton {

/// A stretch of a ridge between two nodes.
struct RidgePiece {
    std::size_t from = 0; ///< node
    std::size_t to = 0;   ///< node
    RidgeLine ridge;
};

/// Rivers as a diagram takes them, with heights.
struct LabelledRivers {
    std::vector<geometry::LabelledLine> lines;
    std::vector<std::vector<double>> z; ///< [m] by line, one a vertex
};

struct Rise {
    double gain = 0.0;
    double farthest_m = 0.0; ///< infinity for no bound
    double clear_m = 0.0;
};

/// The edges of a diagram of rivers as pieces with heights, without what comes nearer to its sites than clear_m.
std::vector<RidgePiece> ridge_pieces(geometry::Diagram const& diagram, LabelledRivers const& rivers, Rise const& rise);

} // namespace thalweg::skeleton
