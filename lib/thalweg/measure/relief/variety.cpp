// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/variety.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/ranks.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/measure/relief/internal/main_stems.hpp>
#include <thalweg/measure/relief/internal/place_in_classes.hpp>
#include <thalweg/measure/relief/internal/some_slopes.hpp>

namespace thalweg::measure {
namespace {

constexpr char const* self = "measure.variety";
constexpr std::int64_t least_windows = 4;

/// What a cell is, as bits.
constexpr std::uint8_t river = 1;
constexpr std::uint8_t inside = 2;  ///< drains to a river cell, or is one
constexpr std::uint8_t outside = 4; ///< drains past all

void check(VarietyParams const& params, Raster<float> const& dem, flow::FlowField const& drainage,
           std::span<std::int64_t const> rivers) {
    require_in(self, "window_m", params.window_m, Range::above(0.0));
    require_in(self, "gentle_deg", params.gentle_deg, Range::inside(0.0, 90.0));
    require_in(self, "away_m", params.away_m, Range::at_least(0.0));
    require_in(self, "stream_m2", params.stream_m2, Range::above(0.0));
    require_in(self, "stem_cells", params.stem_cells, Range::at_least(3));
    require_in(self, "most_stems", params.most_stems, Range::at_least(1));
    require_in(self, "bank_tangent", params.bank_tangent, Range::above(0.0));
    require_in(self, "wall_m", params.wall_m, Range::above(0.0));
    require_in(self, "divide_m", params.divide_m, Range::at_least(0.0));
    require_in(self, "least_share", params.least_share, Range::between(0.0, 1.0));
    require_same_grid(dem.grid(), drainage.direction.grid(), self, "the DEM and its drainage", "drain this DEM");
    refuse_if<BadInput>(dem.cells() > 0 && !(dem.grid().cell_m > 0.0), self,
                        "the DEM's cells have a side of {} m; it must be greater than 0", dem.grid().cell_m);
    for (std::int64_t const cell : rivers) {
        refuse_if<BadInput>(cell < 0 || cell >= dem.cells(), self, "cell {} is not one of the DEM's {}", cell,
                            dem.cells());
    }
}

std::int64_t support_of(Grid const& grid, double stream_m2) {
    return std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(stream_m2 / (grid.cell_m * grid.cell_m))), 1);
}

/// Some cells of a grid, in ascending order.
using Cells = std::vector<std::int64_t>;

/// Marks the river cells.
Cells mark_rivers(Raster<float> const& dem, flow::FlowField const& drainage, std::span<std::int64_t const> rivers,
                  std::int64_t support_cells, Mask& is) {
    Cells found;
    for (std::int64_t const cell : rivers) {
        if (!std::isnan(dem[cell]) && is[cell] == 0) {
            is[cell] = river;
            found.push_back(cell);
        }
    }
    std::ranges::sort(found);
    for (std::int64_t i = 0; rivers.empty() && i < dem.cells(); ++i) {
        if (drainage.area_cells[i] >= support_cells) {
            is[i] = river;
            found.push_back(i);
        }
    }
    return found;
}

/// The mean slopes of the windows in some rows, and the gentle cells.
struct WindowRow {
    std::vector<CompensatedSum> degrees; ///< by window
    std::vector<std::int64_t> cells;
    std::int64_t gentle = 0;
    std::int64_t gentle_away = 0;
};

/// Which cells of a row lie within a distance of some: from spans that start and end, added up along the row.
class Near {
public:
    Near(Grid const& grid, Cells const& cells, double away_m)
        : grid_(grid), radius_(static_cast<std::int64_t>(std::floor(away_m / grid.cell_m))),
          squared_(away_m / grid.cell_m * (away_m / grid.cell_m)), by_row_(static_cast<std::size_t>(grid.height)) {
        for (std::int64_t const cell : cells) {
            Cell const at = grid.at(cell);
            by_row_[at.row].push_back(at.col);
        }
    }

    /// Columns of the cells in a row.
    std::vector<std::int64_t> const& in_row(std::int64_t row) const { return by_row_[row]; }

