// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/layers.hpp>
#include <thalweg/surface/equilibrium/internal/rock.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// factor area ^ exponent from a table: exact for whole numbers below 512, above that for areas rounded down to nine
/// binary digits. bend_area: the area below which the power approaches a constant; 0: none.
class AreaPower {
public:
    /// \param most area in the table; larger ones take longer
    explicit AreaPower(double exponent, double bend_area = 0.0, double factor = 1.0, double most = 0x1p40)
        : exponent_(exponent), least_(least_of(bend_area, exponent)), factor_(factor) {
        table_.resize(place_of(static_cast<float>(most)) + 1);
        for (std::size_t i = 0; i < table_.size(); ++i) {
            table_[i] = at(i);
        }
    }

    /// area: at least 1.
    float operator()(float area) const {
        std::size_t const place = place_of(area);
        return place < table_.size() ? table_[place] : at(place);
    }

    /// \return area ^ exponent without a table.
    static double of(double area, double exponent, double bend_area) {
        return bent(area, exponent, least_of(bend_area, exponent));
    }

private:
    static constexpr double sharpness = 2.0; // of the bend
    static double least_of(double bend_area, double exponent) {
        return bend_area > 0.0 ? portable::pow(bend_area, sharpness * exponent) : 0.0;
    }
    static double bent(double area, double exponent, double least) {
        return least > 0.0 ? std::sqrt(portable::pow(area, sharpness * exponent) + least)
                           : portable::pow(area, exponent);
    }

    static std::size_t place_of(float area) { return (std::bit_cast<std::uint32_t>(area) >> dropped) - first; }
    [[gnu::noinline]] float at(std::size_t place) const { // seldom, so that loops keep to the table
        auto const bits = static_cast<std::uint32_t>((place + first) << dropped);
        return static_cast<float>(factor_ * bent(static_cast<double>(std::bit_cast<float>(bits)), exponent_, least_));
    }

    static constexpr std::uint32_t dropped = 15;
    static constexpr std::size_t first = std::size_t{127} << 8;
    double exponent_;
    double least_; ///< of the bend
    double factor_;
    std::vector<float> table_;
};

/// How hillsides are cut and creep: U + creep lap z = power(A) S, lengths, heights and areas in cells of the finest
/// level.
struct LandLaw {
    AreaPower power; ///< K A^theta; below the area of debris flows these cut as well, and slopes become nearly constant
                     ///< (Stock and Dietrich 2003)
    float creep;     ///< D, from the length below which creep dominates (Perron 2009)
};

/// U + D lap z = K A^theta S in the solver's units: lengths, heights and areas in cells of the finest level, U = 1 by
/// default, and K such that slopes at small areas are the same at any cell size and stay well within float precision.
struct EquilibriumLaw {
    /// \param most [finest cells] area that is common
    EquilibriumLaw(EquilibriumParams const& params, double cell_m, double most)
        : EquilibriumLaw(params, cell_m, incision(params, cell_m), most) {}

    AreaPower power; ///< K A^theta, of the input rivers
    LandLaw land;
    float source_area; ///< [finest cells] contributing area at a drawn source

private:
    EquilibriumLaw(EquilibriumParams const& params, double cell_m, double k, double most)
        : power(params.theta, 0.0, k, most),
          land{AreaPower(params.theta, debris_cells(params, cell_m), k, most),
               static_cast<float>(
                   k * portable::pow(std::min(params.hillslope_m / cell_m, most_creep), 2.0 * params.theta + 1.0))},
          source_area(static_cast<float>(source_area_m2 / (cell_m * cell_m))) {}

    static double debris_cells(EquilibriumParams const& params, double cell_m) {
        return params.debris_area_m2 / (cell_m * cell_m);
    }
    static double incision(EquilibriumParams const& params, double cell_m) {
        constexpr double of_one_cell = 4.7; // fraction of uplift: slopes of heads are a good half of the cap
        return of_one_cell / AreaPower::of(1.0, params.theta, debris_cells(params, cell_m));
    }

    static constexpr double most_creep = 100.0; // [finest cells] limit above which the rounds do not converge
    static constexpr double source_area_m2 = 90'000.0;
};

