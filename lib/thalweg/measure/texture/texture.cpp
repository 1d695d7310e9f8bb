// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/texture.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::measure {
namespace {

// Structure tensor of unit gradients, and the share of cells with data that contribute.
struct Tensor {
    double xx = 0.0;
    double yy = 0.0;
    double xy = 0.0;
    double weight = 0.0;

    Tensor& operator+=(Tensor const& more) {
        xx += more.xx;
        yy += more.yy;
        xy += more.xy;
        weight += more.weight;
        return *this;
    }
    Tensor& operator*=(double factor) {
        xx *= factor;
        yy *= factor;
        xy *= factor;
        weight *= factor;
        return *this;
    }
};

constexpr double deviations = 4.0;

/// Weights at 0, 1, 2 ... blocks from the centre; both sides together sum to 1.
std::vector<double> half_of_window(double window) {
    auto const reach = static_cast<std::size_t>(deviations * window + 0.5);
    std::vector<double> half(reach + 1);
    double sum = 0.0;
    for (std::size_t k = 0; k <= reach; ++k) {
        double const far = static_cast<double>(k) / window;
        half[k] = portable::exp(-0.5 * far * far);
        sum += k == 0 ? half[k] : 2.0 * half[k];
    }
    for (double& weight : half) {
        weight /= sum;
    }
    return half;
}

/// The index in [0, count) that reflection at both ends maps `place` to.
std::int64_t mirrored(std::int64_t place, std::int64_t count) {
    std::int64_t const turn = ((place % (2 * count)) + 2 * count) % (2 * count);
    return turn < count ? turn : 2 * count - 1 - turn;
}

/// Smooths along columns into a transposed grid.
Raster<Tensor> smooth_and_turn(Raster<Tensor> const& blocks, std::vector<double> const& half, Run const& run) {
    Grid turned = blocks.grid();
    std::swap(turned.width, turned.height);
    Raster<Tensor> out(turned);
    auto const reach = static_cast<std::int64_t>(half.size()) - 1;
    parallel_ranges(run, blocks.width(), 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t c = begin; c < end; ++c) {
            run.check();
            for (std::int64_t r = 0; r < blocks.height(); ++r) {
                Tensor& sum = out[Cell{r, c}];
                for (std::int64_t k = -reach; k <= reach; ++k) {
                    Tensor part = blocks[Cell{c, mirrored(r + k, blocks.height())}];
                    part *= half[k < 0 ? -k : k];
                    sum += part;
                }
            }
        }
    });
    return out;
}

// Averages tensors in a Gaussian window, truncated at four standard deviations; the grid is reflected at its edges.
// `blocks`: means over blocks of cells. `window`: [blocks] > 0, standard deviation. Returns by block; the same bits for
// any number of threads.
Raster<Tensor> smooth_blocks(Raster<Tensor> const& blocks, double window, Run const& run) {
    std::vector<double> const half = half_of_window(window);
    return smooth_and_turn(smooth_and_turn(blocks, half, run), half, run);
}

constexpr double too_small = std::numeric_limits<double>::quiet_NaN();
constexpr double blocks_a_window = 8.0; // the window's weights change little between blocks
constexpr double least_weight = 0.98;   // share of the window on cells with data
constexpr double border_windows = 2.0;  // at this distance 2 % of a window's weight lie beyond the border

/// Unit vectors uphill; 0: level, NaN: no data.
struct UnitGradients {
    Raster<float> x;
    Raster<float> y;
};

float difference(float before, float here, float after, bool first, bool last) {
    return first ? 2.0F * (after - here) : last ? 2.0F * (here - before) : after - before;
}

UnitGradients unit_gradients(Raster<float> const& dem, Run const& run) {
    UnitGradients found{Raster<float>(dem.grid()), Raster<float>(dem.grid())};
    std::int64_t const bottom = dem.height() - 1;
    std::int64_t const right = dem.width() - 1;
    parallel_ranges(run, dem.height(), 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            auto const north = dem.row(std::max<std::int64_t>(r - 1, 0));
            auto const here = dem.row(r);
            auto const south = dem.row(std::min(r + 1, bottom));
            for (std::int64_t c = 0; c <= right; ++c) {
                auto const at = [](std::span<float const> row, std::int64_t col) { return row[col]; };
                float const z = at(here, c);
                float const x = difference(at(here, std::max<std::int64_t>(c - 1, 0)), z,
                                           at(here, std::min(c + 1, right)), c == 0, c == right);
                float const y = difference(at(north, c), z, at(south, c), r == 0, r == bottom);
                float const length = std::sqrt(x * x + y * y);
                bool const known = !std::isnan(z) && !std::isnan(length);
                found.x[Cell{c, r}] = length > 0.0F ? x / length : known ? 0.0F : static_cast<float>(too_small);
                found.y[Cell{c, r}] = length > 0.0F ? y / length : known ? 0.0F : static_cast<float>(too_small);
            }
        }
    });
    return found;
}

