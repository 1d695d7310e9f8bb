// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/forest/coast.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/growth/dla/internal/walk.hpp>

namespace thalweg::growth {
namespace {

constexpr std::uint64_t island_stage = 0x69736c616e643031; // "island01"
constexpr double share_of_land = 0.42;                     // of the grid

/// One octave of gradient noise, its lattice rotated and shifted at random.
class Octave {
public:
    Octave(double wave_cells, double amplitude, std::uint64_t seed, std::uint64_t number, double span_cells)
        : amplitude_(amplitude) {
        auto const words = random_block(seed, island_stage, number);
        double const turn = 2.0 * portable::pi * unit(words[0]);
        along_ = {portable::cos(turn) / wave_cells, portable::sin(turn) / wave_cells};
        // The lattice covers the span at any rotation.
        half_ = static_cast<std::int64_t>(std::ceil(span_cells / wave_cells)) + 2;
        offset_ = {unit(words[1]), unit(words[2])};
        auto const side = static_cast<std::uint64_t>(2 * half_ + 1);
        for (std::uint64_t i = 0; i < side * side; ++i) {
            double const angle = 2.0 * portable::pi * unit(random_word(seed, island_stage, number, 1, i));
            gradients_.push_back({portable::cos(angle), portable::sin(angle)});
        }
    }

    double at(double x, double y) const {
        double const u = along_.x * x - along_.y * y + offset_.x;
        double const v = along_.y * x + along_.x * y + offset_.y;
        double const col = std::floor(u);
        double const row = std::floor(v);
        double const fu = u - col;
        double const fv = v - row;
        auto const i = static_cast<std::int64_t>(col);
        auto const j = static_cast<std::int64_t>(row);
        double const su = fade(fu);
        double const sv = fade(fv);
        double const north = mix(slope(i, j, fu, fv), slope(i + 1, j, fu - 1.0, fv), su);
        double const south = mix(slope(i, j + 1, fu, fv - 1.0), slope(i + 1, j + 1, fu - 1.0, fv - 1.0), su);
        return amplitude_ * mix(north, south, sv);
    }

private:
    static double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
    static double mix(double a, double b, double t) { return a + t * (b - a); }
    double slope(std::int64_t i, std::int64_t j, double fu, double fv) const {
        Vec2 const g = gradients_[(j + half_) * (2 * half_ + 1) + i + half_];
        return g.x * fu + g.y * fv;
    }

    double amplitude_;
    Vec2 along_;
    Vec2 offset_;
    std::int64_t half_ = 0;
    std::vector<Vec2> gradients_;
};

/// Octaves, each half as long as the previous one and nearly half as strong.
std::vector<Octave> octaves(double longest_cells, double shortest_cells, std::uint64_t seed, std::uint64_t first,
                            double span_cells) {
    constexpr double fall = 0.56;
    std::vector<Octave> all;
    double amplitude = 1.0;
    for (double wave = longest_cells; wave >= shortest_cells; wave *= 0.5) {
        all.emplace_back(wave, amplitude, seed, first + all.size(), span_cells);
        amplitude *= fall;
    }
    return all;
}

double sum(std::vector<Octave> const& noise, double x, double y) {
    double total = 0.0;
    for (Octave const& octave : noise) {
        total += octave.at(x, y);
    }
    return total;
}

/// The 4-connected cells of one value around a cell; marks them as seen.
std::vector<std::int64_t> patch_from(std::int64_t start, Mask const& land, Mask& seen) {
    Grid const& grid = land.grid();
    std::vector<std::int64_t> cells{start};
    seen[start] = 1;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        Cell const c = grid.at(cells[k]);
        for (Site const o : neighbour_offsets) {
            Cell const next{c.col + o.x, c.row + o.y};
            if (grid.contains(next) && seen[next] == 0 && land[next] == land[c]) {
                seen[next] = 1;
                cells.push_back(grid.index(next));
            }
        }
    }
    return cells;
}

/// The highest cells that make up a share of the grid.
Mask highest(Raster<float> const& heights, double share) {
    std::vector<float> sorted(heights.values().begin(), heights.values().end());
    auto const level = sorted.begin() + static_cast<std::ptrdiff_t>((1.0 - share) * static_cast<double>(sorted.size()));
    std::ranges::nth_element(sorted, level);
    Mask found(heights.grid());
    for (std::int64_t i = 0; i < heights.cells(); ++i) {
        found[i] = heights[i] >= *level && std::isfinite(heights[i]) ? 1 : 0;
    }
    return found;
}

/// Turns lagoons into land and small islets into sea.
void tidy(Mask& land) {
    Grid const& grid = land.grid();
    for (std::uint8_t const value : {std::uint8_t{0}, std::uint8_t{1}}) {
        std::int64_t const least = value == 0 ? grid.cells() : grid.cells() / 1000;
        Mask seen(grid, 0);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (land[i] != value || seen[i] != 0) {
                continue;
            }
            std::vector<std::int64_t> const patch = patch_from(i, land, seen);
            bool const open_sea = value == 0 && patch.front() == 0; // the margin contains the grid's first cell
            if (!open_sea && static_cast<std::int64_t>(patch.size()) < least) {
                for (std::int64_t const c : patch) {
                    land[c] = value == 0 ? 1 : 0;
                }
            }
        }
    }
}

