// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <numeric>
#include <utility>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/equilibrium/internal/region.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

// Described in docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {
namespace {

std::vector<std::int32_t> steps_to_end(RiverCells const& rivers) {
    std::vector<std::int32_t> steps(rivers.cell.size());
    for (std::size_t n = 0; n < steps.size(); ++n) {
        std::int32_t const r = rivers.receiver[n];
        steps[n] = r < 0 ? 0 : steps[r] + 1;
    }
    return steps;
}

/// Gives the outlets of lakes with levels, and their heights, to the coarse cells that hold them.
/// \param coarse_of by river cell: number of its coarse cell
template <class CoarseOf> void keep_outlets(RiverCells const& fine, RiverCells& coarse, CoarseOf coarse_of) {
    coarse.hold.assign(coarse.cell.size(), Hold::none);
    for (std::size_t n = 0; n < fine.hold.size(); ++n) {
        auto const c = static_cast<std::size_t>(coarse_of(n));
        bool const ends_lower = coarse.receiver[c] < 0 && fine.receiver[n] >= 0;
        if (fine.hold[n] == Hold::outlet && coarse.level[c] == 0 && !ends_lower) {
            coarse.hold[c] = Hold::outlet;
            coarse.asked[c] = fine.asked[n];
        }
    }
    mark_held(coarse);
}

// Extent of the influence of a straight boundary of open terrain; a whole number of cells on every level that has it.
constexpr std::int64_t open_margin = 32;

Grid grown(Grid grid, std::int64_t margin) {
    grid.width += 2 * margin;
    grid.height += 2 * margin;
    grid.west -= static_cast<double>(margin) * grid.cell_m;
    grid.north += static_cast<double>(margin) * grid.cell_m;
    return grid;
}

/// Extends a raster beyond its border with its border values.
template <class T> Raster<T> grown(Raster<T> const& inner, std::int64_t margin) {
    if (inner.cells() == 0) {
        return {};
    }
    Raster<T> outer(grown(inner.grid(), margin));
    for (std::int64_t row = 0; row < outer.height(); ++row) {
        for (std::int64_t col = 0; col < outer.width(); ++col) {
            outer[Cell{col, row}] = inner[Cell{std::clamp<std::int64_t>(col - margin, 0, inner.width() - 1),
                                               std::clamp<std::int64_t>(row - margin, 0, inner.height() - 1)}];
        }
    }
    return outer;
}

/// Divides a field by its mean on land, within the solver's limits; NaN at sea.
Raster<float> relative(Raster<float> field, Mask const& land) {
    constexpr double most = 1e3;
    double sum = 0.0;
    double count = 0.0;
    auto const dry = [&](std::int64_t i) { return land.cells() == 0 || land[i] != 0; };
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        if (dry(i)) {
            sum += static_cast<double>(field[i]);
            count += 1.0;
        }
    }
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        field[i] = dry(i)
                       ? static_cast<float>(std::clamp(static_cast<double>(field[i]) / (sum / count), 1.0 / most, most))
                       : std::nanf("");
    }
    return field;
}

/// The step by which a border cell leaves the grid, preferably to the north or south.
Cell exit_step(Grid const& grid, Cell c) {
    if (c.row == 0) {
        return {0, -1};
    }
    if (c.row == grid.height - 1) {
        return {0, 1};
    }
    return {c.col == 0 ? -1 : 1, 0};
}

class CarriedChannels {
public:
    CarriedChannels(Channels const& given, std::int64_t margin)
        : given_(given), margin_(margin), width_(given.grid.width + 2 * margin + 2) {}