struct Products {
    double sum = 0.0;
    std::int64_t pairs = 0;

    Products& operator+=(Products const& more) {
        sum += more.sum;
        pairs += more.pairs;
        return *this;
    }
    double mean() const { return pairs > 0 ? sum / static_cast<double>(pairs) : too_small; }
};

/// Sums products over the pairs of cells `lag` apart.
Products products(UnitGradients const& unit, Cell lag, Run const& run) {
    std::int64_t const offset = lag.row * unit.x.width() + lag.col;
    return sum_rows(run, unit.x.height() - lag.row, [&](std::int64_t r) {
        run.check();
        Products row;
        std::int64_t const first = r * unit.x.width();
        for (std::int64_t i = first; i < first + unit.x.width() - lag.col; ++i) {
            auto const x = static_cast<double>(unit.x[i]);
            auto const y = static_cast<double>(unit.y[i]);
            auto const there_x = static_cast<double>(unit.x[i + offset]);
            auto const there_y = static_cast<double>(unit.y[i + offset]);
            bool const slopes = (x != 0.0 || y != 0.0) && (there_x != 0.0 || there_y != 0.0);
            double const product = x * there_x + y * there_y;
            if (slopes && !std::isnan(product)) {
                row.sum += product;
                ++row.pairs;
            }
        }
        return row;
    });
}

double correlation(UnitGradients const& unit, double lag_m, Run const& run) {
    double const cells = std::round(lag_m / unit.x.grid().cell_m);
    if (cells < 1.0 || cells >= static_cast<double>(std::min(unit.x.width(), unit.x.height()))) {
        return too_small;
    }
    auto const lag = static_cast<std::int64_t>(cells);
    return 0.5 * (products(unit, {lag, 0}, run).mean() + products(unit, {0, lag}, run).mean());
}

Tensor tensor_of(UnitGradients const& unit, std::int64_t cell) {
    auto const x = static_cast<double>(unit.x[cell]);
    auto const y = static_cast<double>(unit.y[cell]);
    return std::isnan(x) ? Tensor{} : Tensor{x * x, y * y, x * y, 1.0};
}

/// Mean tensors over square blocks of `side` cells.
Raster<Tensor> blocks_of(UnitGradients const& unit, std::int64_t side, Run const& run) {
    Grid grid = unit.x.grid();
    grid.width = (grid.width + side - 1) / side;
    grid.height = (grid.height + side - 1) / side;
    Raster<Tensor> blocks(grid);
    parallel_ranges(run, grid.height, 1, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin * side; r < std::min(end * side, unit.x.height()); ++r) {
            run.check();
            for (std::int64_t c = 0; c < unit.x.width(); ++c) {
                blocks[Cell{c / side, r / side}] += tensor_of(unit, r * unit.x.width() + c);
            }
        }
    });
    for (std::int64_t i = 0; i < blocks.cells(); ++i) {
        Cell const at = grid.at(i);
        std::int64_t const wide = std::min(side, unit.x.width() - at.col * side);
        std::int64_t const high = std::min(side, unit.x.height() - at.row * side);
        blocks[i] *= 1.0 / static_cast<double>(wide * high);
    }
    return blocks;
}

double anisotropy(UnitGradients const& unit, double window_m, Run const& run) {
    double const window = window_m / unit.x.grid().cell_m; // cells
    if (!(window >= 1.0) ||
        2.0 * border_windows * window >= static_cast<double>(std::min(unit.x.width(), unit.x.height()))) {
        return too_small;
    }
    auto const side = std::max<std::int64_t>(static_cast<std::int64_t>(window / blocks_a_window), 1);
    auto const cells = static_cast<double>(side);
    Raster<Tensor> const smooth = smooth_blocks(blocks_of(unit, side, run), window / cells, run);
    Products sum;
    for (std::int64_t i = 0; i < smooth.cells(); ++i) {
        Cell const at = smooth.grid().at(i);
        auto const inside = [&](std::int64_t place, std::int64_t count) {
            double const centre = (static_cast<double>(place) + 0.5) * cells;
            return centre >= border_windows * window && centre <= static_cast<double>(count) - border_windows * window;
        };
        Tensor const& t = smooth[i];
        if (t.weight > least_weight && t.xx + t.yy > 0.0 && inside(at.col, unit.x.width()) &&
            inside(at.row, unit.x.height())) {
            sum.sum += std::sqrt((t.xx - t.yy) * (t.xx - t.yy) + 4.0 * t.xy * t.xy) / (t.xx + t.yy);
            ++sum.pairs;
        }
    }
    return sum.mean();
}

struct Channels {
    flow::FlowField const& drainage;
    StraightChannelsParams const& params;

    bool contains(std::int64_t cell) const {
        return drainage.area_cells[cell] >= params.support_cells && goes_on(drainage.direction[cell]);
    }
};

