// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/slopes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/measure/relief/internal/horn.hpp>
#include <thalweg/measure/relief/internal/place_in_classes.hpp>
#include <thalweg/measure/relief/internal/some_slopes.hpp>

namespace thalweg::measure {
namespace {

constexpr std::int64_t rows_a_block = 64;
constexpr std::size_t classes_a_degree = 100;
constexpr std::size_t classes = 90 * classes_a_degree;
constexpr std::size_t degrees_a_share = 2;

/// Tangents of the half angle of sectors around the eight directions.
struct Sector {
    double straight; ///< of the angle itself: beside an axis
    double diagonal; ///< of 45 degrees minus the angle: beside a diagonal
    double even;     ///< share of uniform aspects in the eight sectors
};

Sector sector(double half_deg) {
    auto const tangent = [](double deg) {
        double const angle = deg * (portable::pi / 180.0);
        return portable::sin(angle) / portable::cos(angle);
    };
    return {tangent(half_deg), tangent(45.0 - half_deg), half_deg / 22.5};
}

/// Sums over some rows. Blocks are combined in order, regardless of the thread that computed them.
struct Block {
    std::vector<std::int64_t> counts; ///< by class of slope
    CompensatedSum degrees;
    CompensatedSum degrees_squared;
    CompensatedSum tangents;
    CompensatedSum tangents_squared;
    std::int64_t facing = 0; ///< cells that are not level
    std::int64_t along = 0;
    std::int64_t on = 0;
};

bool within(Sector const& s, double shorter, double longer) {
    return shorter <= s.straight * longer || shorter >= s.diagonal * longer;
}

void add_row(Raster<float> const& dem, std::int64_t row, Sector const& wide, Sector const& narrow, Block& block) {
    SomeSlopes some;
    auto const beyond = static_cast<std::size_t>(std::max<std::int64_t>(dem.width() - 1, 1));
    for (std::size_t first = 1; first < beyond; first += SomeSlopes::at_once) {
        std::size_t const count = std::min(SomeSlopes::at_once, beyond - first);
        some.compute(dem, row, first, count);
        for (std::size_t i = 0; i < count; ++i) {
            double const tangent = some.tangent[i];
            if (std::isnan(tangent)) {
                continue;
            }
            double const degrees = some.angle[i] * (180.0 / portable::pi);
            ++block.counts[std::min(static_cast<std::size_t>(degrees * classes_a_degree), classes - 1)];
            block.degrees.add(degrees);
            block.degrees_squared.add(degrees * degrees);
            block.tangents.add(tangent);
            block.tangents_squared.add(tangent * tangent);
            if (tangent > 0.0) {
                double const shorter = std::min(some.dx[i], some.dy[i]);
                double const longer = std::max(some.dx[i], some.dy[i]);
                ++block.facing;
                block.along += within(wide, shorter, longer) ? 1 : 0;
                block.on += within(narrow, shorter, longer) ? 1 : 0;
            }
        }
    }
}

/// The slope below which a share of the cells lies.
double percentile(std::vector<std::int64_t> const& counts, std::int64_t cells, double share) {
    return place_in_classes(counts, share * static_cast<double>(cells)) / static_cast<double>(classes_a_degree);
}

/// Standard deviation from the means of values and of their squares.
double deviation(double mean, double mean_of_squares) {
    return std::sqrt(std::max(0.0, mean_of_squares - mean * mean));
}

Block total_of(std::vector<Block> const& blocks) {
    Block total;
    total.counts.assign(classes, 0);
    for (Block const& block : blocks) {
        for (std::size_t i = 0; i < classes; ++i) {
            total.counts[i] += block.counts[i];
        }
        total.degrees.add(block.degrees.value());
        total.degrees_squared.add(block.degrees_squared.value());
        total.tangents.add(block.tangents.value());
        total.tangents_squared.add(block.tangents_squared.value());
        total.facing += block.facing;
        total.along += block.along;
        total.on += block.on;
    }
    return total;
}

enum class Ground : std::uint8_t { none, steep, gentle };

Ground ground_of(Raster<float> const& dem, std::int64_t i, std::array<std::int64_t, 8> const& to, double tangent) {
    bool const lake = std::all_of(to.begin(), to.end(), [&](std::int64_t step) { return dem[i + step] == dem[i]; });
    double const squared = horn_squared(dem, i, to);
    if (lake || std::isnan(squared) || std::isnan(dem[i])) {
        return Ground::none;
    }
    return squared < tangent * tangent ? Ground::gentle : Ground::steep;
}

Raster<Ground> grounds(Raster<float> const& dem, double below_deg, Run const& run) {
    Raster<Ground> found(dem.grid(), Ground::none);
    auto const offsets = d8_offsets(dem.grid());
    double const angle = below_deg * (portable::pi / 180.0);
    double const tangent = portable::sin(angle) / portable::cos(angle);
    parallel_ranges(run, std::max<std::int64_t>(dem.height() - 2, 0), 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin + 1; r < end + 1; ++r) {
            run.check();
            for (std::int64_t c = 1; c + 1 < dem.width(); ++c) {
                found[Cell{c, r}] = ground_of(dem, dem.grid().index({c, r}), offsets, tangent);
            }
        }
    });
    return found;
}