    RiverCells all() {
        std::vector<std::int32_t> outside(given_.cell.size(), -1);
        for (std::size_t n = 0; n < given_.cell.size(); ++n) {
            Cell const c = given_.grid.at(given_.cell[n]);
            if (margin_ > 0 && given_.receiver[n] < 0 && given_.grid.on_border(c)) {
                outside[n] = extend_outside(c);
            }
        }
        auto const first = static_cast<std::int64_t>(out_.cell.size());
        for (std::size_t n = 0; n < given_.cell.size(); ++n) {
            std::int64_t const r = given_.receiver[n];
            put(given_.grid.at(given_.cell[n]), r < 0 ? outside[n] : static_cast<std::int32_t>(r + first));
            out_.number.back() = static_cast<std::int64_t>(n);
            if (!given_.level.empty() && r >= 0) {
                out_.level.back() = given_.level[n];
            }
            if (!given_.z.empty()) {
                out_.asked.resize(out_.cell.size(), std::nanf(""));
                out_.asked.back() = given_.z[n];
            }
        }
        if (!given_.lake_z.empty()) {
            hold_lakes(first);
        }
        return std::move(out_);
    }

private:
    /// \param first number of the first cell on the caller's grid
    void hold_lakes(std::int64_t first) {
        out_.hold.assign(out_.cell.size(), Hold::none);
        for (std::size_t n = 0; n < given_.lake_z.size(); ++n) {
            if (!std::isnan(given_.lake_z[n])) {
                out_.hold[first + static_cast<std::int64_t>(n)] = Hold::outlet;
            }
        }
        mark_held(out_);
    }

    void put(Cell c, std::int32_t receiver) {
        auto const i = static_cast<std::size_t>((c.row + margin_ + 1) * width_ + c.col + margin_ + 1);
        out_.cell.push_back(static_cast<std::uint32_t>(i));
        out_.receiver.push_back(receiver);
        out_.direction.push_back(receiver < 0 ? std::int8_t{-1} : direction_between(i, out_.cell[receiver], width_));
        out_.level.push_back(0);
        out_.number.push_back(-1);
    }

    /// Adds the cells outside the border.
    /// \return number of the cell just outside
    std::int32_t extend_outside(Cell c) {
        Cell const step = exit_step(given_.grid, c);
        std::int32_t last = -1;
        for (std::int64_t far = margin_; far > 0; --far) {
            put({c.col + far * step.col, c.row + far * step.row}, last);
            last = static_cast<std::int32_t>(out_.cell.size()) - 1;
        }
        return last;
    }

    Channels const& given_;
    std::int64_t margin_;
    std::int64_t width_;
    RiverCells out_;
};

void take_nearer(NearestRiver& near, std::size_t i, std::size_t from, float length) {
    if (near.distance[from] + length < near.distance[i]) {
        near.distance[i] = near.distance[from] + length;
        near.number[i] = near.number[from];
    }
}

/// Gives each cell of some rows the nearest of those that have one; the first and last of them have none.
void spread_out(NearestRiver& near, TerrainLevel const& level) {
    spread_out(level, near.distance.size() / static_cast<std::size_t>(level.width),
               [&](std::size_t i, std::size_t from, float length) { take_nearer(near, i, from, length); });
}

/// Lowers distances to those by way of the row above or below.
void take_from_row(float* here, float const* other, std::int64_t width) {
    for (std::int64_t col = 1; col + 1 < width; ++col) {
        float const aslant = std::min(other[col - 1], other[col + 1]) + step_lengths[1];
        here[col] = std::min(here[col], std::min(other[col] + 1.0F, aslant));
    }
}

/// Distances of nearest_river(), in two passes over rows: what a row takes from the other does not wait for the cell
/// beside.
Cells<float> river_distances(TerrainLevel const& level, std::vector<float> const& head_start) {
    Cells<float> far(static_cast<std::size_t>(level.cells()), std::numeric_limits<float>::infinity());
    for (std::size_t n = 0; n < head_start.size(); ++n) {
        far[level.rivers.cell[n]] = -head_start[n];
    }
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        float* const here = &far[row * level.width];
        take_from_row(here, here - level.width, level.width);
        float beside = here[0];
        for (std::int64_t col = 1; col + 1 < level.width; ++col) {
            beside = std::min(here[col], beside + 1.0F);
            here[col] = beside;
        }
    }
    for (std::int64_t row = level.height - 2; row > 0; --row) {
        float* const here = &far[row * level.width];
        take_from_row(here, here + level.width, level.width);
        float beside = here[level.width - 1];
        for (std::int64_t col = level.width - 2; col > 0; --col) {
            beside = std::min(here[col], beside + 1.0F);
            here[col] = beside;
        }
    }
    return far;
}

