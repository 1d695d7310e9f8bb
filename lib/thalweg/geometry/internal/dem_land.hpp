// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// Where triangles between the cell centres of a DEM may be: squares between four centres with data, halves of those
/// with three.
class DemLand {
public:
    explicit DemLand(Raster<float> const& dem) : dem_(dem) {}

    bool has(std::int64_t col, std::int64_t row) const {
        return dem_.grid().contains({col, row}) && !std::isnan(dem_[Cell{col, row}]);
    }
    /// Centres with data of the square south-east of a centre.
    int corners(std::int64_t col, std::int64_t row) const {
        return (has(col, row) ? 1 : 0) + (has(col + 1, row) ? 1 : 0) + (has(col, row + 1) ? 1 : 0) +
               (has(col + 1, row + 1) ? 1 : 0);
    }
    bool holds(std::int64_t col, std::int64_t row) const {
        return has(col, row) && (corners(col, row) >= 3 || corners(col - 1, row) >= 3 || corners(col, row - 1) >= 3 ||
                                 corners(col - 1, row - 1) >= 3);
    }
    /// Whether the outline runs from a centre to its neighbour: the land lies on one side of the step, not on both.
    bool outline(std::int64_t col, std::int64_t row, int dx, int dy) const;
    /// Steps of the outline at a centre.
    int degree(std::int64_t col, std::int64_t row) const;
    /// Whether a triangle whose sides do not cross the outline lies on land: asked at its middle, given thrice.
    bool is_inside(std::int64_t col3, std::int64_t row3) const;

private:
    Raster<float> const& dem_;
};

/// The outline as straight lines between its corners; heights go with them. x: column, y: minus the row.
/// Throws: Cancelled.
std::vector<std::vector<Vec3>> outlines_of(Raster<float> const& dem, DemLand const& land, Run const& run);

} // namespace thalweg::geometry