constexpr std::uint64_t outlet_stage = 0x6f75746c65747331; // "outlets1"
constexpr double least_apart_cells = 3.0;

/// Share of land in a window around a cell; cells at the border continue beyond it.
double land_around(Mask const& land, Cell c) {
    constexpr std::int64_t reach = 8;
    std::int64_t count = 0;
    for (std::int64_t row = c.row - reach; row <= c.row + reach; ++row) {
        for (std::int64_t col = c.col - reach; col <= c.col + reach; ++col) {
            Cell const at{std::clamp<std::int64_t>(col, 0, land.width() - 1),
                          std::clamp<std::int64_t>(row, 0, land.height() - 1)};
            count += land[at] != 0;
        }
    }
    constexpr double window = (2.0 * reach + 1.0) * (2.0 * reach + 1.0);
    return static_cast<double>(count) / window;
}

/// A coast cell with its turn and the distance it keeps from others.
struct Candidate {
    double turn = 0.0;
    double keeps = 0.0; ///< factor of the mean distance
    Cell cell;
};

/// In order of selection: earlier where land surrounds them.
std::vector<Candidate> candidates(Mask const& land, std::vector<Cell> const& coast, std::uint64_t seed) {
    std::vector<Candidate> all;
    all.reserve(coast.size());
    for (Cell const c : coast) {
        auto const words =
            random_block(seed, outlet_stage, static_cast<std::uint64_t>(c.col), static_cast<std::uint64_t>(c.row));
        double const around = land_around(land, c);
        double const weight = around * around * around;
        all.push_back({-portable::log(1.0 - unit(words[0])) / weight, 0.3 + 0.6 * unit(words[1]), c});
    }
    std::ranges::stable_sort(all, {}, &Candidate::turn);
    return all;
}

/// The selected outlets by position.
class SelectedOutlets {
public:
    explicit SelectedOutlets(double widest) : side_(static_cast<std::int64_t>(std::ceil(widest)) + 1) {}

    void add(Candidate const& c) { blocks_[key(c.cell.col / side_, c.cell.row / side_)].push_back(c); }

    bool far_enough(Candidate const& wanted, double mean) const {
        Cell const c = wanted.cell;
        for (std::int64_t row = c.row / side_ - 1; row <= c.row / side_ + 1; ++row) {
            for (std::int64_t col = c.col / side_ - 1; col <= c.col / side_ + 1; ++col) {
                auto const at = blocks_.find(key(col, row));
                if (at != blocks_.end() && std::ranges::any_of(at->second, [&](Candidate const& o) {
                        auto const dx = static_cast<double>(o.cell.col - c.col);
                        auto const dy = static_cast<double>(o.cell.row - c.row);
                        double const apart = std::max(mean * std::max(wanted.keeps, o.keeps), least_apart_cells);
                        return dx * dx + dy * dy < apart * apart;
                    })) {
                    return false;
                }
            }
        }
        return true;
    }

private:
    static std::int64_t key(std::int64_t col, std::int64_t row) { return (row + 1) * (std::int64_t{1} << 32) + col; }

    std::int64_t side_;
    std::unordered_map<std::int64_t, std::vector<Candidate>> blocks_;
};

} // namespace

