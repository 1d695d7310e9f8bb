// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/texture/texture.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/measure/texture/internal/gradient_row.hpp>

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

constexpr double too_small = std::numeric_limits<double>::quiet_NaN();
constexpr double blocks_a_window = 8.0; // the window's weights change little between blocks
constexpr double least_weight = 0.98;   // share of the window on cells with data
constexpr double border_windows = 2.0;  // at this distance 2 % of a window's weight lie beyond the border

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

/// Along rows and columns, by lag.
struct ProductsByLag {
    std::array<Products, texture_lags_m.size()> along_rows;
    std::array<Products, texture_lags_m.size()> along_columns;

    ProductsByLag& operator+=(ProductsByLag const& more) {
        for (std::size_t lag = 0; lag < along_rows.size(); ++lag) {
            along_rows[lag] += more.along_rows[lag];
            along_columns[lag] += more.along_columns[lag];
        }
        return *this;
    }
};

/// Counts the pairs of cells of which neither is level.
std::int64_t pairs(std::uint8_t const* slopes, std::uint8_t const* there, std::size_t count) {
    std::int64_t found = 0;
    for (std::size_t c = 0; c < count; ++c) {
        found += slopes[c] & there[c];
    }
    return found;
}

/// Sums over a row of cells, in one pass: six sums that do not wait for one another.
/// \param below the rows that lie a lag further south
ProductsByLag products_of(GradientRow const& row, std::array<GradientRow const*, texture_lags_m.size()> const& below,
                          std::array<std::int64_t, texture_lags_m.size()> const& lags, std::size_t width) {
    static_assert(texture_lags_m.size() == 3);
    float const* const x = row.x.data();
    float const* const y = row.y.data();
    auto const product = [=](std::size_t c, float const* there_x, float const* there_y) {
        return static_cast<double>(x[c]) * static_cast<double>(there_x[c]) +
               static_cast<double>(y[c]) * static_cast<double>(there_y[c]);
    };
    std::array<double, 3> along_row{};
    std::array<double, 3> along_column{};
    for (std::size_t c = 0; c < width; ++c) {
        along_row[0] += product(c, x + lags[0], y + lags[0]);
        along_row[1] += product(c, x + lags[1], y + lags[1]);
        along_row[2] += product(c, x + lags[2], y + lags[2]);
        along_column[0] += product(c, below[0]->x.data(), below[0]->y.data());
        along_column[1] += product(c, below[1]->x.data(), below[1]->y.data());
        along_column[2] += product(c, below[2]->x.data(), below[2]->y.data());
    }
    ProductsByLag sums;
    for (std::size_t lag = 0; lag < lags.size(); ++lag) {
        sums.along_rows[lag] = {along_row[lag], pairs(row.slopes.data(), row.slopes.data() + lags[lag], width)};
        sums.along_columns[lag] = {along_column[lag], pairs(row.slopes.data(), below[lag]->slopes.data(), width)};
    }
    return sums;
}

