// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/forest/coast.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <unordered_map>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t outlet_stage = 0x6f75746c65747331; // "outlets1"
constexpr double least_apart_cells = 3.0;

/// Share of land in a window around a cell; beyond the grid it goes on as in the cell that is nearest.
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

/// A cell of the coast, when its turn comes, and how far it keeps others away.
struct Candidate {
    double turn = 0.0;
    double keeps = 0.0; ///< share of the mean distance
    Cell cell;
};

/// In the order in which they are taken: earlier where land surrounds them.
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

/// The outlets taken, found by where they lie.
class Taken {
public:
    explicit Taken(double widest) : side_(static_cast<std::int64_t>(std::ceil(widest)) + 1) {}

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

std::vector<Cell> coast_cells(Mask const& land) {
    std::vector<Cell> coast;
    Grid const& grid = land.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        bool const at_sea = grid.on_border(c) || land[Cell{c.col - 1, c.row}] == 0 ||
                            land[Cell{c.col + 1, c.row}] == 0 || land[Cell{c.col, c.row - 1}] == 0 ||
                            land[Cell{c.col, c.row + 1}] == 0;
        if (land[i] != 0 && at_sea) {
            coast.push_back(c);
        }
    }
    return coast;
}

std::vector<Cell> spread_outlets(Mask const& land, std::vector<Cell> const& coast, SpreadOutletsParams const& params,
                                 Run const& run) {
    if (params.count < 0) {
        throw BadParameter(fmt::format("network.spread_outlets: count is {}, it must be at least 1, or 0 for as many "
                                       "as the coast is long",
                                       params.count));
    }
    require_in("network.spread_outlets", "every_cells", params.every_cells, Range::above(0.0));
    if (coast.empty()) {
        throw BadInput("network.spread_outlets: there is no coast on which a river could end");
    }
    auto const length = static_cast<double>(coast.size());
    auto const wanted = params.count > 0 ? static_cast<std::size_t>(params.count)
                                         : static_cast<std::size_t>(std::ceil(length / params.every_cells));
    std::vector<Candidate> const all = candidates(land, coast, params.seed);
    std::vector<Cell> outlets;
    // A pass takes what keeps its distance; where that leaves too few, the next asks for less.
    double mean = length / static_cast<double>(wanted);
    Taken taken(std::max(mean, least_apart_cells));
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

} // namespace thalweg::network