/// The direction from a cell to its neighbour, as in d8_steps; -1: not neighbours. Both cells are inside a frame.
inline std::int8_t direction_between(std::size_t from, std::size_t to, std::int64_t width) {
    std::int64_t const step = static_cast<std::int64_t>(to) - static_cast<std::int64_t>(from);
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        if (d8_steps[k].row * width + d8_steps[k].col == step) {
            return static_cast<std::int8_t>(k);
        }
    }
    return -1;
}

/// What a lake with a level makes of a river cell.
enum class Hold : std::uint8_t {
    none,
    below, ///< the lake's water passes it
    lake,  ///< part of the lake
    outlet ///< of the lake, at its level
};

/// Channel cells in the frame of a level, downstream first. The vectors are parallel.
struct RiverCells {
    std::vector<std::uint32_t> cell;    ///< index in the level
    std::vector<std::int32_t> receiver; ///< position in these vectors; -1: none
    std::vector<std::int8_t> direction; ///< towards the receiver, as in d8_steps
    std::vector<std::uint8_t> level;    ///< 1: as high as its receiver
    std::vector<float> asked;           ///< prescribed height; NaN: free; empty: all free
    std::vector<std::int64_t> number;   ///< in the caller's Channels; -1: beyond its grid
    std::vector<Hold> hold = {};        ///< empty: no lake has a level
    std::vector<float> grade = {};      ///< [0, 1] of the graded tangent; empty: 1 everywhere

    Hold hold_of(std::size_t n) const { return hold.empty() ? Hold::none : hold[n]; }
    /// Whether a lake's level decides on its height.
    float grade_of(std::size_t n) const { return grade.empty() ? 1.0F : grade[n]; }
    bool is_held(std::size_t n) const { return hold_of(n) == Hold::below || hold_of(n) == Hold::outlet; }
};

/// Marks the cells in and below lakes with levels, of which the outlets are marked.
void mark_held(RiverCells& rivers);

/// Coarsens rivers to half as many cells a side: a coarse cell takes its river cell with the fewest steps to the
/// river's end (ties: the first), so that rivers stay trees. Widths include the frames.
RiverCells coarsened(RiverCells const& fine, std::int64_t fine_width, std::int64_t coarse_width,
                     std::int64_t coarse_height);

template <class T> using Cells = std::vector<T, LargePages<T>>;

/// Frees a vector's memory, which it keeps if {} is assigned.
template <class Values> void release(Values& values) {
    Values().swap(values);
}

/// Cell types of the solver.
enum class CellType : std::uint8_t {
    land,
    rim,      ///< land beside outside: creep has fewer neighbours
    bank,     ///< land beside a river; finest level only
    rim_bank, ///< both rim and bank
    river,
    boundary, ///< boundary cell: water leaves at a prescribed height
    sea,      ///< water leaves at height 0
    outside   ///< not part of the terrain: infinitely high
};

inline bool is_land(CellType c) {
    return c <= CellType::rim_bank;
}
inline bool is_bank(CellType c) {
    return c == CellType::bank || c == CellType::rim_bank;
}

inline constexpr std::int8_t no_direction = -1;

/// Lengths of the D8 steps [cells].
inline constexpr std::array<float, 8> step_lengths = {1.0F, 1.41421356F, 1.0F, 1.41421356F,
                                                      1.0F, 1.41421356F, 1.0F, 1.41421356F};

/// The least tangent from a cell to its receiver: far above float precision, far below what is visible.
inline constexpr float least_tangent = 0.002F;

/// Water that enters a level.
struct Inflow {
    std::uint32_t cell;
    std::uint32_t area; ///< [cells of the level] contributing area
};