LevelInput coarser(LevelInput const& fine) {
    LevelExtent const extent{(fine.extent.width + 1) / 2, (fine.extent.height + 1) / 2, fine.extent.corner};
    return {extent, coarsened(fine.rivers, fine.extent.width + 2, extent.width + 2, extent.height + 2),
            fine.land.cells() == 0 ? Mask{} : coarsened(fine.land)};
}

bool beside(TerrainLevel const& level, std::size_t i, CellType what) {
    auto const offsets = level.offsets();
    return std::any_of(offsets.begin(), offsets.end(),
                       [&](std::int64_t offset) { return level.type[moved(i, offset)] == what; });
}

void set_banks(TerrainLevel& level) {
    for (std::uint32_t const river : level.rivers.cell) {
        for (std::int64_t const offset : level.offsets()) {
            CellType& near = level.type[moved(river, offset)];
            near = near == CellType::land ? CellType::bank : near == CellType::rim ? CellType::rim_bank : near;
        }
    }
}

constexpr std::int64_t bytes_in_block = 32;

std::uint8_t random_byte(std::array<std::uint64_t, 4> const& words, std::int64_t k) {
    return static_cast<std::uint8_t>(words[static_cast<std::size_t>(k / 8)] >> (8 * (k % 8)));
}

// Calls visit(column, byte) with a random byte for each of `count` columns of a row of a level: thirty-two of them use
// one block of random words.
template <class Visit>
void random_bytes(std::uint64_t seed, std::uint64_t stage, std::int64_t row, float side, std::int64_t count,
                  Visit visit) {
    for (std::int64_t first = 0; first < count; first += bytes_in_block) {
        auto const words = random_block(seed, stage, static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(first),
                                        static_cast<std::uint64_t>(side));
        for (std::int64_t col = first; col < std::min(first + bytes_in_block, count); ++col) {
            visit(col, random_byte(words, col - first));
        }
    }
}

constexpr std::uint64_t jitter_stage = 0x6a6974746572; // "jitter"

constexpr std::uint64_t start_stage = 0x7374617274; // "start"
constexpr float first_tangent = 0.05F;

/// Sets a level's heights: those that by_row(row, heights) gives for the cells of a row, and a random part.
template <class ByRow>
void set_heights(TerrainLevel& level, std::uint64_t seed, float rough, Run const& run, ByRow by_row) {
    level.z.resize(static_cast<std::size_t>(level.cells()));
    float const each = rough * level.side * 0x1p-8F;
    parallel_ranges(run, level.height, least_rows(level.width), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            float* const z = &level.z[row * level.width];
            by_row(row, z);
            random_bytes(seed, start_stage, row, level.side, level.width,
                         [&](std::int64_t col, std::uint8_t byte) { z[col] += each * static_cast<float>(byte); });
        }
    });
}

/// Displacement of coarse terrain when a finer level is initialised: bends valleys of coarse cells, which follow the
/// grid, before water settles in them.
class Bends {
public:
    Bends(TerrainLevel const& level, std::uint64_t seed, float reach)
        : across_(level.width / spacing + 2), reach_(reach) {
        std::int64_t const down = level.height / spacing + 2;
        east_.resize(static_cast<std::size_t>(across_ * down));
        south_.resize(east_.size());
        for (std::int64_t row = 0; row < down; ++row) {
            draw(seed, 2 * row, level.side, &east_[row * across_]);
            draw(seed, 2 * row + 1, level.side, &south_[row * across_]);
        }
    }

    /// Computes the displacement [coarse cells] of the cells of a row.
    void displace(std::int64_t row, std::vector<float>& east, std::vector<float>& south) const {
        float const v = static_cast<float>(row % spacing) * (1.0F / spacing);
        along(&east_[row / spacing * across_], v, east);
        along(&south_[row / spacing * across_], v, south);
    }

private:
    static constexpr std::int64_t spacing = 6; // [cells of the level]