Mask shape_island(Grid const& grid, IslandParams const& params, Run const& run) {
    require_in("growth.shape_island", "ruggedness", params.ruggedness, Range::between(0.0, 1.0));
    refuse_if<BadInput>(std::min(grid.width, grid.height) < 16, "growth.shape_island",
                        "the grid has {} x {} cells, an island needs 16 x 16", grid.width, grid.height);
    auto const width = static_cast<double>(grid.width);
    auto const height = static_cast<double>(grid.height);
    double const shorter = std::min(width, height);
    double const margin = std::max(1.0, shorter / 40.0);
    constexpr double shortest = 8.0; // cells
    double const span = 0.5 * std::sqrt(width * width + height * height) + shorter;
    std::vector<Octave> const moves = octaves(0.6 * shorter, shortest, params.seed, 0, span);
    std::vector<Octave> const bends_x = octaves(0.7 * shorter, 0.05 * shorter, params.seed, 32, span);
    std::vector<Octave> const bends_y = octaves(0.7 * shorter, 0.05 * shorter, params.seed, 64, span);
    double const bend = 0.35 * params.ruggedness * shorter;
    Vec2 const middle{sum(bends_x, 0.0, 0.0), sum(bends_y, 0.0, 0.0)};
    // Islands are longer than wide, in any direction.
    auto const words = random_block(params.seed, island_stage, 96);
    double const turn = portable::pi * unit(words[0]);
    double const slender = 1.0 + 0.5 * unit(words[1]) * params.ruggedness;
    Vec2 const along{portable::cos(turn), portable::sin(turn)};

    Raster<float> above(grid, -std::numeric_limits<float>::infinity());
    parallel_ranges(run, grid.height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < grid.width; ++col) {
                double const x = static_cast<double>(col) + 0.5 - 0.5 * width;
                double const y = static_cast<double>(row) + 0.5 - 0.5 * height;
                double const to_edge = std::min(0.5 * width - std::fabs(x), 0.5 * height - std::fabs(y));
                if (to_edge < margin) {
                    continue;
                }
                double const bent_x = x + bend * (sum(bends_x, x, y) - middle.x);
                double const bent_y = y + bend * (sum(bends_y, x, y) - middle.y);
                double const u = 2.0 * bent_x / width;
                double const v = 2.0 * bent_y / height;
                double const length = along.x * u + along.y * v;
                double const breadth = slender * (along.x * v - along.y * u);
                double const oval = std::sqrt(length * length + breadth * breadth);
                // Near the margin the sea dominates, so that the margin never cuts the coast straight.
                double const sea = 1.0 - std::min(1.0, (to_edge - margin) / (0.15 * shorter));
                above[Cell{col, row}] =
                    static_cast<float>(params.ruggedness * sum(moves, bent_x, bent_y) - oval - 0.8 * sea * sea * sea);
            }
        }
    });
    Mask land = highest(above, share_of_land);
    tidy(land);
    return land;
}

std::vector<Cell> coast_cells(Mask const& land) {
    std::vector<Cell> coast;
    Grid const& grid = land.grid();
    for (std::int64_t row = 0; row < grid.height; ++row) {
        auto const here = land.row(row);
        bool const edge = row == 0 || row == grid.height - 1;
        auto const above = land.row(edge ? row : row - 1);
        auto const below = land.row(edge ? row : row + 1);
        for (std::int64_t col = 0; col < grid.width; ++col) {
            if (here[col] != 0 && (edge || col == 0 || col == grid.width - 1 || here[col - 1] == 0 ||
                                   here[col + 1] == 0 || above[col] == 0 || below[col] == 0)) {
                coast.push_back({col, row});
            }
        }
    }
    return coast;
}

std::vector<Cell> spread_outlets(Mask const& land, std::vector<Cell> const& coast, SpreadOutletsParams const& params,
                                 Run const& run) {
    refuse_if<BadParameter>(params.count < 0, "growth.spread_outlets",
                            "count is {}, it must be at least 1, or 0 for as many as the coast is long", params.count);
    require_in("growth.spread_outlets", "every_cells", params.every_cells, Range::above(0.0));
    refuse_if<BadInput>(coast.empty(), "growth.spread_outlets", "there is no coast on which a river could end");
    auto const length = static_cast<double>(coast.size());
    auto const wanted = params.count > 0 ? static_cast<std::size_t>(params.count)
                                         : static_cast<std::size_t>(std::ceil(length / params.every_cells));
    std::vector<Candidate> const all = candidates(land, coast, params.seed);
    std::vector<Cell> outlets;
    // A pass selects cells that keep the distance; if these are too few, the next pass reduces it.
    double mean = length / static_cast<double>(wanted);
    SelectedOutlets taken(std::max(mean, least_apart_cells));
    for (;; mean *= 0.7) {
        run.check();
        for (Candidate const& c : all) {
            if (outlets.size() == wanted) {
                return outlets;
            }
            if (taken.far_enough(c, mean)) {
                taken.add(c);
                outlets.push_back(c.cell);
            }
        }
        if (mean < least_apart_cells) {
            return outlets;
        }
    }
}

} // namespace thalweg::growth