/// One level of the grid, in a frame one cell wide, so that every inner cell has eight neighbours. Lengths and heights
/// are in cells of the finest level.
struct TerrainLevel {
    std::int64_t width = 0;      ///< with the frame
    std::int64_t height = 0;     ///< with the frame
    float side = 1.0F;           ///< size of a cell
    float least = least_tangent; ///< tangent from a land cell to its receiver
    Cell corner;                 ///< [finest cells] offset of the first inner cell from the caller's grid
    RiverCells rivers;
    Cells<CellType> type;
    Cells<float> z;
    Rock rock;
    LevelLayers strata;
    bool has_falls = false;              ///< rivers fall steeply over firm layers, and are not perched for that
    Cells<float> uplift;                 ///< empty: 1 everywhere
    Cells<std::int8_t> direction;        ///< towards the receiver, as in d8_steps, or no_direction
    std::optional<std::uint64_t> jitter; ///< seed of jitter_codes(); none: nodes lie at the centres of cells
    Cells<std::uint32_t> area;           ///< [cells of this level]; after relax_terrain() of river cells alone
    std::vector<Inflow> inflow;          ///< water from beyond the frame
    std::vector<std::uint32_t> crests;   ///< land cells that no water crosses where it finds another way, ascending
    std::vector<std::uint32_t> order; ///< of a small level, from accumulate_areas() to relax_terrain(): the cells that
                                      ///< drain to a neighbour, each after those that drain to it; empty: not kept
    Cells<std::uint8_t> is_crest;     ///< by cell; empty: there are none
    SomeCells firmness;               ///< [log] decrease of erodibility below the fields' values
    /// most by which a bank stands above the river to which it drains
    float bank_rise = std::numeric_limits<float>::infinity();

    std::int64_t cells() const { return width * height; }
    Cell at(std::size_t i) const {
        return {static_cast<std::int64_t>(i) % width, static_cast<std::int64_t>(i) / width};
    }
    std::array<std::int64_t, 8> offsets() const {
        std::array<std::int64_t, 8> out{};
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k] = d8_steps[k].row * width + d8_steps[k].col;
        }
        return out;
    }
};

/// Position of a level's cell in a coarser level, in cells from the centres.
struct LevelPlace {
    double col;
    double row;
};
inline LevelPlace place_in(TerrainLevel const& coarse, TerrainLevel const& level, std::int64_t col, std::int64_t row) {
    double const side = static_cast<double>(level.side);
    double const east =
        static_cast<double>(level.corner.col - coarse.corner.col) + (static_cast<double>(col) - 0.5) * side;
    double const south =
        static_cast<double>(level.corner.row - coarse.corner.row) + (static_cast<double>(row) - 0.5) * side;
    return {east / static_cast<double>(coarse.side) + 0.5, south / static_cast<double>(coarse.side) + 0.5};
}

/// Interpolates between cells inside a level's frame.
/// \param of the value of a cell
template <class Of> float value_between(TerrainLevel const& level, Of of, LevelPlace p) {
    double const left = std::floor(p.col);
    double const top = std::floor(p.row);
    auto const value = [&](double col, double row) {
        auto const c = std::clamp<std::int64_t>(static_cast<std::int64_t>(col), 1, level.width - 2);
        auto const r = std::clamp<std::int64_t>(static_cast<std::int64_t>(row), 1, level.height - 2);
        return of(r * level.width + c);
    };
    auto const u = static_cast<float>(p.col - left);
    auto const v = static_cast<float>(p.row - top);
    float const upper = value(left, top) + (value(left + 1.0, top) - value(left, top)) * u;
    float const lower = value(left, top + 1.0) + (value(left + 1.0, top + 1.0) - value(left, top + 1.0)) * u;
    return upper + (lower - upper) * v;
}
inline float value_at(TerrainLevel const& level, Cells<float> const& field, LevelPlace p) {
    return value_between(
        level, [&](std::int64_t cell) { return field[cell]; }, p);
}

/// Rows for one worker at least: fewer cells take less time than handing them over.
inline std::int64_t least_rows(std::int64_t width) {
    return std::max<std::int64_t>(1, (1 << 14) / width);
}

/// Calls visit(cell) for the cells inside the frame, row by row.
template <class Visit> void each_inner(TerrainLevel const& level, Visit visit) {
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        for (std::int64_t i = row * level.width + 1; i + 1 < (row + 1) * level.width; ++i) {
            visit(static_cast<std::size_t>(i));
        }
    }
}

inline std::size_t moved(std::size_t cell, std::int64_t offset) {
    return static_cast<std::size_t>(static_cast<std::int64_t>(cell) + offset);
}

/// Calls visit(cell) for the sixteen cells two columns or rows away, unless the cell is too close to the frame.
template <class Visit> void each_of_second_ring(TerrainLevel const& level, std::uint32_t cell, Visit visit) {
    std::int64_t const col = cell % level.width;
    std::int64_t const row = cell / level.width;
    if (col < 2 || row < 2 || col + 2 >= level.width || row + 2 >= level.height) {
        return;
    }
    for (std::int64_t d = -2; d <= 2; ++d) {
        visit(moved(cell, -2 * level.width + d));
        visit(moved(cell, 2 * level.width + d));
        if (d != -2 && d != 2) {
            visit(moved(cell, d * level.width - 2));
            visit(moved(cell, d * level.width + 2));
        }
    }
}