    void draw(std::uint64_t seed, std::int64_t row, float side, float* out) const {
        constexpr std::uint64_t bends = 0x62656e64; // "bend"
        random_bytes(seed, bends, row, side, across_, [&](std::int64_t col, std::uint8_t byte) {
            out[col] = reach_ * (static_cast<float>(byte) * 0x1p-7F - 1.0F);
        });
    }

    void along(float const* n, float v, std::vector<float>& out) const {
        auto const count = static_cast<std::int64_t>(out.size());
        for (std::int64_t first = 0; first < count; first += spacing, ++n) {
            float const left = n[0] + (n[across_] - n[0]) * v;
            float const step = (n[1] + (n[across_ + 1] - n[1]) * v - left) * (1.0F / spacing);
            for (std::int64_t k = 0; k < std::min(spacing, count - first); ++k) {
                out[first + k] = left + step * static_cast<float>(k);
            }
        }
    }

    std::int64_t across_; ///< nodes in a row
    float reach_;         ///< [coarse cells]
    std::vector<float> east_;
    std::vector<float> south_;
};

constexpr double half_stretch = 24.0;   // [finest cells]
constexpr float fall_of_large = 0.005F; // the fall of rivers that drain the whole grid

/// Means over 2 reach + 1 neighbours on a ring.
std::vector<double> ring_means(std::vector<double> const& values, std::int64_t reach) {
    auto const n = static_cast<std::int64_t>(values.size());
    auto const at = [&](std::int64_t k) { return values[((k % n) + n) % n]; };
    double sum = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        sum += at(k);
    }
    std::vector<double> means(values.size());
    for (std::int64_t k = 0; k < n; ++k) {
        means[k] = sum / static_cast<double>(2 * reach + 1);
        sum += at(k + reach + 1) - at(k - reach);
    }
    return means;
}

float above_rivers(TerrainLevel const& level, std::size_t i, float z) {
    for (std::int64_t const offset : level.offsets()) {
        std::int64_t const n = static_cast<std::int64_t>(i) + offset;
        if (n >= 0 && n < level.cells() && level.type[n] == CellType::river) {
            z = std::max(z, level.z[n] + level.least * level.side);
        }
    }
    return z;
}

std::vector<double> heights_of(TerrainLevel const& level, BoundaryCells::Part const& part, Cells<float> const& lowest) {
    std::vector<double> heights(part.cell.size());
    for (std::size_t k = 0; k < heights.size(); ++k) {
        float z = level.z[part.river[k]];
        if (!lowest.empty() && level.type[part.cell[k]] != CellType::sea) {
            z = valley_beyond(z, part.far[k], lowest[part.inner[k]]);
        }
        heights[k] = static_cast<double>(z);
    }
    return heights;
}

} // namespace

Cells<float> lowest_valleys(TerrainLevel const& level) {
    float const each = fall_of_large * level.side;
    std::vector<float> head_start(level.rivers.cell.size());
    std::transform(level.rivers.cell.begin(), level.rivers.cell.end(), head_start.begin(),
                   [&](std::uint32_t cell) { return -level.z[cell] / each; });
    Cells<float> lowest = river_distances(level, head_start);
    std::transform(lowest.begin(), lowest.end(), lowest.begin(), [&](float far) { return far * each; });
    return lowest;
}

float valley_beyond(float river, float far, float lowest) {
    constexpr float fall_of_heads = 0.05F; // a sixth of the steepest tangent
    return std::min(river, std::max(river - fall_of_heads * far, lowest));
}

void mark_held(RiverCells& rivers) {
    std::vector<Hold>& hold = rivers.hold;
    for (std::size_t n = hold.size(); n-- > 0;) {
        std::int32_t const r = rivers.receiver[n];
        if (r >= 0 && hold[n] != Hold::none && hold[r] == Hold::none) {
            hold[r] = Hold::below;
        }
    }
    for (std::size_t n = 0; n < hold.size(); ++n) {
        std::int32_t const r = rivers.receiver[n];
        if (rivers.level[n] != 0 && (hold[r] == Hold::lake || hold[r] == Hold::outlet)) {
            hold[n] = Hold::lake;
        }
    }
}

