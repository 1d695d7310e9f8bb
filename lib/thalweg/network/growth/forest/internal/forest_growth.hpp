// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/network/growth/forest/internal/grow_forest.hpp>

namespace thalweg::network {

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