std::array<double, texture_lags_m.size()> correlations(Raster<float> const& dem, Run const& run) {
    std::array<std::int64_t, texture_lags_m.size()> lags{}; // 0: shorter than a cell, or longer than the DEM
    for (std::size_t lag = 0; lag < lags.size(); ++lag) {
        double const cells = std::round(texture_lags_m[lag] / dem.grid().cell_m);
        bool const fits = cells >= 1.0 && cells < static_cast<double>(std::min(dem.width(), dem.height()));
        lags[lag] = fits ? static_cast<std::int64_t>(cells) : 0;
    }
    std::int64_t const longest = *std::ranges::max_element(lags);
    std::vector<ProductsByLag> rows(dem.height());
    constexpr std::int64_t rows_a_range = 128; // much more than the longest lag: rows beyond are computed twice
    parallel_ranges(run, dem.height(), rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        // The rows from r to that which lies the longest lag below it, each at its number modulo theirs.
        std::vector<GradientRow> kept(longest + 1, GradientRow(dem.width(), longest));
        GradientRow const level(dem.width());
        auto const at = [&](std::int64_t r) -> GradientRow& { return kept[r % std::ssize(kept)]; };
        for (std::int64_t r = begin; r < std::min(begin + longest, dem.height()); ++r) {
            at(r).compute(dem, r);
        }
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            if (r + longest < dem.height()) {
                at(r + longest).compute(dem, r + longest);
            }
            std::array<GradientRow const*, texture_lags_m.size()> below{};
            for (std::size_t lag = 0; lag < lags.size(); ++lag) {
                bool const is_known = lags[lag] > 0 && r + lags[lag] < dem.height();
                below[lag] = is_known ? &at(r + lags[lag]) : &level;
            }
            rows[r] = products_of(at(r), below, lags, static_cast<std::size_t>(dem.width()));
        }
    });
    ProductsByLag sum;
    for (ProductsByLag const& of_row : rows) {
        sum += of_row;
    }
    std::array<double, texture_lags_m.size()> found{};
    for (std::size_t lag = 0; lag < lags.size(); ++lag) {
        found[lag] = lags[lag] > 0 ? 0.5 * (sum.along_rows[lag].mean() + sum.along_columns[lag].mean()) : too_small;
    }
    return found;
}

/// Mean tensors over square blocks of cells, row by row.
class Blocks {
public:
    Blocks(Raster<float> const& dem, std::int64_t side)
        : dem_(dem), side_(side), width_((dem.width() + side - 1) / side), height_((dem.height() + side - 1) / side) {}

    std::int64_t width() const { return width_; }
    std::int64_t height() const { return height_; }
    std::int64_t cells_wide() const { return dem_.width(); }

    /// Computes a row of blocks.
    void compute(std::int64_t row, GradientRow& gradients, Tensor* blocks) const {
        std::fill(blocks, blocks + width_, Tensor{});
        std::int64_t const high = std::min(side_, dem_.height() - row * side_);
        for (std::int64_t r = row * side_; r < row * side_ + high; ++r) {
            gradients.compute(dem_, r);
            for (std::int64_t block = 0; block < width_; ++block) {
                Tensor sum = blocks[block]; // apart from what it is read from
                for (std::int64_t c = block * side_; c < std::min((block + 1) * side_, dem_.width()); ++c) {
                    auto const x = static_cast<double>(gradients.x[c]);
                    auto const y = static_cast<double>(gradients.y[c]);
                    sum += Tensor{x * x, y * y, x * y, static_cast<double>(gradients.known[c])};
                }
                blocks[block] = sum;
            }
        }
        for (std::int64_t block = 0; block < width_; ++block) {
            std::int64_t const wide = std::min(side_, dem_.width() - block * side_);
            blocks[block] *= 1.0 / static_cast<double>(wide * high);
        }
    }

private:
    Raster<float> const& dem_;
    std::int64_t side_; ///< [cells]
    std::int64_t width_;
    std::int64_t height_;
};

/// Some rows of blocks.
class Band {
public:
    Band(Blocks const& blocks, std::int64_t first, std::int64_t beyond, Run const& run)
        : blocks_(blocks), first_(first), tensors_((beyond - first) * blocks.width()) {
        parallel_ranges(run, beyond - first, 16, [&](std::int64_t begin, std::int64_t end) {
            GradientRow gradients(blocks.cells_wide());
            for (std::int64_t row = begin; row < end; ++row) {
                run.check();
                blocks.compute(first + row, gradients, tensors_.data() + row * blocks.width());
            }
        });
    }

    std::int64_t width() const { return blocks_.width(); }
    /// \param row of the DEM's blocks, reflected at its edges
    Tensor const* row(std::int64_t row) const {
        return tensors_.data() + (mirrored(row, blocks_.height()) - first_) * width();
    }

private:
    Blocks const& blocks_;
    std::int64_t first_;
    std::vector<Tensor> tensors_;
};