RiverCells coarsened(RiverCells const& fine, std::int64_t fine_width, std::int64_t coarse_width,
                     std::int64_t coarse_height) {
    auto const above = [&](std::uint32_t cell) {
        std::int64_t const row = (cell / fine_width - 1) / 2 + 1;
        std::int64_t const col = (cell % fine_width - 1) / 2 + 1;
        return static_cast<std::size_t>(row * coarse_width + col);
    };
    std::vector<std::int32_t> const steps = steps_to_end(fine);
    std::vector<std::int32_t> chosen(static_cast<std::size_t>(coarse_width * coarse_height), -1);
    for (std::size_t n = 0; n < steps.size(); ++n) {
        std::int32_t& best = chosen[above(fine.cell[n])];
        if (best < 0 || steps[n] < steps[best]) {
            best = static_cast<std::int32_t>(n);
        }
    }
    std::vector<std::int32_t> kept;
    std::copy_if(chosen.begin(), chosen.end(), std::back_inserter(kept), [](std::int32_t n) { return n >= 0; });
    std::sort(kept.begin(), kept.end(), [&](std::int32_t a, std::int32_t b) {
        auto const rank = [&](std::int32_t n) { return std::pair{steps[n], n}; };
        return rank(a) < rank(b);
    });
    for (std::size_t n = 0; n < kept.size(); ++n) {
        chosen[above(fine.cell[kept[n]])] = static_cast<std::int32_t>(n);
    }
    RiverCells coarse;
    for (std::int32_t const from : kept) {
        auto const n = static_cast<std::size_t>(from);
        std::size_t const here = above(fine.cell[n]);
        coarse.cell.push_back(static_cast<std::uint32_t>(here));
        coarse.level.push_back(fine.level[n]);
        coarse.number.push_back(fine.number[n]);
        if (!fine.asked.empty()) {
            coarse.asked.push_back(fine.asked[n]);
        }
        if (fine.receiver[n] < 0) {
            coarse.receiver.push_back(-1);
            coarse.direction.push_back(-1);
            continue;
        }
        std::size_t const there = above(fine.cell[fine.receiver[n]]);
        coarse.receiver.push_back(chosen[there]);
        coarse.direction.push_back(direction_between(here, there, coarse_width));
    }
    if (!fine.hold.empty()) {
        keep_outlets(fine, coarse, [&](std::size_t n) { return chosen[above(fine.cell[n])]; });
    }
    return coarse;
}

PaddedTerrain padded(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params) {
    std::int64_t const margin = goes_on(params.edge) ? open_margin : 0;
    return {grown(rivers.grid, margin),
            margin,
            CarriedChannels(rivers, margin).all(),
            grown(fields.land, margin),
            {relative(fields.uplift, fields.land), relative(fields.erodibility, fields.land)}};
}

std::vector<LevelInput> level_inputs(PaddedTerrain& land, Region const& region, Grid const& grid, std::uint64_t seed) {
    constexpr std::int64_t short_side = 8;
    constexpr std::int64_t long_side = 40;
    std::vector<LevelInput> levels;
    levels.push_back({{land.grid.width, land.grid.height, {-land.margin, -land.margin}},
                      std::move(land.rivers),
                      std::move(land.land)});
    for (;;) {
        LevelInput coarse = coarser(levels.back());
        if (region.level > 0 && levels.size() == region.level) {
            LevelExtent const wide = extent_of(region, grid);
            coarse.rivers = rivers_of_region(coarse.rivers, coarse.extent, wide, std::int64_t{1} << region.level, seed);
            coarse.extent = wide;
        }
        LevelExtent const& extent = coarse.extent;
        if (std::min(extent.width, extent.height) < short_side || std::max(extent.width, extent.height) < long_side) {
            return levels;
        }
        levels.push_back(std::move(coarse));
    }
}

