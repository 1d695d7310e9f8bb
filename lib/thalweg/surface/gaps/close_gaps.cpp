// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/gaps/close_gaps.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::surface {
namespace {

constexpr char const* closing = "surface.close_gaps";
constexpr std::size_t steps_between_checks = 1U << 18U;

/// Visits cells that are connected with some, each once; take(cell) decides and marks.
template <class Take> void spread(std::vector<Cell> open, Grid const& grid, int step, Take take, Run const& run) {
    for (std::size_t visited = 0; !open.empty(); ++visited) {
        if (visited % steps_between_checks == 0) {
            run.check();
        }
        Cell const c = open.back();
        open.pop_back();
        for (std::size_t k = 0; k < d8_steps.size(); k += static_cast<std::size_t>(step)) {
            Cell const next{c.col + d8_steps[k].col, c.row + d8_steps[k].row};
            if (grid.contains(next) && take(next)) {
                open.push_back(next);
            }
        }
    }
}

constexpr int by_corners = 1; // all eight neighbours
constexpr int by_sides = 2;   // four of them

template <class Visit> void along_border(Grid const& grid, Visit visit) {
    for (std::int64_t col = 0; col < grid.width; ++col) {
        visit(Cell{col, 0});
        visit(Cell{col, grid.height - 1});
    }
    for (std::int64_t row = 0; row < grid.height; ++row) {
        visit(Cell{0, row});
        visit(Cell{grid.width - 1, row});
    }
}

/// Cells without data that are connected with the border.
Mask rim_of(Raster<float> const& dem, Run const& run) {
    Mask rim(dem.grid(), 0);
    std::vector<Cell> open;
    auto const take = [&](Cell c) {
        bool const is_new = std::isnan(dem[c]) && rim[c] == 0;
        rim[c] = is_new ? 1 : rim[c];
        return is_new;
    };
    along_border(dem.grid(), [&](Cell c) {
        if (take(c)) {
            open.push_back(c);
        }
    });
    spread(std::move(open), dem.grid(), by_corners, take, run);
    return rim;
}

/// Cells at or below the level of the sea that are connected with the border or the rim.
Mask sea_of(Raster<float> const& dem, Mask const& rim, double level_m, Run const& run) {
    Mask sea(dem.grid(), 0);
    std::vector<Cell> open;
    auto const take = [&](Cell c) {
        bool const is_new = sea[c] == 0 && dem[c] <= level_m;
        sea[c] = is_new ? 1 : sea[c];
        return is_new;
    };
    auto const begin = [&](Cell c) {
        if (take(c)) {
            open.push_back(c);
        }
    };
    along_border(dem.grid(), begin);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (rim[i] != 0) {
            cells_around(dem.grid(), dem.grid().at(i), 1, begin);
        }
    }
    spread(std::move(open), dem.grid(), by_sides, take, run);
    return sea;
}

/// Fills the marked cells from the nearest ones that have a height.
void fill_from_nearest(Raster<float>& dem, Mask const& gaps, Run const& run) {
    Mask known(dem.grid(), 0);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        known[i] = std::isnan(dem[i]) ? 0 : 1;
    }
    Raster<std::int64_t> const nearest = nearest_cells(known, run);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (gaps[i] != 0) {
            dem[i] = dem[nearest[i]];
        }
    }
}

/// The cells of a gap, and the lowest height beside it.
struct Hole {
    std::vector<Cell> cells;
    float shore_m = std::numeric_limits<float>::infinity();
};

Hole hole_at(Cell first, Raster<float> const& dem, Mask& seen, Run const& run) {
    Hole hole{{first}, std::numeric_limits<float>::infinity()};
    seen[first] = 1;
    spread(
        {first}, dem.grid(), by_corners,
        [&](Cell c) {
            if (!std::isnan(dem[c])) {
                hole.shore_m = std::min(hole.shore_m, dem[c]);
                return false;
            }
            bool const is_new = seen[c] == 0;
            if (is_new) {
                seen[c] = 1;
                hole.cells.push_back(c);
            }
            return is_new;
        },
        run);
    return hole;
}

/// The lowest height; all cells may lack one.
float lowest_in(Raster<float> const& dem) {
    float low = std::numeric_limits<float>::infinity();
    for (float const z : dem.values()) {
        low = z < low ? z : low;
    }
    return low;
}

void note_level(ClosedGaps& out, double z) {
    out.low_m = out.enclosed == 0 ? z : std::min(out.low_m, z);
    out.high_m = out.enclosed == 0 ? z : std::max(out.high_m, z);
}

