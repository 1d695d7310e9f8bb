// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <span>
#include <vector>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/memory.hpp>
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
    /// Occupies the sites of a stamp, all in the region.
    void occupy(Cell middle, Stamp const& stamp) { trees_.occupy(site(middle), stamp); }

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

/// The cells nearer to a cell than a radius.
class Disc {
public:
    /// \param radius [cells] > 0
    explicit Disc(std::int64_t radius);

    std::int64_t reach() const { return std::ssize(reach_) - 1; } ///< [cells] rows on either side
    /// Columns on either side in a row this far from the middle; -1: none.
    std::int64_t reach(std::int64_t row) const {
        return std::abs(row) < std::ssize(reach_) ? reach_[static_cast<std::size_t>(std::abs(row))] : -1;
    }
    std::vector<Site> rim() const; ///< those with a neighbour that is not in it

private:
    std::vector<std::int64_t> reach_;
};

/// One byte a cell, in tiles of 8 x 8 cells that fill a cache line each: what spreads from cell to cell in any
/// direction finds most neighbours at hand. Around the grid is a frame of one cell at least.
template <class Byte> class CellTiles {
public:
    using Index = std::uint32_t;
    static constexpr std::int64_t side = 8;

    CellTiles(Grid const& grid, Byte fill)
        : across_((grid.width + 1) / side + 1),
          bytes_(static_cast<std::size_t>(across_ * ((grid.height + 1) / side + 1) * side * side), fill) {
        static_assert(sizeof(Byte) == 1);
        std::int64_t const to_row = (across_ - 1) * side * side; // beyond the cells of this tile
        for (std::int64_t i = 0; i < side * side; ++i) {
            bool const north = i < side;
            bool const south = i >= side * (side - 1);
            bool const west = i % side == 0;
            bool const east = i % side == side - 1;
            steps_[i] = {static_cast<Index>(north ? -side - to_row : -side),
                         static_cast<Index>(east ? side * (side - 1) + 1 : 1),
                         static_cast<Index>(south ? side + to_row : side),
                         static_cast<Index>(west ? -side * (side - 1) - 1 : -1)};
        }
    }

    /// \param c a cell of the grid or its frame
    Index index(Cell c) const {
        std::int64_t const col = c.col + 1;
        std::int64_t const row = c.row + 1;
        return static_cast<Index>(((row / side * across_ + col / side) * side + row % side) * side + col % side);
    }
    Cell cell(Index i) const {
        std::int64_t const tile = i / (side * side);
        return {tile % across_ * side + i % side - 1, tile / across_ * side + i / side % side - 1};
    }
    /// Indices of the four neighbours of a cell of the grid, in the order of neighbour_offsets.
    std::array<Index, 4> neighbours(Index i) const {
        auto const& steps = steps_[i % (side * side)];
        return {i + steps[0], i + steps[1], i + steps[2], i + steps[3]};
    }

    Byte& operator[](Index i) { return bytes_[i]; }
    Byte& operator[](Cell c) { return bytes_[index(c)]; }
    Byte operator[](Cell c) const { return bytes_[index(c)]; }
    std::span<Byte> all() { return bytes_; }

    /// The column at which the eight cells of one row in the tile around this column begin.
    static std::int64_t first_of_eight(std::int64_t col) { return (col + 1) / side * side - 1; }
    /// These eight bytes as a word.
    std::uint64_t eight(Cell first) const {
        std::uint64_t word = 0;
        std::memcpy(&word, &bytes_[index(first)], sizeof(word));
        return word;
    }

private:
    std::int64_t across_;
    std::vector<Byte, LargePages<Byte>> bytes_;
    std::array<std::array<Index, 4>, side * side> steps_{};
};

/// Removes the 4-connected cells around one of them from a mask.
/// \return their number
std::int64_t take_piece(Cell from, Mask& left, Run const& run);

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
        closed, ///< in a tree's reach, or beside one where no particle may ever be; or outside the region
        far,    ///< not beside a tree
        start,  ///< the same, and a walker from there could reach an open cell when that was last looked up
        open    ///< beside a tree, may hold a particle
    };
    using Index = CellTiles<State>::Index;

    void place(Cell c, std::int64_t parent);
    void look_around(Cell c);
    void open_or_close(Cell c);
    bool may_hold(Cell c);
    void find_start_cells();
    /// Particles less than two steps away; the list lasts until the next call.
    std::vector<std::int32_t> const& near(Cell c);
    /// The nearest of these particles; of several the first that came.
    std::int32_t nearest_of(std::vector<std::int32_t> const& near, Cell c) const;

    Grid grid_;
    std::int64_t step_;
    Disc disc_;
    Stamp rim_; ///< of the disc
    RegionWalk walk_;
    std::int64_t cells_ = 0;
    std::vector<Cell> particles_;
    std::vector<std::int64_t> parents_;
    Raster<std::int32_t> first_;      ///< by block of s x s cells: its last particle; -1: none
    std::vector<std::int32_t> next_;  ///< by particle: the previous one in its block
    std::vector<std::int32_t> found_; ///< what near() found
    CellTiles<State> state_;          ///< the frame is closed
    std::int64_t open_cells_ = 0;
    std::vector<Index> opened_; ///< every open cell, and some that are no longer open
    /// Cells from which a walker can reach an open cell, nearest first; room for all of them and one more.
    std::vector<Index, LargePages<Index>> start_cells_;
    std::size_t starts_ = 0;              ///< their number
    std::int64_t added_since_search_ = 0; ///< particles added since start_cells_ was computed
};

} // namespace thalweg::growth
