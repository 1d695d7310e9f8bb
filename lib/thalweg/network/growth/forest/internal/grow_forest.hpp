// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/network/growth/dla/internal/walk.hpp>

namespace thalweg::network {

inline constexpr int most_room = 255;

/// How much room the cells of a region have: the Chebyshev distance to the nearest cell outside it.
/// Takes: 0 outside; what lies beyond the grid is outside. Gives: in a frame of one cell, 0 outside, at most most_room.
Raster<std::uint8_t> room_in(Mask const& region);

/// The simple random walk in a region among trees, without its unit steps where there is room: a walker jumps to the
/// boundary of the largest square known to be free of trees and of the region's border. A step that would leave the
/// region is not made. Law: walkers arrive beside the trees as they do by unit steps.
class RegionWalk {
public:
    explicit RegionWalk(Mask const& region);

    bool inside(Cell c) const { return room_[framed(c)] > 0; }
    bool occupied(Cell c) const { return trees_.occupied(site(c)); }
    /// Occupies a cell of the region.
    void occupy(Cell c) { trees_.occupy(site(c)); }

    /// Whether a 4-neighbour is occupied.
    bool beside_a_tree(Cell c) const;

    /// Walks until the walker stands on a free cell with an occupied 4-neighbour; there it may be already.
    /// Takes: a free cell of a part of the region in which some cell is occupied.
    /// Gives: whether it is there; not yet after some thousand jumps, so that who walks far can be stopped.
    bool approach(Cell& at, RandomStream& random) const;

    /// One step to a 4-neighbour, each as likely; none where that is occupied or outside the region.
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

/// The trees of grow_forest as they stand, and the cells at which they can grow.
class ForestGrowth {
public:
    /// Throws: BadInput for seeds nearer than two steps.
    ForestGrowth(Mask const& region, std::vector<Cell> const& seeds, std::int64_t step);

    RegionWalk const& walk() const { return walk_; }
    std::vector<Cell> const& particles() const { return particles_; }
    std::vector<std::int64_t> const& parents() const { return parents_; }
    std::int64_t cells() const { return cells_; }           ///< of the region that walkers reach
    std::int64_t open_cells() const { return open_cells_; } ///< at which a particle may be
    bool open(Cell c) const { return state_[c] == State::open; }
    /// Whether a walker that starts there comes to anything.
    bool free(Cell c) const { return state_[c] != State::barren; }

    /// A cell where a walker starts, each as likely: those from which it could not come to an open cell are left out.
    Cell birth(RandomStream& random) const;

    /// A particle holds at an open cell.
    void add(Cell c);

private:
    enum class State : std::uint8_t {
        far,   ///< not beside a tree
        open,  ///< beside a tree, where a particle may be
        barren ///< in a tree's reach, or beside one where no particle may ever be; outside the region
    };

    void place(Cell c, std::int64_t parent);
    void look_around(Cell c);
    bool may_hold(Cell c) const;
    void set(Cell c, State state);
    void find_births();
    /// Calls visit(particle) for those less than two steps away, until it says no; whether it never did.
    template <class Visit> bool all_near(Cell c, Visit visit) const;

    Grid grid_;
    std::int64_t step_;
    Mask land_; ///< what walkers reach
    RegionWalk walk_;
    std::int64_t cells_ = 0;
    Indexed<std::int32_t, Cell> particles_;
    Indexed<std::int32_t, std::int64_t> parents_;
    Raster<std::int32_t> nearest_;             ///< by cell: the nearest particle, within s + 1; -1 for none
    Raster<std::int32_t> first_;               ///< by block of s x s cells: its last particle, -1 for none
    Indexed<std::int32_t, std::int32_t> next_; ///< by particle: the one before it in its block
    Raster<State> state_;
    std::int64_t open_cells_ = 0;
    std::vector<Cell> opened_;  ///< every open cell, and some that are so no more
    std::vector<Cell> births_;  ///< from where a walker can come to an open cell
    Mask fertile_;              ///< 1 on births
    std::int64_t outdated_ = 0; ///< particles since births were found
};

} // namespace thalweg::network