    /// \param near 1 for each cell of the row that is near; as many as the grid is wide
    void row(std::int64_t row, std::vector<std::int64_t>& change, std::vector<std::uint8_t>& near) const {
        std::int64_t const width = grid_.width;
        change.assign(static_cast<std::size_t>(width) + 1, 0);
        for (std::int64_t r = std::max<std::int64_t>(row - radius_, 0); r <= std::min(row + radius_, grid_.height - 1);
             ++r) {
            auto const apart = static_cast<double>(r - row);
            auto const half = static_cast<std::int64_t>(std::floor(std::sqrt(squared_ - apart * apart)));
            for (std::int64_t const col : by_row_[r]) {
                ++change[std::max<std::int64_t>(col - half, 0)];
                --change[std::min(col + half + 1, width)];
            }
        }
        std::int64_t open = 0;
        near.resize(static_cast<std::size_t>(width));
        for (std::int64_t c = 0; c < width; ++c) {
            open += change[c];
            near[c] = open > 0 ? 1 : 0;
        }
    }

private:
    Grid const& grid_;
    std::int64_t radius_;
    double squared_; ///< [cells2]
    std::vector<std::vector<std::int64_t>> by_row_;
};

/// Sums the slopes of a row of windows: rows [first, last) of the DEM.
WindowRow window_row(Raster<float> const& dem, Near const& rivers, std::int64_t first, std::int64_t last,
                     std::int64_t side, double gentle_deg) {
    WindowRow found;
    auto const windows = static_cast<std::size_t>((dem.width() + side - 1) / side);
    found.degrees.resize(windows);
    found.cells.resize(windows);
    std::vector<std::int64_t> change;
    std::vector<std::uint8_t> near;
    SomeSlopes some;
    auto const beyond = static_cast<std::size_t>(std::max<std::int64_t>(dem.width() - 1, 1));
    for (std::int64_t row = std::max<std::int64_t>(first, 1); row < std::min(last, dem.height() - 1); ++row) {
        rivers.row(row, change, near);
        for (std::size_t from = 1; from < beyond; from += SomeSlopes::at_once) {
            std::size_t const count = std::min(SomeSlopes::at_once, beyond - from);
            some.compute(dem, row, from, count);
            for (std::size_t i = 0; i < count;) {
                std::size_t const window = (from + i) / static_cast<std::size_t>(side);
                std::size_t const end = std::min(count, (window + 1) * static_cast<std::size_t>(side) - from);
                CompensatedSum sum = found.degrees[window];
                for (; i < end; ++i) {
                    if (std::isnan(some.tangent[i])) {
                        continue;
                    }
                    double const degrees = some.angle[i] * (180.0 / portable::pi);
                    sum.add(degrees);
                    ++found.cells[window];
                    if (degrees < gentle_deg) {
                        ++found.gentle;
                        found.gentle_away += near[from + i] == 0 ? 1 : 0;
                    }
                }
                found.degrees[window] = sum;
            }
        }
    }
    return found;
}

void measure_windows(Raster<float> const& dem, Cells const& river_cells, VarietyParams const& params, Run const& run,
                     Variety& found) {
    Grid const& grid = dem.grid();
    std::int64_t const side = std::max<std::int64_t>(std::llround(params.window_m / grid.cell_m), 1);
    Near const rivers(grid, river_cells, params.away_m);
    std::vector<WindowRow> rows(static_cast<std::size_t>((grid.height + side - 1) / side));
    parallel_ranges(run, std::ssize(rows), 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t w = begin; w < end; ++w) {
            run.check();
            rows[w] = window_row(dem, rivers, w * side, (w + 1) * side, side, params.gentle_deg);
        }
    });
    CompensatedSum sum;
    CompensatedSum squares;
    std::int64_t cells = 0;
    std::int64_t gentle = 0;
    std::int64_t gentle_away = 0;
    for (WindowRow const& row : rows) {
        gentle += row.gentle;
        gentle_away += row.gentle_away;
        for (std::size_t w = 0; w < row.cells.size(); ++w) {
            cells += row.cells[w];
            if (2 * row.cells[w] >= side * side) {
                double const mean = row.degrees[w].value() / static_cast<double>(row.cells[w]);
                sum.add(mean);
                squares.add(mean * mean);
                ++found.windows;
            }
        }
    }
    if (cells > 0) {
        found.gentle_share = static_cast<double>(gentle) / static_cast<double>(cells);
        found.gentle_away_share = static_cast<double>(gentle_away) / static_cast<double>(cells);
    }
    if (found.windows >= least_windows) {
        auto const n = static_cast<double>(found.windows);
        double const mean = sum.value() / n;
        found.slope_spread_deg = std::sqrt(std::max(0.0, squares.value() / n - mean * mean));
    }
}

