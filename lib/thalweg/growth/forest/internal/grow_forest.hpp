// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/growth/dla/internal/walk.hpp>

namespace thalweg::growth {

inline constexpr int most_room = 255;

/// Computes the Chebyshev distance of a region's cells to the nearest cell outside it.
/// \param region 0: outside; cells beyond the grid are outside
/// \return in a frame of one cell; 0: outside, at most most_room
Raster<std::uint8_t> distance_to_outside(Mask const& region);

/// The simple random walk in a region among trees, without unit steps in free space: a walker jumps to the boundary of
/// the largest square known to be free of trees and of the region's border. A step that would leave the region is not
/// made. Law: walkers arrive beside the trees as they would by unit steps.
class RegionWalk {
public:
    explicit RegionWalk(Mask const& region);

    bool inside(Cell c) const { return room_[framed(c)] > 0; }
    bool occupied(Cell c) const { return trees_.occupied(site(c)); }
    /// Occupies a cell of the region.
    void occupy(Cell c) { trees_.occupy(site(c)); }

    /// Whether a 4-neighbour is occupied.
    bool beside_a_tree(Cell c) const;

    /// Walks until the walker is on a free cell with an occupied 4-neighbour; it may already be on one.
    /// \param at a free cell in a part of the region with an occupied cell
    /// \param random the walker's random stream
    /// \return false: not there yet after some thousand jumps, so that long walks can be cancelled
    bool approach(Cell& at, RandomStream& random) const;

    /// One step to a 4-neighbour, all equally likely; none if that is occupied or outside the region.
    void step(Cell& at, RandomStream& random) const;

private:
    Site site(Cell c) const {
        return {static_cast<std::int32_t>(c.col - middle_.col), static_cast<std::int32_t>(c.row - middle_.row)};
    }
    static Cell framed(Cell c) { return {c.col + 1, c.row + 1}; }

    Raster<std::uint8_t> room_; ///< in a frame: Chebyshev distance to the nearest cell outside the region, up to 255
    Cell middle_;
    FreeSquares trees_;
    ExitLaw law_;
};

/// The trees of grow_forest during growth, and the cells at which they can grow.
class ForestGrowth {
public:
    /// \throws BadInput when seeds are closer than two steps.
    ForestGrowth(Mask const& region, std::vector<Cell> const& seeds, std::int64_t step, Run const& run);

    RegionWalk const& walk() const { return walk_; }
    std::vector<Cell> const& particles() const { return particles_; }
    std::vector<std::int64_t> const& parents() const { return parents_; }
    std::int64_t cells() const { return cells_; }           ///< cells of the region that walkers reach
    std::int64_t open_cells() const { return open_cells_; } ///< cells that may still hold a particle
    bool open(Cell c) const { return state_[c] == State::open; }
    /// Whether a walker that starts there can stick.
    bool free(Cell c) const { return state_[c] != State::closed; }

    /// Draws a start cell, all equally likely, from those with a path to an open cell.
    Cell draw_start(RandomStream& random) const;

    /// Adds a particle at an open cell.
    void add(Cell c);

private:
    enum class State : std::uint8_t {
        far,   ///< not beside a tree
        open,  ///< beside a tree, may hold a particle
        closed ///< in a tree's reach, or beside one where no particle may ever be; or outside the region
    };

    void place(Cell c, std::int64_t parent);
    void look_around(Cell c);
    bool may_hold(Cell c) const;
    void set(Cell c, State state);
    void find_start_cells();
    /// Calls visit(particle) for particles less than two steps away until it returns false; returns whether it never
    /// did.
    template <class Visit> bool all_near(Cell c, Visit visit) const;

    Grid grid_;
    std::int64_t step_;
    Mask land_; ///< cells that walkers reach
    RegionWalk walk_;
    std::int64_t cells_ = 0;
    std::vector<Cell> particles_;
    std::vector<std::int64_t> parents_;
    Raster<std::int32_t> nearest_;   ///< by cell: the nearest particle, within s + 1; -1: none
    Raster<std::int32_t> first_;     ///< by block of s x s cells: its last particle; -1: none
    std::vector<std::int32_t> next_; ///< by particle: the previous one in its block
    Raster<State> state_;
    std::int64_t open_cells_ = 0;
    std::vector<Cell> opened_;            ///< every open cell, and some that are no longer open
    std::vector<Cell> start_cells_;       ///< cells from which a walker can reach an open cell
    Mask is_start_;                       ///< 1: in start_cells_
    std::int64_t added_since_search_ = 0; ///< particles added since start_cells_ was computed
};

} // namespace thalweg::growth