NearestRiver nearest_river(TerrainLevel const& level, std::vector<float> const& head_start) {
    return nearest_of(level, level.rivers.cell, head_start);
}

NearestRiver nearest_of(TerrainLevel const& level, std::vector<std::uint32_t> const& from,
                        std::vector<float> const& head_start) {
    auto const cells = static_cast<std::size_t>(level.cells());
    NearestRiver near{Cells<float>(cells, std::numeric_limits<float>::infinity()),
                      Cells<std::uint32_t>(cells, NearestRiver::none)};
    for (std::size_t n = 0; n < from.size(); ++n) {
        near.distance[from[n]] = head_start.empty() ? 0.0F : -head_start[n];
        near.number[from[n]] = static_cast<std::uint32_t>(n);
    }
    spread_out(near, level);
    return near;
}

NearestRiver nearest_in_rows(TerrainLevel const& level, std::vector<HeadStart> const& starts, std::int64_t first_row,
                             std::int64_t end_row) {
    auto const corner = static_cast<std::uint32_t>((first_row - 1) * level.width);
    auto const cells = static_cast<std::size_t>((end_row - first_row + 2) * level.width);
    NearestRiver near{Cells<float>(cells, std::numeric_limits<float>::infinity()),
                      Cells<std::uint32_t>(cells, NearestRiver::none)};
    auto const before = [](HeadStart const& start, std::int64_t cell) { return start.cell < cell; };
    auto const first = std::lower_bound(starts.begin(), starts.end(), first_row * level.width, before);
    auto const end = std::lower_bound(first, starts.end(), end_row * level.width, before);
    std::for_each(first, end, [&](HeadStart const& start) {
        near.distance[start.cell - corner] = -start.distance;
        near.number[start.cell - corner] = start.number;
    });
    spread_out(near, level);
    return near;
}

Mask coarsened(Mask const& land) {
    Grid grid = land.grid();
    grid.width = (land.width() + 1) / 2;
    grid.height = (land.height() + 1) / 2;
    Mask coarse(grid);
    for (std::int64_t row = 0; row < grid.height; ++row) {
        for (std::int64_t col = 0; col < grid.width; ++col) {
            int all = 0;
            int dry = 0;
            for (std::int64_t r = 2 * row; r < std::min(2 * row + 2, land.height()); ++r) {
                for (std::int64_t c = 2 * col; c < std::min(2 * col + 2, land.width()); ++c) {
                    ++all;
                    dry += land[Cell{c, r}] != 0 ? 1 : 0;
                }
            }
            coarse[Cell{col, row}] = 2 * dry >= all ? 1 : 0;
        }
    }
    return coarse;
}

void set_cell_types(TerrainLevel& level, Mask const& land, Edge edge, RiverBanks banks) {
    bool const by_sea = has_sea(edge);
    CellType const rest = by_sea ? CellType::sea : CellType::outside;
    CellType const frame = edge == Edge::open || edge == Edge::mainland ? CellType::boundary : rest;
    CellType const frame_at_rest = edge == Edge::mainland ? CellType::sea : frame;
    level.type.resize(static_cast<std::size_t>(level.cells()));
    for (std::int64_t row = 0; row < level.height; ++row) {
        for (std::int64_t col = 0; col < level.width; ++col) {
            Cell const inner{std::clamp<std::int64_t>(col, 1, level.width - 2) - 1,
                             std::clamp<std::int64_t>(row, 1, level.height - 2) - 1};
            bool const on_frame = inner.col + 1 != col || inner.row + 1 != row;
            bool const dry = land.cells() == 0 || land[inner] != 0;
            level.type[row * level.width + col] =
                on_frame ? (dry ? frame : frame_at_rest) : (dry ? CellType::land : rest);
        }
    }
    for (std::uint32_t const river : level.rivers.cell) {
        level.type[river] = CellType::river;
    }
    if (!by_sea) {
        each_inner(level, [&](std::size_t i) {
            if (level.type[i] == CellType::land && beside(level, i, CellType::outside)) {
                level.type[i] = edge == Edge::open ? CellType::boundary : CellType::rim;
            }
        });
    }
    if (banks == RiverBanks::kept) {
        set_banks(level);
    }
}