/// Height of the highest river cell beside an inner cell; minus infinity: none.
inline float highest_river(TerrainLevel const& level, std::size_t i, std::array<std::int64_t, 8> const& offsets) {
    float highest = -std::numeric_limits<float>::infinity();
    for (std::int64_t const offset : offsets) {
        if (std::size_t const n = moved(i, offset); level.type[n] == CellType::river) {
            highest = std::max(highest, level.z[n]);
        }
    }
    return highest;
}

/// By cell: which of its eight neighbours drain to it, as bits of d8_steps, of cells whose type is at most that.
Cells<std::uint8_t> donors_of(TerrainLevel const& level, CellType most, Run const& run);

/// Follows land upstream. Paths from different starts never meet, so that they may be followed on different workers.
template <class Visit> class Climb {
public:
    /// \param donors donors_of() that type
    Climb(TerrainLevel const& level, CellType most, Cells<std::uint8_t> const& donors, Visit const& visit)
        : level_(level), most_(most), donors_(donors.data()), visit_(visit) {
        auto const offsets = level.offsets();
        for (std::size_t bits = 0; bits < ways_.size(); ++bits) {
            for (std::size_t k = 0; k < offsets.size(); ++k) {
                if ((bits >> k & 1U) != 0) {
                    std::size_t const n = ways_[bits].count++;
                    ways_[bits].offset[n / 4][n % 4] = static_cast<std::int32_t>(offsets[k]);
                }
            }
        }
    }

    /// Visits what drains through cells of a tile that are not visited.
    void from_tile(std::int64_t top, std::int64_t bottom, std::int64_t left, std::int64_t right) {
        CellType const* const type = level_.type.data();
        std::vector<std::uint32_t> starts(static_cast<std::size_t>((bottom - top) * (right - left)));
        std::size_t count = 0;
        for (std::int64_t row = top; row < bottom; ++row) {
            std::int64_t const end = row * level_.width + right;
            for (std::int64_t i = row * level_.width + left; i < end;) {
                std::int64_t const next = std::min(i + 8, end);
                if (next - i == 8 && none_above(type + i)) {
                    i = next;
                }
                for (; i < next; ++i) {
                    starts[count] = static_cast<std::uint32_t>(i);
                    count += type[i] > most_ && donors_[i] != 0 ? 1U : 0U;
                }
            }
        }
        first_ = 0;
        last_ = 0;
        reserve(count);
        for (std::size_t n = 0; n < count; ++n) {
            list_donors(starts[n]);
        }
        while (first_ != last_) {
            follow(std::min<std::size_t>(last_ - first_, 512));
        }
    }

private:
    using Four [[gnu::vector_size(16)]] = std::int32_t;
    struct Ways {
        std::array<Four, 2> offset{};
        std::size_t count = 0;
    };

    /// Whether no type of eight cells is above the highest to visit: as mostly, where there are few rivers.
    bool none_above(CellType const* type) const {
        constexpr std::uint64_t each = 0x0101010101010101;
        std::uint64_t eight = 0;
        std::memcpy(&eight, type, sizeof eight);
        return ((eight + (0x7FU - static_cast<std::uint64_t>(most_)) * each) & 0x80U * each) == 0;
    }

    void follow(std::size_t count) {
        reserve(count);
        for (; count > 0; --count) {
            if constexpr (requires { visit_.fetch(std::uint32_t{}); }) {
                constexpr std::size_t ahead = 12; // beyond the last: any cells
                visit_.fetch(open_[first_ + ahead]);
            }
            std::uint32_t const cell = open_[first_++];
            visit_(cell);
            list_donors(cell);
        }
    }

    void list_donors(std::uint32_t cell) {
        Ways const& ways = ways_[donors_[cell]];
        auto const put = [&](std::size_t half) { // no branch for each, which a processor could not foresee
            Four const cells = ways.offset[half] + static_cast<std::int32_t>(cell);
            std::memcpy(&open_[last_ + 4 * half], &cells, sizeof cells);
        };
        put(0);
        if (ways.count > 4) {
            put(1);
        }
        last_ += ways.count;
    }

    /// Makes room for the donors of some cells, and for cells beyond the last.
    void reserve(std::size_t cells) {
        std::size_t const count = last_ - first_;
        std::size_t const more = 8 * cells + 16;
        if (last_ + more <= open_.size()) {
            return;
        }
        if (2 * (count + more) > open_.size()) {
            open_.resize(4 * (count + more));
        }
        std::copy(&open_[first_], &open_[last_], open_.data());
        first_ = 0;
        last_ = count;
    }

    TerrainLevel const& level_;
    CellType most_;
    std::uint8_t const* donors_;
    Visit const& visit_;
    std::array<Ways, 256> ways_;                                            ///< to donors, by their bits
    std::vector<std::uint32_t> open_ = std::vector<std::uint32_t>(1 << 14); ///< cells to visit, from first_ to last_
    std::size_t first_ = 0;
    std::size_t last_ = 0;
};