/// Averages rows of blocks in a Gaussian window, which is reflected at the edges.
class Smoother {
public:
    Smoother(Band const& band, std::vector<double> const& half)
        : band_(band), half_(half), reach_(std::ssize(half) - 1), along_columns_(band.width() + 2 * reach_),
          smooth_(band.width()) {}

    std::vector<Tensor> const& row(std::int64_t row) {
        std::int64_t const width = band_.width();
        Tensor* const middle = along_columns_.data() + reach_;
        std::fill(middle, middle + width, Tensor{});
        for (std::int64_t k = -reach_; k <= reach_; ++k) {
            add(middle, band_.row(row + k), width, k);
        }
        for (std::int64_t c = -reach_; c < 0; ++c) {
            middle[c] = middle[mirrored(c, width)];
        }
        for (std::int64_t c = width; c < width + reach_; ++c) {
            middle[c] = middle[mirrored(c, width)];
        }
        std::ranges::fill(smooth_, Tensor{});
        for (std::int64_t k = -reach_; k <= reach_; ++k) {
            add(smooth_.data(), middle + k, width, k);
        }
        return smooth_;
    }

private:
    void add(Tensor* sums, Tensor const* parts, std::int64_t count, std::int64_t k) const {
        double const weight = half_[k < 0 ? -k : k];
        for (std::int64_t c = 0; c < count; ++c) {
            Tensor part = parts[c];
            part *= weight;
            sums[c] += part;
        }
    }

    Band const& band_;
    std::vector<double> const& half_;
    std::int64_t reach_;
    std::vector<Tensor> along_columns_; ///< and reach_ reflected ones on either side
    std::vector<Tensor> smooth_;
};

double anisotropy(Raster<float> const& dem, double window_m, Run const& run) {
    double const window = window_m / dem.grid().cell_m; // cells
    if (!(window >= 1.0) || 2.0 * border_windows * window >= static_cast<double>(std::min(dem.width(), dem.height()))) {
        return too_small;
    }
    auto const side = std::max<std::int64_t>(static_cast<std::int64_t>(window / blocks_a_window), 1);
    auto const cells = static_cast<double>(side);
    Blocks const blocks(dem, side);
    auto const inside = [&](std::int64_t place, std::int64_t count) {
        double const centre = (static_cast<double>(place) + 0.5) * cells;
        return centre >= border_windows * window && centre <= static_cast<double>(count) - border_windows * window;
    };
    std::vector<double> const half = half_of_window(window / cells);
    std::int64_t const reach = std::ssize(half) - 1;
    constexpr std::int64_t rows_at_once = 512; // what is smooth lives no longer
    constexpr double none = -1.0;
    Products sum;
    for (std::int64_t from = 0; from < blocks.height(); from += rows_at_once) {
        std::int64_t const rows = std::min(rows_at_once, blocks.height() - from);
        std::vector<double> found(rows * blocks.width(), none);
        Band const band(blocks, std::max<std::int64_t>(from - reach, 0), std::min(from + rows + reach, blocks.height()),
                        run);
        parallel_ranges(run, rows, 16, [&](std::int64_t begin, std::int64_t end) {
            Smoother smoother(band, half);
            for (std::int64_t row = from + begin; row < from + end; ++row) {
                run.check();
                std::vector<Tensor> const& of = smoother.row(row);
                for (std::int64_t c = 0; c < blocks.width(); ++c) {
                    Tensor const& t = of[c];
                    if (t.weight > least_weight && t.xx + t.yy > 0.0 && inside(c, dem.width()) &&
                        inside(row, dem.height())) {
                        found[(row - from) * blocks.width() + c] =
                            std::sqrt((t.xx - t.yy) * (t.xx - t.yy) + 4.0 * t.xy * t.xy) / (t.xx + t.yy);
                    }
                }
            }
        });
        for (double const share : found) {
            if (share != none) {
                sum.sum += share;
                ++sum.pairs;
            }
        }
    }
    return sum.mean();
}

struct Channels {
    flow::FlowField const& drainage;
    StraightChannelsParams const& params;
    Raster<float> const* dem = nullptr; ///< tells level water; null: there is none