/// Whether the upstream channel cell flows here in the same direction.
bool run_goes_on_upstream(Channels const& channels, Cell at, flow::Direction direction) {
    Cell const step = d8_steps[index_of(direction)];
    Cell const above{at.col - step.col, at.row - step.row};
    Grid const& grid = channels.drainage.grid();
    return grid.contains(above) && channels.drainage.direction[above] == direction &&
           channels.contains(grid.index(above));
}

std::int64_t run_from(flow::FlowField const& drainage, std::int64_t cell) {
    flow::Direction const direction = drainage.direction[cell];
    std::int64_t steps = 0;
    for (std::int64_t at = cell; at >= 0 && drainage.direction[at] == direction; at = drainage.receiver(at)) {
        ++steps;
    }
    return steps;
}

/// Collects the cells of a reach; fewer than steps + 1 if the water ends.
void walk(flow::FlowField const& drainage, std::int64_t cell, std::int64_t steps, std::vector<Cell>& reach) {
    reach.clear();
    for (std::int64_t at = cell; at >= 0; at = drainage.receiver(at)) {
        reach.push_back(drainage.grid().at(at));
        if (static_cast<std::int64_t>(reach.size()) > steps || !goes_on(drainage.direction[at])) {
            return;
        }
    }
}

bool is_straight(std::vector<Cell> const& reach, double tolerance) {
    std::int64_t const across = reach.back().col - reach.front().col;
    std::int64_t const down = reach.back().row - reach.front().row;
    auto const chord = std::sqrt(static_cast<double>(across * across + down * down));
    return chord >= 1.0 && std::all_of(reach.begin(), reach.end(), [&](Cell at) {
               std::int64_t const area = (at.row - reach.front().row) * across - (at.col - reach.front().col) * down;
               return std::fabs(static_cast<double>(area)) <= tolerance * chord;
           });
}

struct RowOfReaches {
    std::int64_t longest_run = 0;
    std::int64_t reaches = 0;
    std::int64_t straight = 0;

    RowOfReaches& operator+=(RowOfReaches const& more) {
        longest_run = std::max(longest_run, more.longest_run);
        reaches += more.reaches;
        straight += more.straight;
        return *this;
    }
};

RowOfReaches row_of(Channels const& channels, std::int64_t r) {
    Grid const& grid = channels.drainage.grid();
    RowOfReaches row;
    std::vector<Cell> reach;
    for (std::int64_t c = 0; c < grid.width; ++c) {
        std::int64_t const cell = grid.index({c, r});
        if (!channels.contains(cell)) {
            continue;
        }
        if (!run_goes_on_upstream(channels, {c, r}, channels.drainage.direction[cell])) {
            row.longest_run = std::max(row.longest_run, run_from(channels.drainage, cell));
        }
        walk(channels.drainage, cell, channels.params.reach_steps, reach);
        if (static_cast<std::int64_t>(reach.size()) > channels.params.reach_steps) {
            ++row.reaches;
            row.straight += is_straight(reach, channels.params.tolerance_cells) ? 1 : 0;
        }
    }
    return row;
}

} // namespace

GradientTexture gradient_texture(Raster<float> const& dem, GradientTextureParams const& params, Run const& run) {
    require_in("measure.gradient_texture", "window_m", params.window_m, Range::above(0.0));
    GradientTexture found;
    found.correlation.fill(too_small);
    if (dem.width() < 2 || dem.height() < 2) {
        return found;
    }
    refuse_if<BadInput>(!(dem.grid().cell_m > 0.0),
                        "measure.gradient_texture: the DEM's cells have a side of {} m; it must be greater than 0",
                        dem.grid().cell_m);
    UnitGradients const unit = unit_gradients(dem, run);
    for (std::size_t lag = 0; lag < texture_lags_m.size(); ++lag) {
        found.correlation[lag] = correlation(unit, texture_lags_m[lag], run);
    }
    found.anisotropy = anisotropy(unit, params.window_m, run);
    return found;
}

StraightChannels straight_channels(flow::FlowField const& drainage, StraightChannelsParams const& params,
                                   Run const& run) {
    constexpr char const* self = "measure.straight_channels";
    require_in(self, "support_cells", params.support_cells, Range::at_least(1));
    require_in(self, "reach_steps", params.reach_steps, Range::at_least(2));
    require_in(self, "tolerance_cells", params.tolerance_cells, Range::at_least(0.0));
    Channels const channels{drainage, params};
    RowOfReaches const all = sum_rows(run, drainage.grid().height, [&](std::int64_t r) {
        run.check();
        return row_of(channels, r);
    });
    StraightChannels found{all.longest_run, all.reaches};
    if (all.reaches > 0) {
        found.straight_share = static_cast<double>(all.straight) / static_cast<double>(all.reaches);
    }
    return found;
}

} // namespace thalweg::measure