/// Distance from the mouth and height along the main stem above it.
struct Profile {
    std::vector<double> way_m;
    std::vector<double> z;

    /// The height half-way between the mouth and the source.
    double half_way() const {
        double const half = 0.5 * way_m.back();
        auto const after = std::lower_bound(way_m.begin() + 1, way_m.end(), half);
        auto const i = static_cast<std::size_t>(after - way_m.begin());
        double const share = (half - way_m[i - 1]) / (way_m[i] - way_m[i - 1]);
        return z[i - 1] + share * (z[i] - z[i - 1]);
    }
};

Profile profile_above(Raster<float> const& dem, flow::FlowField const& drainage, std::int64_t mouth,
                      std::int64_t support_cells) {
    Profile found{{0.0}, {static_cast<double>(dem[mouth])}};
    each_cell_above(drainage, mouth, support_cells, [&](Cell at, std::size_t way) {
        found.way_m.push_back(found.way_m.back() + dem.grid().cell_m / d8_per_length[way]);
        found.z.push_back(static_cast<double>(dem[at]));
    });
    return found;
}

void measure_stems(Raster<float> const& dem, flow::FlowField const& drainage, std::int64_t support_cells,
                   VarietyParams const& params, Run const& run, Variety& found) {
    std::vector<double> heights;
    for (std::int64_t const mouth : mouths(drainage, support_cells)) {
        run.check();
        if (std::ssize(heights) == params.most_stems) {
            break;
        }
        Profile const stem = profile_above(dem, drainage, mouth, support_cells);
        double const rise = stem.z.back() - stem.z.front();
        if (std::ssize(stem.z) >= params.stem_cells && rise > 0.0) {
            heights.push_back((stem.half_way() - stem.z.front()) / rise);
        }
    }
    found.stems = std::ssize(heights);
    if (!heights.empty()) {
        found.half_way_height = quantile(heights, 0.5);
    }
}

/// The height of the lowest neighbour that is no river cell; infinity: there is none.
double lower_bank(Raster<float> const& dem, Mask const& is, Cell at) {
    double lowest = std::numeric_limits<double>::infinity();
    for (auto const& step : d8_steps) {
        Cell const beside{at.col + step.col, at.row + step.row};
        if (dem.grid().contains(beside) && (is[beside] & river) == 0 && !std::isnan(dem[beside])) {
            lowest = std::min(lowest, static_cast<double>(dem[beside]));
        }
    }
    return lowest;
}

void measure_banks(Raster<float> const& dem, Mask const& is, Cells const& river_cells, double rise_m, Variety& found) {
    found.river_cells = std::ssize(river_cells);
    for (std::int64_t const i : river_cells) {
        double const bank = lower_bank(dem, is, dem.grid().at(i));
        found.canal_cells += std::isfinite(bank) && bank - static_cast<double>(dem[i]) > rise_m ? 1 : 0;
    }
}

/// Marks what drains to river cells and what drains past all: each flow path is followed to a cell that is known.
void mark_sides(Raster<float> const& dem, flow::FlowField const& drainage, Run const& run, Mask& is) {
    auto const offsets = d8_offsets(dem.grid());
    Cells path;
    for (std::int64_t start = 0; start < is.cells(); ++start) {
        if (start % cells_between_checks == 0) {
            run.check();
        }
        if (is[start] != 0 || std::isnan(dem[start])) {
            continue;
        }
        path.clear();
        std::uint8_t side = outside;
        for (std::int64_t at = start;;
             at += offsets[index_of(drainage.direction[at])]) { // never to one without a height
            if (is[at] != 0) {
                side = (is[at] & outside) != 0 ? outside : inside;
                break;
            }
            path.push_back(at);
            if (!goes_on(drainage.direction[at])) {
                break;
            }
        }
        for (std::int64_t const cell : path) {
            is[cell] = side;
        }
    }
}

/// The sides of the cells of some rows, and of those cells and their neighbours in the row.
struct SidesOfRow {
    std::vector<std::uint8_t> own;
    std::vector<std::uint8_t> around;

    /// \param bits of the row's cells; empty: of no side
    void set(std::span<std::uint8_t const> bits, std::size_t width) {
        own.assign(width + 2, 0); // without sides beyond both ends
        around.resize(width);
        for (std::size_t c = 0; c < bits.size(); ++c) {
            own[c + 1] = static_cast<std::uint8_t>((bits[c] & river) != 0 ? inside : bits[c] & (inside | outside));
        }
        for (std::size_t c = 0; c < width; ++c) {
            around[c] = static_cast<std::uint8_t>(own[c] | own[c + 1] | own[c + 2]);
        }
    }
};

