// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/variety.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/ranks.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/measure/relief/internal/main_stems.hpp>
#include <thalweg/measure/relief/internal/some_slopes.hpp>

namespace thalweg::measure {
namespace {

constexpr char const* self = "measure.variety";
constexpr std::int64_t least_windows = 4;

/// What a cell is, as bits.
constexpr std::uint8_t river = 1;
constexpr std::uint8_t inside = 2;  ///< drains to a river cell, or is one
constexpr std::uint8_t outside = 4; ///< drains past all
constexpr std::uint8_t divide = 8;  ///< has neighbours of both, or is one of them

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

Mask river_cells(Raster<float> const& dem, flow::FlowField const& drainage, std::span<std::int64_t const> rivers,
                 std::int64_t support_cells) {
    Mask found(dem.grid());
    for (std::int64_t const cell : rivers) {
        found[cell] = std::isnan(dem[cell]) ? 0 : river;
    }
    for (std::int64_t i = 0; rivers.empty() && i < dem.cells(); ++i) {
        found[i] = drainage.area_cells[i] >= support_cells ? river : 0;
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
    /// \param bit of the cells
    Near(Mask const& is, std::uint8_t bit, double away_m)
        : is_(is), radius_(static_cast<std::int64_t>(std::floor(away_m / is.grid().cell_m))),
          squared_(away_m / is.grid().cell_m * (away_m / is.grid().cell_m)),
          by_row_(static_cast<std::size_t>(is.height())) {
        for (std::int64_t r = 0; r < is.height(); ++r) {
            for (std::int64_t c = 0; c < is.width(); ++c) {
                if ((is[Cell{c, r}] & bit) != 0) {
                    by_row_[r].push_back(c);
                }
            }
        }
    }

    /// \param near 1 for each cell of the row that is near; as many as the grid is wide
    void row(std::int64_t row, std::vector<std::int64_t>& change, std::vector<std::uint8_t>& near) const {
        std::int64_t const width = is_.width();
        change.assign(static_cast<std::size_t>(width) + 1, 0);
        for (std::int64_t r = std::max<std::int64_t>(row - radius_, 0); r <= std::min(row + radius_, is_.height() - 1);
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
    Mask const& is_;
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
            for (std::size_t i = 0; i < count; ++i) {
                if (std::isnan(some.tangent[i])) {
                    continue;
                }
                double const degrees = some.angle[i] * (180.0 / portable::pi);
                std::size_t const window = (from + i) / static_cast<std::size_t>(side);
                found.degrees[window].add(degrees);
                ++found.cells[window];
                if (degrees < gentle_deg) {
                    ++found.gentle;
                    found.gentle_away += near[from + i] == 0 ? 1 : 0;
                }
            }
        }
    }
    return found;
}

void measure_windows(Raster<float> const& dem, Mask const& is, VarietyParams const& params, Run const& run,
                     Variety& found) {
    Grid const& grid = dem.grid();
    std::int64_t const side = std::max<std::int64_t>(std::llround(params.window_m / grid.cell_m), 1);
    Near const rivers(is, river, params.away_m);
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
    Cell at = dem.grid().at(mouth);
    for (int k = main_donor(drainage, at); k >= 0; k = main_donor(drainage, at)) {
        auto const way = static_cast<std::size_t>(k);
        at = {at.col + d8_steps[way].col, at.row + d8_steps[way].row};
        if (drainage.area_cells[at] < support_cells) {
            break;
        }
        found.way_m.push_back(found.way_m.back() + dem.grid().cell_m / d8_per_length[way]);
        found.z.push_back(static_cast<double>(dem[at]));
    }
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

void measure_banks(Raster<float> const& dem, Mask const& is, double rise_m, Variety& found) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if ((is[i] & river) != 0) {
            ++found.river_cells;
            double const bank = lower_bank(dem, is, dem.grid().at(i));
            found.canal_cells += std::isfinite(bank) && bank - static_cast<double>(dem[i]) > rise_m ? 1 : 0;
        }
    }
}

/// Marks what drains to river cells and what drains past all: each flow path is followed to a cell that is known.
void mark_sides(Raster<float> const& dem, flow::FlowField const& drainage, Run const& run, Mask& is) {
    std::vector<std::int64_t> path;
    for (std::int64_t start = 0; start < is.cells(); ++start) {
        if (start % cells_between_checks == 0) {
            run.check();
        }
        std::uint8_t side = 0;
        std::int64_t at = start;
        for (path.clear(); side == 0; at = drainage.receiver(at)) {
            if (at < 0 || std::isnan(dem[at])) {
                side = outside;
            } else if (is[at] != 0) {
                side = (is[at] & outside) != 0 ? outside : inside;
            } else {
                path.push_back(at);
            }
        }
        for (std::int64_t const cell : path) {
            is[cell] = side;
        }
    }
}

/// Marks the cells that drain to a river beside one that drains past all, and those.
void mark_divide(Mask& is) {
    std::int64_t const width = is.width();
    auto const side = [](std::uint8_t bits) {
        return static_cast<std::uint8_t>((bits & river) != 0 ? inside : bits & (inside | outside));
    };
    auto const compare = [&](std::int64_t i, std::int64_t other) {
        if ((side(is[i]) | side(is[other])) == (inside | outside)) {
            is[i] = static_cast<std::uint8_t>(is[i] | divide);
            is[other] = static_cast<std::uint8_t>(is[other] | divide);
        }
    };
    for (std::int64_t row = 0; row < is.height(); ++row) {
        for (std::int64_t col = 0; col < width; ++col) {
            std::int64_t const i = row * width + col;
            if (col + 1 < width) {
                compare(i, i + 1);
            }
            if (row + 1 < is.height()) {
                compare(i, i + width);
            }
            if (row + 1 < is.height() && col + 1 < width) {
                compare(i, i + width + 1);
                compare(i + 1, i + width);
            }
        }
    }
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
    double percentile(double share) const {
        double const wanted = share * static_cast<double>(cells);
        double before = 0.0;
        for (std::size_t i = 0; i < classes; ++i) {
            auto const here = static_cast<double>(counts[i]);
            if (here > 0.0 && before + here >= wanted) {
                return static_cast<double>(i) + (wanted - before) / here;
            }
            before += here;
        }
        return std::numeric_limits<double>::quiet_NaN();
    }
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

double drop_at(Raster<float> const& dem, Cell at, std::array<Cell, 16> const& around) {
    auto lowest = static_cast<double>(dem[at]);
    for (Cell const step : around) {
        Cell const there{at.col + step.col, at.row + step.row};
        if (dem.grid().contains(there) && static_cast<double>(dem[there]) < lowest) {
            lowest = static_cast<double>(dem[there]);
        }
    }
    return static_cast<double>(dem[at]) - lowest;
}

AllDrops drops_of(Raster<float> const& dem, Mask const& is, VarietyParams const& params, Run const& run) {
    constexpr std::int64_t rows_a_block = 256;
    double const radius = params.wall_m / dem.grid().cell_m;
    auto const step = std::max<std::int64_t>(static_cast<std::int64_t>(radius / 10.0), 1);
    std::array<Cell, 16> const around = circle(radius);
    Near const beside(is, divide, params.divide_m);
    std::vector<AllDrops> blocks(static_cast<std::size_t>((dem.height() + rows_a_block - 1) / rows_a_block));
    parallel_ranges(run, std::ssize(blocks), 1, [&](std::int64_t begin, std::int64_t end) {
        std::vector<std::int64_t> change;
        std::vector<std::uint8_t> near;
        for (std::int64_t b = begin; b < end; ++b) {
            run.check();
            for (std::int64_t r = b * rows_a_block; r < std::min((b + 1) * rows_a_block, dem.height()); ++r) {
                if (r % step == 0) {
                    beside.row(r, change, near);
                }
                for (std::int64_t c = 0; c < dem.width(); ++c) {
                    bool const on_lattice = r % step == 0 && c % step == 0;
                    bool const is_divide = (is[Cell{c, r}] & divide) != 0;
                    if ((!on_lattice && !is_divide) || std::isnan(dem[Cell{c, r}])) {
                        continue;
                    }
                    double const drop = drop_at(dem, {c, r}, around);
                    if (is_divide) {
                        blocks[b].divide.add(drop);
                    }
                    if (on_lattice) {
                        blocks[b].lattice.add(drop);
                    }
                    if (on_lattice && near[static_cast<std::size_t>(c)] == 0) {
                        blocks[b].elsewhere.add(drop);
                    }
                }
            }
        }
    });
    AllDrops total;
    for (AllDrops const& block : blocks) {
        total.add(block);
    }
    return total;
}

/// The share of the land that drains past the rivers.
double share_outside(Raster<float> const& dem, Mask const& is) {
    std::int64_t land = 0;
    std::int64_t past = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (!std::isnan(dem[i])) {
            ++land;
            past += (is[i] & outside) != 0 ? 1 : 0;
        }
    }
    return land > 0 ? static_cast<double>(past) / static_cast<double>(land) : 0.0;
}

void measure_drops(Raster<float> const& dem, Mask const& is, VarietyParams const& params, Run const& run,
                   Variety& found) {
    if (static_cast<double>(std::min(dem.width(), dem.height())) * dem.grid().cell_m < 2.0 * params.wall_m) {
        return;
    }
    AllDrops const drops = drops_of(dem, is, params, run);
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
    Mask is = river_cells(dem, drainage, rivers, support_cells);
    measure_windows(dem, is, params, run, found);
    measure_stems(dem, drainage, support_cells, params, run, found);
    measure_banks(dem, is, params.bank_tangent * dem.grid().cell_m, found);
    if (!rivers.empty()) {
        mark_sides(dem, drainage, run, is);
        mark_divide(is);
        found.outside_share = share_outside(dem, is);
    }
    measure_drops(dem, is, params, run, found);
    return found;
}

Variety variety(Raster<float> const& dem, flow::FlowField const& drainage, VarietyParams const& params,
                Run const& run) {
    return variety(dem, drainage, std::span<std::int64_t const>(), params, run);
}

} // namespace thalweg::measure