    bool contains(std::int64_t cell) const {
        return drainage.area_cells[cell] >= params.support_cells && goes_on(drainage.direction[cell]) &&
               !is_level_water(cell);
    }

    /// As high as all its neighbours: the way of the water across a lake is the router's choice.
    bool is_level_water(std::int64_t cell) const {
        if (dem == nullptr) {
            return false;
        }
        Cell const at = dem->grid().at(cell);
        return std::ranges::all_of(d8_steps, [&](Cell step) {
            Cell const beside{at.col + step.col, at.row + step.row};
            return dem->grid().contains(beside) && (*dem)[beside] == (*dem)[cell];
        });
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

std::int64_t run_from(Channels const& channels, std::int64_t cell) {
    flow::FlowField const& drainage = channels.drainage;
    flow::Direction const direction = drainage.direction[cell];
    std::int64_t steps = 0;
    for (std::int64_t at = cell; at >= 0 && drainage.direction[at] == direction && !channels.is_level_water(at);
         at = drainage.receiver(at)) {
        ++steps;
    }
    return steps;
}

/// Collects the cells of a reach; fewer than its steps and one more if the water ends or becomes a lake.
void walk(Channels const& channels, std::int64_t cell, std::vector<Cell>& reach) {
    flow::FlowField const& drainage = channels.drainage;
    reach.clear();
    for (std::int64_t at = cell; at >= 0 && !channels.is_level_water(at); at = drainage.receiver(at)) {
        reach.push_back(drainage.grid().at(at));
        if (static_cast<std::int64_t>(reach.size()) > channels.params.reach_steps || !goes_on(drainage.direction[at])) {
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
            row.longest_run = std::max(row.longest_run, run_from(channels, cell));
        }
        walk(channels, cell, reach);
        if (static_cast<std::int64_t>(reach.size()) > channels.params.reach_steps) {
            ++row.reaches;
            row.straight += is_straight(reach, channels.params.tolerance_cells) ? 1 : 0;
        }
    }
    return row;
}

StraightChannels straight(Channels const& channels, Run const& run) {
    constexpr char const* self = "measure.straight_channels";
    StraightChannelsParams const& params = channels.params;
    require_in(self, "support_cells", params.support_cells, Range::at_least(1));
    require_in(self, "reach_steps", params.reach_steps, Range::at_least(2));
    require_in(self, "tolerance_cells", params.tolerance_cells, Range::at_least(0.0));
    RowOfReaches const all = sum_rows(run, channels.drainage.grid().height, [&](std::int64_t r) {
        run.check();
        return row_of(channels, r);
    });
    StraightChannels found{all.longest_run, all.reaches};
    if (all.reaches > 0) {
        found.straight_share = static_cast<double>(all.straight) / static_cast<double>(all.reaches);
    }
    return found;
}

} // namespace

GradientTexture gradient_texture(Raster<float> const& dem, GradientTextureParams const& params, Run const& run) {
    require_in("measure.gradient_texture", "window_m", params.window_m, Range::above(0.0));
    GradientTexture found;
    found.correlation.fill(too_small);
    if (dem.width() < 2 || dem.height() < 2) {
        return found;
    }
    refuse_if<BadInput>(!(dem.grid().cell_m > 0.0), "measure.gradient_texture",
                        "the DEM's cells have a side of {} m; it must be greater than 0", dem.grid().cell_m);
    found.correlation = correlations(dem, run);
    found.anisotropy = anisotropy(dem, params.window_m, run);
    return found;
}

StraightChannels straight_channels(flow::FlowField const& drainage, StraightChannelsParams const& params,
                                   Run const& run) {
    return straight({drainage, params}, run);
}

StraightChannels straight_channels(flow::FlowField const& drainage, Raster<float> const& dem,
                                   StraightChannelsParams const& params, Run const& run) {
    require_same_grid(dem.grid(), drainage.grid(), "measure.straight_channels", "the DEM and its drainage",
                      "drain this DEM");
    return straight({drainage, params, &dem}, run);
}

} // namespace thalweg::measure
