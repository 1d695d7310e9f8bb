// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/check_targets.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>

namespace thalweg::fractal {

namespace {

void check_range(char const* what, std::optional<double> const& value, double above, double below,
                 char const* unit = "") {
    if (value) {
        require_in("fractal.match_statistics", what, *value, Range::inside(above, below), unit);
    }
}

void check_extreme(Raster<float> const& dem, char const* what, std::optional<FixedHeight> const& extreme) {
    if (!extreme) {
        return;
    }
    Cell const cell = extreme->cell;
    if (!dem.grid().contains(cell)) {
        throw BadParameter(fmt::format(
            "fractal.match_statistics: the {} at column {}, row {} lies off the grid of {} x {} cells; columns "
            "and rows count from 0",
            what, cell.col, cell.row, dem.width(), dem.height()));
    }
    if (std::isnan(dem[cell])) {
        throw BadParameter(
            fmt::format("fractal.match_statistics: the {} at column {}, row {} lies in a hole; give a cell with data",
                        what, cell.col, cell.row));
    }
    check_range(what, extreme->z, -1e9, 1e9, "m");
}

} // namespace

void check_targets(Raster<float> const& dem, Targets const& targets) {
    check_extreme(dem, "highest point", targets.max);
    check_extreme(dem, "lowest point", targets.min);
    check_range("mean", targets.mean, -1e9, 1e9, "m");
    check_range("deviation", targets.std, 0.0, 1e9, "m");
    check_range("correlation length lx", targets.lx_cells, 0.0, 1e9, "cells");
    check_range("correlation length ly", targets.ly_cells, 0.0, 1e9, "cells");
    check_range("slope", targets.slope_rad, 0.0, portable::pi / 2.0, "rad");
    check_range("fractal dimension", targets.dimension, 2.0, 3.0);
    double const infinity = std::numeric_limits<double>::infinity();
    double const max = targets.max ? targets.max->z : infinity;
    double const min = targets.min ? targets.min->z : -infinity;
    if (targets.max && targets.min && targets.max->cell == targets.min->cell) {
        throw BadParameter(
            fmt::format("fractal.match_statistics: the highest and the lowest point are both at column {}, row {}",
                        targets.max->cell.col, targets.max->cell.row));
    }
    if (!(min < max)) {
        throw BadParameter(fmt::format(
            "fractal.match_statistics: the lowest point of {} m is not below the highest of {} m", min, max));
    }
    if (targets.mean && !(min < *targets.mean && *targets.mean < max)) {
        throw BadParameter(fmt::format(
            "fractal.match_statistics: a mean of {} m is not between the lowest point of {} m and the highest "
            "of {} m",
            *targets.mean, min, max));
    }
    if (!targets.max || !targets.min) {
        return;
    }
    double const mean = targets.mean.value_or((max + min) / 2.0); // where the bound is widest
    double const most = std::sqrt((max - mean) * (mean - min));
    if (targets.std && *targets.std > most) {
        throw BadParameter(fmt::format(
            "fractal.match_statistics: heights between {} m and {} m{} cannot have a deviation of {} m; the most "
            "is {:.3f} m (Bhatia and Davis)",
            min, max, targets.mean ? fmt::format(" with a mean of {} m", mean) : "", *targets.std, most));
    }
}

std::vector<FixedHeight> kept_heights(Raster<float> const& dem, Targets const& targets,
                                      std::vector<FixedHeight> const& fixed) {
    std::vector<FixedHeight> kept;
    std::map<std::int64_t, double> seen;
    auto const keep = [&](FixedHeight const& one) {
        Cell const cell = one.cell;
        if (!dem.grid().contains(cell) || std::isnan(dem[cell]) || !std::isfinite(one.z)) {
            throw BadInput(
                fmt::format("fractal.match_statistics: the fixed height of {} m at column {}, row {} is not finite, "
                            "or lies off the grid or in a hole; leave it out",
                            one.z, cell.col, cell.row));
        }
        auto const [at, fresh] = seen.emplace(dem.grid().index(cell), one.z);
        if (fresh) {
            kept.push_back(one);
        } else if (at->second != one.z) {
            throw BadInput(fmt::format("fractal.match_statistics: the cell at column {}, row {} has two target "
                                       "heights, {} m and {} m; give one",
                                       cell.col, cell.row, at->second, one.z));
        }
    };
    for (auto const& extreme : {targets.max, targets.min}) {
        if (extreme) {
            keep(*extreme);
        }
    }
    std::for_each(fixed.begin(), fixed.end(), keep);
    if (kept.size() > most_fixed) {
        throw BadInput(
            fmt::format("fractal.match_statistics: {} heights are fixed; at most {} can be kept, so thin them out",
                        kept.size(), most_fixed));
    }
    return kept;
}

} // namespace thalweg::fractal