/// The cells that drain to a river beside one that drains past all, and those.
Cells divide_of(Mask const& is) {
    auto const width = static_cast<std::size_t>(is.width());
    auto const row_of = [&](std::int64_t row) {
        return row < is.height() ? std::span<std::uint8_t const>(is.row(row)) : std::span<std::uint8_t const>();
    };
    Cells found;
    std::array<SidesOfRow, 3> rows; // above, here and below by turns
    rows[2].set({}, width);
    rows[0].set(row_of(0), width);
    std::vector<std::uint8_t> at_divide(width);
    for (std::int64_t row = 0; row < is.height(); ++row) {
        SidesOfRow const& here = rows[row % 3];
        rows[(row + 1) % 3].set(row_of(row + 1), width);
        for (std::size_t c = 0; c < width; ++c) {
            auto const all = static_cast<std::uint8_t>(rows[0].around[c] | rows[1].around[c] | rows[2].around[c]);
            at_divide[c] = all == (inside | outside) && here.own[c + 1] != 0 ? 1 : 0;
        }
        for (std::size_t c = 0; c < width; ++c) {
            if (at_divide[c] != 0) {
                found.push_back(row * is.width() + static_cast<std::int64_t>(c));
            }
        }
    }
    return found;
}

/// Places at about the same distance in sixteen directions.
std::array<Cell, 16> circle(double radius_cells) {
    std::array<Cell, 16> found{};
    for (std::size_t k = 0; k < found.size(); ++k) {
        double const angle = static_cast<double>(k) * portable::pi / 8.0;
        found[k] = {std::llround(radius_cells * portable::cos(angle)),
                    std::llround(radius_cells * portable::sin(angle))};
    }
    return found;
}

/// How many cells drop by so many metres.
struct Drops {
    static constexpr std::size_t classes = 10'000;
    std::vector<std::int64_t> counts = std::vector<std::int64_t>(classes);
    std::int64_t cells = 0;

    void add(double drop_m) {
        ++counts[std::min(static_cast<std::size_t>(std::max(drop_m, 0.0)), classes - 1)];
        ++cells;
    }
    void add(Drops const& other) {
        for (std::size_t i = 0; i < classes; ++i) {
            counts[i] += other.counts[i];
        }
        cells += other.cells;
    }
    double percentile(double share) const { return place_in_classes(counts, share * static_cast<double>(cells)); }
};

/// The drops over a distance.
struct AllDrops {
    Drops lattice; ///< on cells a tenth of the distance apart
    Drops divide;
    Drops elsewhere; ///< of the lattice, away from the divide

    void add(AllDrops const& other) {
        lattice.add(other.lattice);
        divide.add(other.divide);
        elsewhere.add(other.elsewhere);
    }
};

/// Where the lowest of the places around a cell lies under it.
class DropBelow {
public:
    DropBelow(Raster<float> const& dem, double radius_cells) : dem_(dem), around_(circle(radius_cells)) {
        for (std::size_t k = 0; k < around_.size(); ++k) {
            offsets_[k] = around_[k].row * dem.width() + around_[k].col;
            reach_ = std::max({reach_, std::abs(around_[k].col), std::abs(around_[k].row)});
        }
    }

    double at(Cell at) const {
        std::int64_t const i = dem_.grid().index(at);
        bool const is_inner =
            at.col >= reach_ && at.row >= reach_ && at.col + reach_ < dem_.width() && at.row + reach_ < dem_.height();
        float lowest = dem_[i];
        for (std::size_t k = 0; k < around_.size(); ++k) {
            if (is_inner || dem_.grid().contains({at.col + around_[k].col, at.row + around_[k].row})) {
                float const z = dem_[i + offsets_[k]];
                lowest = z < lowest ? z : lowest;
            }
        }
        return static_cast<double>(dem_[i]) - static_cast<double>(lowest);
    }

private:
    Raster<float> const& dem_;
    std::array<Cell, 16> around_;
    std::array<std::int64_t, 16> offsets_{};
    std::int64_t reach_ = 0; ///< [cells] the most along an axis
};