/// Calls visit(cell) for land cells, each after its receiver, on all workers. Where visit has a fetch(cell), calls it
/// some visits before, and for other cells.
/// \param most of the types of land to visit; what drains to others is where to begin
/// \param tile [cells] sides of the squares with which to begin: small, so that what drains to each mostly stays in the
/// processor's cache
template <class Visit>
void each_upstream(TerrainLevel const& level, CellType most, Run const& run, Visit visit, std::int64_t tile = 64) {
    Cells<std::uint8_t> const donors = donors_of(level, most, run);
    parallel_ranges(run, (level.height + tile - 1) / tile, 1, [&](std::int64_t begin, std::int64_t end) {
        Climb climb(level, most, donors, visit);
        for (std::int64_t row = begin * tile; row < std::min(level.height, end * tile); row += tile) {
            for (std::int64_t col = 0; col < level.width; col += tile) {
                climb.from_tile(row, std::min(level.height, row + tile), col, std::min(level.width, col + tile));
            }
        }
    });
}

/// Steps to the neighbours already visited by a pass in row order.
inline constexpr std::array<std::size_t, 4> steps_before = {4, 5, 6, 7};

/// Calls take(cell, neighbour, distance between them [cells]) in two passes over rows, of which the first and the last
/// take nothing.
template <class Take> void spread_out(TerrainLevel const& level, std::size_t height, Take take) {
    auto const offsets = level.offsets();
    auto const width = static_cast<std::size_t>(level.width);
    for (std::size_t row = 1; row + 1 < height; ++row) {
        for (std::size_t i = row * width + 1; i + 1 < (row + 1) * width; ++i) {
            for (std::size_t const k : steps_before) {
                take(i, moved(i, offsets[k]), step_lengths[k]);
            }
        }
    }
    for (std::size_t row = height - 2; row > 0; --row) {
        for (std::size_t i = (row + 1) * width - 2; i > row * width; --i) {
            for (std::size_t const k : steps_before) {
                take(i, moved(i, -offsets[k]), step_lengths[k]);
            }
        }
    }
}

struct NearestRiver {
    static constexpr std::uint32_t none = 0xffffffff;
    Cells<float> distance;       ///< [cells of the level] minus the head start of the river cell
    Cells<std::uint32_t> number; ///< number of the river cell in the level's rivers
};

/// Finds the river cell nearest to each inner cell, by steps of 1 and sqrt(2) in two passes, where each river cell has
/// a head start (by number; empty: none). The frame has none.
NearestRiver nearest_river(TerrainLevel const& level, std::vector<float> const& head_start = {});
/// The same for other cells of the level than its rivers.
NearestRiver nearest_of(TerrainLevel const& level, std::vector<std::uint32_t> const& cells,
                        std::vector<float> const& head_start = {});

/// A river cell's head start.
struct HeadStart {
    std::uint32_t cell = 0;
    std::uint32_t number = 0; ///< in the level's rivers
    float distance = 0.0F;    ///< [cells of the level]
};
/// nearest_river() of a row and those that follow it, from the row above them to the one below: right where distances
/// are below 0.
/// \param starts by cell
NearestRiver nearest_in_rows(TerrainLevel const& level, std::vector<HeadStart> const& starts, std::int64_t first_row,
                             std::int64_t end_row);

} // namespace thalweg::surface