/// Fills the gaps of a DEM that are not its rim.
/// \param before the DEM as it was given, which out still holds
void fill_enclosed(ClosedGaps& out, Raster<float> const& before, Mask const& rim, EnclosedGaps how, Run const& run) {
    Mask seen = rim;
    Mask gaps(before.grid(), 0);
    float const lowest = lowest_in(before);
    for (std::int64_t i = 0; i < before.cells(); ++i) {
        if (!std::isnan(before[i]) || seen[i] != 0) {
            continue;
        }
        Hole const hole = hole_at(before.grid().at(i), before, seen, run);
        ++out.holes;
        float const level = how == EnclosedGaps::minimum ? lowest : hole.shore_m;
        for (Cell const c : hole.cells) {
            gaps[c] = 1;
            if (how != EnclosedGaps::nearest) {
                out.dem[c] = level;
                note_level(out, level);
            }
            ++out.enclosed;
        }
    }
    if (how == EnclosedGaps::nearest && out.enclosed > 0) {
        fill_from_nearest(out.dem, gaps, run);
        out.enclosed = 0;
        for (std::int64_t i = 0; i < gaps.cells(); ++i) {
            if (gaps[i] != 0) {
                note_level(out, out.dem[i]);
                ++out.enclosed;
            }
        }
    }
}

void cut_rim(ClosedGaps& out, Mask const& rim, Run const& run) {
    Grid const window = largest_rectangle(rim, run);
    refuse_if<BadInput>(window.width < 2 || window.height < 2, closing,
                        "no rectangle of 2 x 2 cells is free of cells without data that are connected with the border: "
                        "fill them from the nearest cells (--rim nearest)");
    Grid const& all = out.dem.grid();
    out.first = all.cell_of(window.centre({0, 0}));
    auto const has_data = [](float z) { return !std::isnan(z); };
    auto const before = std::ranges::count_if(out.dem.values(), has_data);
    out.dem = window_of(out.dem, out.first, window);
    out.cut = before - std::ranges::count_if(out.dem.values(), has_data);
    if (out.sea.cells() > 0) {
        out.sea = window_of(out.sea, out.first, window);
    }
}

void fill_rim(ClosedGaps& out, Mask const& rim, CloseGapsParams const& params, Run const& run) {
    if (params.rim == RimGaps::nearest) {
        fill_from_nearest(out.dem, rim, run);
        return;
    }
    bool const is_sea = params.rim == RimGaps::sea;
    float const level = is_sea ? static_cast<float>(*params.sea_m) : lowest_in(out.dem);
    for (std::int64_t i = 0; i < rim.cells(); ++i) {
        if (rim[i] != 0) {
            out.dem[i] = level;
            if (is_sea) {
                out.sea[i] = 1;
            }
        }
    }
}

} // namespace

Grid largest_rectangle(Mask const& marked, Run const& run) {
    struct Step {
        std::int64_t col = 0; ///< where the columns that are this high begin
        std::int64_t high = 0;
    };
    Grid const& grid = marked.grid();
    std::vector<std::int64_t> high(static_cast<std::size_t>(grid.width), 0); // free cells up to the row
    Cell last;
    std::int64_t wide = 0;
    std::int64_t tall = 0;
    for (std::int64_t row = 0; row < grid.height; ++row) {
        run.check();
        std::vector<Step> steps;
        for (std::int64_t col = 0; col <= grid.width; ++col) {
            std::int64_t now = 0;
            if (col < grid.width) {
                auto& column = high[static_cast<std::size_t>(col)];
                now = column = marked[Cell{col, row}] != 0 ? 0 : column + 1;
            }
            std::int64_t begin = col;
            for (; !steps.empty() && steps.back().high >= now; steps.pop_back()) {
                begin = steps.back().col;
                if (steps.back().high * (col - begin) > wide * tall) {
                    wide = col - begin;
                    tall = steps.back().high;
                    last = {col - 1, row};
                }
            }
            steps.push_back({begin, now});
        }
    }
    Grid out = grid;
    out.width = wide;
    out.height = tall;
    out.west += static_cast<double>(last.col + 1 - wide) * grid.cell_m;
    out.north -= static_cast<double>(last.row + 1 - tall) * grid.cell_m;
    return out;
}

ClosedGaps close_gaps(Raster<float> const& dem, CloseGapsParams const& params, Run const& run) {
    refuse_if<BadInput>(std::ranges::all_of(dem.values(), [](float z) { return std::isnan(z); }), closing,
                        "no cell has a height");
    refuse_if<BadParameter>(params.sea_m && !std::isfinite(*params.sea_m), closing,
                            "the level of the sea is not a number");
    refuse_if<BadParameter>(params.rim == RimGaps::sea && !params.sea_m, closing,
                            "the rim can only lie under a sea whose level is set");
    ClosedGaps out;
    out.dem = dem;
    Mask const rim = rim_of(dem, run);
    out.rim = std::ranges::count(rim.values(), 1);
    if (params.sea_m) {
        out.sea = sea_of(dem, rim, *params.sea_m, run);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            out.dry += out.sea[i] == 0 && dem[i] <= *params.sea_m ? 1 : 0;
        }
    }
    fill_enclosed(out, dem, rim, params.holes, run);
    if (out.rim > 0 && params.rim == RimGaps::cut) {
        cut_rim(out, rim, run);
    } else if (out.rim > 0) {
        fill_rim(out, rim, params, run);
    }
    return out;
}

} // namespace thalweg::surface