void jitter_codes(TerrainLevel const& level, std::int64_t row, std::uint8_t* codes) {
    random_bytes(level.jitter.value_or(0), jitter_stage, row, level.side, level.width,
                 [&](std::int64_t col, std::uint8_t byte) { codes[col] = byte % (jitter_places * jitter_places); });
}

std::uint8_t jitter_code(TerrainLevel const& level, std::size_t cell) {
    Cell const c = level.at(cell);
    auto const words = random_block(level.jitter.value_or(0), jitter_stage, static_cast<std::uint64_t>(c.row),
                                    static_cast<std::uint64_t>(c.col - c.col % bytes_in_block),
                                    static_cast<std::uint64_t>(level.side));
    return random_byte(words, c.col % bytes_in_block) % (jitter_places * jitter_places);
}

void start_from_nothing(TerrainLevel& level, NearestRiver const& near, std::uint64_t seed, Run const& run) {
    set_heights(level, seed, 0.3F, run, [&](std::int64_t row, float* z) {
        for (std::int64_t col = 0; col < level.width; ++col) {
            float const far = near.distance[row * level.width + col];
            auto const rim = static_cast<float>(std::min({col, row, level.width - 1 - col, level.height - 1 - row}));
            z[col] = first_tangent * level.side * std::min(far, rim);
        }
    });
}

void start_from(TerrainLevel& level, TerrainLevel const& coarse, std::uint64_t seed, Departure const& departure,
                Run const& run) {
    // The frame's infinite heights must not be interpolated: the outermost inner cells replace it.
    Cells<float> heights(coarse.z.size());
    for (std::int64_t row = 0; row < coarse.height; ++row) {
        auto const from = std::clamp<std::int64_t>(row, 1, coarse.height - 2) * coarse.width;
        for (std::int64_t col = 0; col < coarse.width; ++col) {
            float const z = coarse.z[from + std::clamp<std::int64_t>(col, 1, coarse.width - 2)];
            heights[row * coarse.width + col] = std::isinf(z) ? 0.0F : z;
        }
    }
    Bends const bends(level, seed, departure.bend);
    // Columns 1 and 2 (the frame is column 0) are the halves of coarse column 1 if both begin at the same place.
    float const first_x = 0.25F + static_cast<float>(level.corner.col - coarse.corner.col) / coarse.side;
    float const first_y = 0.25F + static_cast<float>(level.corner.row - coarse.corner.row) / coarse.side;
    auto const last_col = static_cast<float>(coarse.width - 1);
    auto const last_row = static_cast<float>(coarse.height - 1);
    set_heights(level, seed, departure.rough, run, [&](std::int64_t row, float* z) {
        auto const count = static_cast<std::size_t>(level.width);
        std::vector<float> x(count);
        std::vector<float> y(count);
        bends.displace(row, x, y);
        float const middle = 0.5F * static_cast<float>(row) + first_y;
        for (std::size_t col = 0; col < count; ++col) {
            x[col] = std::clamp(0.5F * static_cast<float>(col) + first_x + x[col], 0.0F, last_col);
            y[col] = std::clamp(middle + y[col], 0.0F, last_row);
        }
        for (std::size_t col = 0; col < count; ++col) {
            auto const c = std::min(static_cast<std::int64_t>(x[col]), coarse.width - 2);
            auto const r = std::min(static_cast<std::int64_t>(y[col]), coarse.height - 2);
            float const u = x[col] - static_cast<float>(c);
            float const v = y[col] - static_cast<float>(r);
            float const* const n = &heights[r * coarse.width + c];
            float const upper = n[0] + (n[1] - n[0]) * u;
            float const lower = n[coarse.width] + (n[coarse.width + 1] - n[coarse.width]) * u;
            z[col] = upper + (lower - upper) * v;
        }
    });
}