/// Counts the patch of a cell and marks it as steep, so that it is counted once. Border cells are never in a patch: no
/// neighbour is off the grid.
std::int64_t take_patch(Raster<Ground>& ground, std::int64_t start, std::array<std::int64_t, 8> const& offsets,
                        std::vector<std::int64_t>& open) {
    std::int64_t cells = 0;
    open.assign(1, start);
    ground[start] = Ground::steep;
    while (!open.empty()) {
        std::int64_t const cell = open.back();
        open.pop_back();
        ++cells;
        for (std::int64_t const step : offsets) {
            if (ground[cell + step] == Ground::gentle) {
                ground[cell + step] = Ground::steep;
                open.push_back(cell + step);
            }
        }
    }
    return cells;
}

double lowest_of_second_ring(Raster<float> const& dem, Cell at) {
    double lowest = std::numeric_limits<double>::infinity();
    for (std::int64_t row = -2; row <= 2; ++row) {
        for (std::int64_t col = -2; col <= 2; ++col) {
            Cell const there{at.col + col, at.row + row};
            bool const in_ring = std::max(std::abs(row), std::abs(col)) == 2;
            if (in_ring && dem.grid().contains(there) && !std::isnan(dem[there])) {
                lowest = std::min(lowest, static_cast<double>(dem[there]));
            }
        }
    }
    return lowest;
}

} // namespace

Slopes slopes(Raster<float> const& dem, Run const& run) {
    refuse_if<BadInput>(dem.cells() > 0 && !(dem.grid().cell_m > 0.0), "measure.slopes",
                        "the DEM's cells have a side of {} m; it must be greater than 0", dem.grid().cell_m);
    Slopes found;
    found.percentile_deg.fill(std::numeric_limits<double>::quiet_NaN());
    std::int64_t const rows = std::max<std::int64_t>(dem.height() - 2, 0);
    Sector const wide = sector(11.25);
    Sector const narrow = sector(2.5);
    std::vector<Block> blocks((rows + rows_a_block - 1) / rows_a_block);
    parallel_ranges(run, std::ssize(blocks), 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t b = begin; b < end; ++b) {
            run.check();
            Block& block = blocks[b];
            block.counts.assign(classes, 0);
            for (std::int64_t r = b * rows_a_block; r < std::min((b + 1) * rows_a_block, rows); ++r) {
                add_row(dem, r + 1, wide, narrow, block);
            }
        }
    });
    Block const total = total_of(blocks);
    for (std::int64_t const count : total.counts) {
        found.cells += count;
    }
    if (found.cells == 0) {
        return found;
    }
    auto const n = static_cast<double>(found.cells);
    found.mean_deg = total.degrees.value() / n;
    found.std_deg = deviation(found.mean_deg, total.degrees_squared.value() / n);
    found.tangent_mean = total.tangents.value() / n;
    found.tangent_cv = deviation(found.tangent_mean, total.tangents_squared.value() / n) / found.tangent_mean;
    for (std::size_t p = 0; p < slope_percents.size(); ++p) {
        found.percentile_deg[p] = percentile(total.counts, found.cells, slope_percents[p] / 100.0);
    }
    found.shares.assign(90 / degrees_a_share, 0.0);
    for (std::size_t i = 0; i < classes; ++i) {
        found.shares[i / (classes_a_degree * degrees_a_share)] += static_cast<double>(total.counts[i]);
    }
    for (double& share : found.shares) {
        share /= n;
    }
    if (total.facing > 0) {
        auto const facing = static_cast<double>(total.facing);
        found.aspects_along_grid = static_cast<double>(total.along) / facing / wide.even;
        found.aspects_on_grid = static_cast<double>(total.on) / facing / narrow.even;
    }
    return found;
}

