// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <thalweg/core/raster.hpp>

namespace thalweg::pipeline {

/// Lines as the report page reads them (web/README.md).
struct PageLines {
    double step = 0.0625;               ///< [cells] unit of positions
    std::vector<std::int64_t> vertices; ///< by line
    std::vector<std::uint8_t> bytes;    ///< differences as zigzagged varints
};

/// Lines in plan as differences of whole steps, a 16th of the side of the page's squares (page_cells).
/// Takes: lines of two vertices or more. Gives: every vertex within half a step of its place along either axis; left
/// out are vertices that fall on the one before, and those on the straight way between their neighbours; the first and
/// last of a line stay. Throws: BadInput, naming the line: fewer than two vertices, no number, or 2^29 steps from the
/// grid's corner.
PageLines page_lines(std::span<std::span<Vec2 const> const> lines, Grid const& grid);

} // namespace thalweg::pipeline
