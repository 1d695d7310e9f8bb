// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {

/// A vertex at which a river may be joined.
struct Confluence {
    Vec2 at;
    std::int64_t basin = 0;
};

/// Where rivers run: their cells, the corners they cut diagonally, and the segments near each cell.
class CarryGround {
public:
    CarryGround(Grid const& grid, CarryParams const& params);

    Grid const& grid() const { return grid_; }
    double cost_of_joining() const { return params_.join_cells; }

    /// basin: by whose number inner vertices may be joined.
    void add(std::vector<Vec2> const& line, std::int64_t basin, std::string const& what);

    /// What it costs to enter a cell: rivers repel.
    double cost(Cell c) const;

    /// What a river may run into in a cell, or null.
    Confluence const* confluence_in(Cell c) const;

    /// Whether a river may run from p, a point of cell `from`, to the centre of its neighbour `to`. A river that ends
    /// in p may, too.
    bool open(Vec2 p, Cell from, Cell to) const;

    /// Whether a river may run from p, a point of cell `from`, to a vertex of the river in its neighbour `to`.
    bool opens_to(Confluence const& confluence, Vec2 p, Cell from, Cell to) const;

private:
    static constexpr std::uint8_t far = 255;

    /// Whether the step to a neighbour crosses a river that runs diagonally between the two others.
    bool cuts_a_corner(Cell from, Cell to) const;
    template <class Holds> bool all_near(Cell from, Cell to, Holds const& holds) const;
    /// Lowers the city-block distances around new river cells.
    void spread(std::vector<Cell> front);
    /// Notes a segment with every cell it passes or touches.
    void touch(Segment s);

    Grid grid_;
    CarryParams params_;
    double slack_m_;
    Raster<std::uint8_t> distance_; ///< [cells] city-block, to the nearest river cell; 255: that far or farther
    Raster<std::uint8_t> corner_;   ///< by cell, for its south-east corner: 1 where a river runs NW-SE, 2 NE-SW
    std::vector<Segment> segments_;
    std::unordered_map<std::int64_t, Confluence> confluences_;            ///< by cell; looked up only, never walked
    std::unordered_map<std::int64_t, std::vector<std::size_t>> touching_; ///< looked up only, never walked
};

} // namespace thalweg::network