LevelPatch level_patch(Raster<float> const& dem, LevelPatchParams const& params, Run const& run) {
    require_in("measure.level_patch", "below_deg", params.below_deg, Range::inside(0.0, 90.0));
    refuse_if<BadInput>(dem.cells() > 0 && !(dem.grid().cell_m > 0.0), "measure.level_patch",
                        "the DEM's cells have a side of {} m; it must be greater than 0", dem.grid().cell_m);
    Raster<Ground> ground = grounds(dem, params.below_deg, run);
    auto const offsets = d8_offsets(dem.grid());
    LevelPatch found;
    std::vector<std::int64_t> open;
    for (std::int64_t i = 0; i < ground.cells(); ++i) {
        found.land += ground[i] == Ground::none ? 0 : 1;
    }
    for (std::int64_t i = 0; i < ground.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (ground[i] == Ground::gentle) {
            found.cells = std::max(found.cells, take_patch(ground, i, offsets, open));
        }
    }
    return found;
}

std::vector<std::int64_t> perched(Raster<float> const& dem, std::span<std::int64_t const> cells, double rise_m) {
    require_in("measure.perched", "rise_m", rise_m, Range::at_least(0.0));
    std::vector<std::int64_t> found;
    for (std::int64_t const cell : cells) {
        refuse_if<BadInput>(cell < 0 || cell >= dem.cells(), "measure.perched", "cell {} is not one of the DEM's {}",
                            cell, dem.cells());
        if (static_cast<double>(dem[cell]) - lowest_of_second_ring(dem, dem.grid().at(cell)) > rise_m) {
            found.push_back(cell);
        }
    }
    return found;
}

double sunken_share(Raster<float> const& dem, std::span<std::int64_t const> cells, SunkenShareParams const& params,
                    Run const& run) {
    constexpr char const* self = "measure.sunken_share";
    require_in(self, "tolerance_m", params.tolerance_m, Range::at_least(0.0));
    Mask is_base(dem.grid());
    for (std::int64_t i = 0; params.has_sea && i < dem.cells(); ++i) {
        is_base[i] = std::isnan(dem[i]) ? 1 : 0;
    }
    for (std::int64_t const cell : cells) {
        refuse_if<BadInput>(cell < 0 || cell >= dem.cells(), self, "cell {} is not one of the DEM's {}", cell,
                            dem.cells());
        is_base[cell] = 1;
    }
    Raster<std::int64_t> const nearest = nearest_cells(is_base, run);
    std::int64_t land = 0;
    std::int64_t sunken = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        auto const base = static_cast<double>(dem[nearest[i]]);
        double const above = static_cast<double>(dem[i]) - (params.has_sea && std::isnan(base) ? 0.0 : base);
        if (is_base[i] == 0 && !std::isnan(above)) {
            ++land;
            sunken += above < -params.tolerance_m ? 1 : 0;
        }
    }
    return land > 0 ? static_cast<double>(sunken) / static_cast<double>(land) : 0.0;
}

} // namespace thalweg::measure