AllDrops drops_of(Raster<float> const& dem, Cells const& divide, VarietyParams const& params, Run const& run) {
    constexpr std::int64_t rows_a_block = 256;
    double const radius = params.wall_m / dem.grid().cell_m;
    auto const step = std::max<std::int64_t>(static_cast<std::int64_t>(radius / 10.0), 1);
    DropBelow const drop(dem, radius);
    Near const beside(dem.grid(), divide, params.divide_m);
    std::vector<AllDrops> blocks(static_cast<std::size_t>((dem.height() + rows_a_block - 1) / rows_a_block));
    parallel_ranges(run, std::ssize(blocks), 1, [&](std::int64_t begin, std::int64_t end) {
        std::vector<std::int64_t> change;
        std::vector<std::uint8_t> near;
        for (std::int64_t b = begin; b < end; ++b) {
            run.check();
            for (std::int64_t r = b * rows_a_block; r < std::min((b + 1) * rows_a_block, dem.height()); ++r) {
                for (std::int64_t const c : beside.in_row(r)) {
                    blocks[b].divide.add(drop.at({c, r}));
                }
                if (r % step != 0) {
                    continue;
                }
                if (!divide.empty()) { // what is away from nothing is not compared
                    beside.row(r, change, near);
                }
                for (std::int64_t c = 0; c < dem.width(); c += step) {
                    if (std::isnan(dem[Cell{c, r}])) {
                        continue;
                    }
                    double const drop_m = drop.at({c, r});
                    blocks[b].lattice.add(drop_m);
                    if (!divide.empty() && near[static_cast<std::size_t>(c)] == 0) {
                        blocks[b].elsewhere.add(drop_m);
                    }
                }
            }
        }
    });
    AllDrops total = std::move(blocks.front());
    for (std::size_t b = 1; b < blocks.size(); ++b) {
        total.add(blocks[b]);
    }
    return total;
}

/// The share of the land that drains past the rivers.
double share_outside(Raster<float> const& dem, Mask const& is) {
    std::int64_t land = 0;
    std::int64_t past = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        land += std::isnan(dem[i]) ? 0 : 1;
        past += (is[i] & outside) != 0 ? 1 : 0; // none of these is without a height
    }
    return land > 0 ? static_cast<double>(past) / static_cast<double>(land) : 0.0;
}

void measure_drops(Raster<float> const& dem, Cells const& divide, VarietyParams const& params, Run const& run,
                   Variety& found) {
    if (static_cast<double>(std::min(dem.width(), dem.height())) * dem.grid().cell_m < 2.0 * params.wall_m) {
        return;
    }
    AllDrops const drops = drops_of(dem, divide, params, run);
    double const usual = drops.lattice.percentile(0.9);
    if (usual > 0.0) {
        found.steepest_drop = drops.lattice.percentile(0.999) / usual;
    }
    double const least = params.least_share;
    double const away = drops.elsewhere.percentile(0.99);
    if (drops.divide.cells > 0 && found.outside_share >= least && found.outside_share <= 1.0 - least && away > 0.0 &&
        static_cast<double>(drops.elsewhere.cells) >= least * static_cast<double>(drops.lattice.cells)) {
        found.wall = drops.divide.percentile(0.99) / away;
    }
}

} // namespace

Variety variety(Raster<float> const& dem, flow::FlowField const& drainage, std::span<std::int64_t const> rivers,
                VarietyParams const& params, Run const& run) {
    check(params, dem, drainage, rivers);
    Variety found;
    if (dem.cells() == 0) {
        return found;
    }
    std::int64_t const support_cells = support_of(dem.grid(), params.stream_m2);
    Mask is(dem.grid());
    Cells const river_cells = mark_rivers(dem, drainage, rivers, support_cells, is);
    measure_windows(dem, river_cells, params, run, found);
    measure_stems(dem, drainage, support_cells, params, run, found);
    measure_banks(dem, is, river_cells, params.bank_tangent * dem.grid().cell_m, found);
    Cells divide;
    if (!rivers.empty()) {
        mark_sides(dem, drainage, run, is);
        divide = divide_of(is);
        found.outside_share = share_outside(dem, is);
    }
    measure_drops(dem, divide, params, run, found);
    return found;
}

Variety variety(Raster<float> const& dem, flow::FlowField const& drainage, VarietyParams const& params,
                Run const& run) {
    return variety(dem, drainage, std::span<std::int64_t const>(), params, run);
}

} // namespace thalweg::measure