void roughen(TerrainLevel& level, std::uint64_t seed, float rough, Run const& run) {
    set_heights(level, seed, rough, run, [](std::int64_t, float*) {});
}

void start_rivers(TerrainLevel& level, std::vector<float> const& end_z) {
    for (std::size_t i = 0; i < level.type.size(); ++i) {
        if (level.type[i] == CellType::sea) {
            level.z[i] = 0.0F;
        } else if (level.type[i] == CellType::outside) {
            level.z[i] = std::numeric_limits<float>::infinity();
        }
    }
    RiverCells const& rivers = level.rivers;
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        float& z = level.z[rivers.cell[n]];
        float const asked = rivers.asked.empty() ? std::nanf("") : rivers.asked[n];
        if (rivers.receiver[n] < 0) {
            z = !std::isnan(asked) ? asked : end_z.empty() ? 0.0F : end_z[n];
            continue;
        }
        float const below = level.z[rivers.cell[rivers.receiver[n]]];
        z = std::isnan(asked) ? std::min(z, below + first_tangent * level.side) : asked;
        z = std::max(z, below + least_tangent * level.side);
    }
}

BoundaryCells boundary_cells(TerrainLevel const& level, NearestRiver const& near, Beyond beyond) {
    BoundaryCells edge;
    edge.beyond = beyond;
    std::int64_t const w = level.width;
    std::int64_t const h = level.height;
    auto const add = [&](BoundaryCells::Part& part, std::size_t i, std::size_t inner) {
        part.cell.push_back(static_cast<std::uint32_t>(i));
        part.inner.push_back(static_cast<std::uint32_t>(inner));
        bool const at_sea = level.type[i] == CellType::sea; // its height is 0
        part.river.push_back(at_sea ? static_cast<std::uint32_t>(i) : level.rivers.cell[near.number[inner]]);
        part.far.push_back(at_sea ? 0.0F : near.distance[inner] * level.side);
    };
    auto const put = [&](std::int64_t col, std::int64_t row) {
        auto const i = static_cast<std::size_t>(row * w + col);
        if (level.type[i] == CellType::sea || level.type[i] == CellType::boundary) {
            add(edge.ring, i,
                static_cast<std::size_t>(std::clamp<std::int64_t>(row, 1, h - 2) * w +
                                         std::clamp<std::int64_t>(col, 1, w - 2)));
        }
    };
    for (std::int64_t col = 0; col < w - 1; ++col) {
        put(col, 0);
    }
    for (std::int64_t row = 0; row < h - 1; ++row) {
        put(w - 1, row);
    }
    for (std::int64_t col = w - 1; col > 0; --col) {
        put(col, h - 1);
    }
    for (std::int64_t row = h - 1; row > 0; --row) {
        put(0, row);
    }
    each_inner(level, [&](std::size_t i) {
        if (level.type[i] == CellType::boundary) {
            add(edge.inside, i, i);
        }
    });
    return edge;
}

void set_boundary_heights(TerrainLevel& level, BoundaryCells const& edge) {
    bool const valleys = edge.beyond == Beyond::valleys && !(edge.ring.cell.empty() && edge.inside.cell.empty());
    Cells<float> const lowest = valleys ? lowest_valleys(level) : Cells<float>{};
    std::vector<double> heights = heights_of(level, edge.inside, lowest);
    for (std::size_t k = 0; k < heights.size(); ++k) {
        std::uint32_t const i = edge.inside.cell[k];
        level.z[i] = above_rivers(level, i, static_cast<float>(heights[k]));
    }
    if (edge.ring.cell.empty()) {
        return;
    }
    auto const reach = std::max<std::int64_t>(2, static_cast<std::int64_t>(half_stretch / level.side));
    heights = ring_means(ring_means(heights_of(level, edge.ring, lowest), reach), reach);
    for (std::size_t k = 0; k < heights.size(); ++k) {
        std::uint32_t const i = edge.ring.cell[k];
        if (level.type[i] != CellType::sea) {
            level.z[i] = above_rivers(level, i, static_cast<float>(heights[k]));
        }
    }
}

} // namespace thalweg::surface
