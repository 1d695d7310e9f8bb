// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/condition.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/flow/internal/condition.hpp>

namespace thalweg::flow {

void check_drainable(Raster<float> const& dem, Valley const& valley, Run const& run) {
    Grid const& grid = dem.grid();
    refuse_if<BadInput>(grid.cells() == 0, "flow.condition", "the land has no cells");
    require_same_grid(valley.z.grid(), grid, "flow.condition", "the valley and the land", "make both on one grid");
    std::atomic<bool> all_fit = true;
    parallel_ranges(run, grid.cells(), cells_between_checks, [&](std::int64_t begin, std::int64_t end) {
        float const* const land = dem.values().data();
        float const* const river = valley.z.values().data();
        int misfits = 0;
        for (std::int64_t i = begin; i < end; ++i) {
            misfits |= static_cast<int>(std::isinf(land[i])) |
                       (static_cast<int>(std::isnan(land[i])) & static_cast<int>(!std::isnan(river[i])));
        }
        if (misfits != 0) {
            all_fit.store(false, std::memory_order_relaxed);
        }
    });
    for (std::int64_t i = 0; !all_fit && i < grid.cells(); ++i) {
        if (std::isinf(dem[i]) || (std::isnan(dem[i]) && !std::isnan(valley.z[i]))) {
            Cell const cell = grid.at(i);
            throw BadInput("flow.condition", fmt::format("the height at column {}, row {} is {}", cell.col, cell.row,
                                                         std::isinf(dem[i]) ? "infinite; mark cells without data as NaN"
                                                                            : "missing, where a river runs"));
        }
    }
}

Raster<float> fill(Raster<float> const& dem, Valley const& valley, Run const& run) {
    check_drainable(dem, valley, run);
    return flooded(dem, valley.z, Lakes::slope, run);
}

namespace {

/// The float at or next above a height.
float rounded_up(double z) {
    auto const near = static_cast<float>(z);
    return static_cast<double>(near) < z ? just_above(near) : near;
}

enum class Banked : std::uint8_t { all, too_low };

/// Calls visit(cell, least) for each cell of land, or each that is too low, beside a river cell: the least height [m]
/// that keeps that cell's water in the river.
template <class Visit>
void each_bank(Banked banks, Raster<float> const& dem, Raster<float> const& valley, double margin_m, Run const& run,
               Visit visit) {
    Grid const& grid = dem.grid();
    auto const offsets = d8_offsets(grid);
    constexpr float no_bank = std::numeric_limits<float>::infinity();
    auto const look_around = [&](Cell at) {
        std::int64_t const i = grid.index(at);
        float const here = valley[i];
        std::array<float, 8> river{};
        if (!grid.on_border(at)) {
            for (std::size_t k = 0; k < river.size(); ++k) {
                river[k] = valley[i + offsets[k]];
            }
        } else {
            river.fill(no_bank);
            for (std::size_t k = 0; k < river.size(); ++k) {
                Cell const n{at.col + d8_steps[k].col, at.row + d8_steps[k].row};
                if (grid.contains(n)) {
                    river[k] = valley[n];
                }
            }
        }
        double slope = 0.0; // [m/cell] the steepest to a lower river neighbour
        float lowest = here;
        for (std::size_t k = 0; k < river.size(); ++k) {
            float const lower = river[k] < here ? river[k] : here; // never NaN
            slope = std::max(slope, (static_cast<double>(here) - static_cast<double>(lower)) * d8_per_length[k]);
            lowest = std::min(lowest, lower);
        }
        std::array<float, 2> least{}; // of direct and of diagonal neighbours
        for (std::size_t k = 0; k < least.size(); ++k) {
            double const bank =
                slope > 0.0 ? std::max<double>(lowest, static_cast<double>(here) - slope / d8_per_length[k]) : here;
            least[k] = std::max(rounded_up(bank + margin_m), just_above(static_cast<float>(bank)));
        }
        for (std::size_t k = 0; k < river.size(); ++k) {
            float const z = dem[i + (std::isnan(river[k]) ? offsets[k] : 0)];
            bool const is_asked = banks == Banked::all ? !std::isnan(z) : z < least[k % 2];
            if (std::isnan(river[k]) & is_asked) { // one jump, which can be foreseen
                visit(i + offsets[k], least[k % 2]);
            }
        }
    };
    for (std::int64_t r = 0; r < grid.height; ++r) {
        if (r % 1024 == 0) {
            run.check();
        }
        auto const row = valley.row(r);
        constexpr std::size_t together = 16; // most land is far from rivers
        for (std::size_t begin = 0; begin < row.size(); begin += together) {
            std::size_t const end = std::min(begin + together, row.size());
            int any = 0;
            for (std::size_t c = begin; c < end; ++c) {
                any |= static_cast<int>(!std::isnan(row[c]));
            }
            for (std::size_t c = begin; any != 0 && c < end; ++c) {
                if (!std::isnan(row[c])) {
                    look_around({static_cast<std::int64_t>(c), r});
                }
            }
        }
    }
}

struct HeightOfCell {
    CellIndex cell = 0;
    float z = 0.0F; ///< [m]
};

/// As change_between(), from a list of the cells that were raised; of several heights of a cell the lowest counts.
DemChange change_of(std::vector<HeightOfCell> raised, Raster<float> const& after) {
    std::sort(raised.begin(), raised.end(), [](HeightOfCell const& a, HeightOfCell const& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.z < b.z;
    });
    DemChange change;
    double const cell_m2 = after.grid().cell_m * after.grid().cell_m;
    double raised_m = 0.0; // by row, as there
    for (std::size_t k = 0; k < raised.size(); ++k) {
        auto const [cell, z] = raised[k];
        if (k > 0 && raised[k - 1].cell == cell) {
            continue;
        }
        if (k > 0 && raised[k - 1].cell / after.width() != cell / after.width()) {
            change.raised_m3 += raised_m * cell_m2;
            raised_m = 0.0;
        }
        double const rise = static_cast<double>(after[cell]) - static_cast<double>(z);
        ++change.raised_cells;
        change.max_raise_m = std::max(change.max_raise_m, rise);
        raised_m += rise;
    }
    change.raised_m3 += raised_m * cell_m2;
    return change;
}

/// The heights that keep rivers in their channels, of all cells beside them.
SparseHeights least_of_banks(Raster<float> const& dem, Raster<float> const& valley, double margin_m, Run const& run) {
    std::vector<HeightOfCell> all;
    each_bank(Banked::all, dem, valley, margin_m, run, [&](CellIndex i, float z) { all.push_back({i, z}); });
    std::ranges::sort(all, [](HeightOfCell const& a, HeightOfCell const& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.z > b.z;
    });
    SparseHeights least;
    for (HeightOfCell const& one : all) {
        if (least.cell.empty() || least.cell.back() != one.cell) { // the greatest
            least.cell.push_back(one.cell);
            least.z.push_back(one.z);
        }
    }
    return least;
}

Valley no_rivers(Grid const& grid) {
    return {Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
}

} // namespace

Banks confine_channels(Raster<float> const& dem, Valley const& valley, RaiseBanksParams const& params, Run const& run) {
    refuse_if<BadParameter>(!(params.margin_m >= 0.0 && params.margin_m < 1e6), "flow.confine_channels",
                            "margin {} m; give one from 0", params.margin_m);
    Grid const& grid = dem.grid();
    require_same_grid(valley.z.grid(), grid, "flow.confine_channels", "the valley and the land",
                      "make both on one grid");
    Banks banks{dem, Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
    each_bank(Banked::all, dem, valley.z, params.margin_m, run, [&](CellIndex i, float least) {
        if (!(banks.least[i] >= least)) {
            banks.least[i] = least;
            banks.dem[i] = std::max(banks.dem[i], least);
        }
    });
    return banks;
}

DemChange change_between(Raster<float> const& before, Raster<float> const& after) {
    require_same_grid(before.grid(), after.grid(), "flow.change_between", "the DEMs before and after",
                      "resample one to the cells of the other");
    DemChange change;
    double const cell_m2 = before.grid().cell_m * before.grid().cell_m;
    for (std::int64_t r = 0; r < before.height(); ++r) {
        auto const was = before.row(r);
        auto const is = after.row(r);
        double raised_m = 0.0; // per row, so that a large sum does not absorb small changes
        double cut_m = 0.0;
        for (std::size_t c = 0; c < was.size(); ++c) {
            double const rise = static_cast<double>(is[c]) - static_cast<double>(was[c]);
            if (rise > 0.0) {
                ++change.raised_cells;
                change.max_raise_m = std::max(change.max_raise_m, rise);
                raised_m += rise;
            } else if (rise < 0.0) {
                ++change.cut_cells;
                change.max_cut_m = std::max(change.max_cut_m, -rise);
                cut_m -= rise;
            }
        }
        change.raised_m3 += raised_m * cell_m2;
        change.cut_m3 += cut_m * cell_m2;
    }
    return change;
}

ConditionedDem condition(Raster<float> dem, Valley const& valley, ConditionParams const& params, Run const& run) {
    ConditionedDem out;
    if (params.method == Conditioning::none) {
        out.dem = std::move(dem);
        return out;
    }
    check_drainable(dem, valley, run);
    double const margin_m = RaiseBanksParams{}.margin_m;
    std::vector<HeightOfCell> raised;
    each_bank(Banked::too_low, dem, valley.z, margin_m, run, [&](CellIndex i, float least) {
        raised.push_back({i, dem[i]});
        dem[i] = least;
    });
    out.banks = change_of(std::move(raised), dem);
    if (undrained_cells(dem, valley.z, run).empty()) {
        out.dem = std::move(dem);
        return out;
    }
    if (params.method == Conditioning::fill) {
        out.dem = flooded(dem, valley.z, Lakes::slope, run);
    } else {
        out.dem = carve_depressions(dem, valley, least_of_banks(dem, valley.z, margin_m, run), run);
    }
    out.depressions = change_between(dem, out.dem);
    return out;
}

Raster<float> fill_depressions(Raster<float> const& dem, FillDepressionsParams const& params, Run const& run) {
    Valley const none = no_rivers(dem.grid());
    check_drainable(dem, none, run);
    return flooded(dem, none.z, params.level ? Lakes::level : Lakes::slope, run);
}

Raster<float> breach_depressions(Raster<float> const& dem, Run const& run) {
    Valley const none = no_rivers(dem.grid());
    return carve(dem, none, none.z, run);
}

} // namespace thalweg::flow
