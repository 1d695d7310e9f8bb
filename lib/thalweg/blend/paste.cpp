// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/paste.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/blend/internal/distance_within.hpp>
#include <thalweg/blend/internal/follow.hpp>
#include <thalweg/blend/internal/opening.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>

namespace thalweg::blend {
namespace {

using solver::fixed_cell;
using solver::free_cell;
using solver::outside_cell;

void check(Raster<float> const& target, Patch const& patch, PasteParams const& params) {
    require_in("blend.paste", "feather", params.feather_cells, Range::between(0.0, 1e6), "cells");
    auto const require = [&](Grid const& grid, char const* what) {
        if (grid != target.grid()) {
            throw BadInput(fmt::format("blend.paste: {} of {} x {} cells from ({}, {}) for a target of {} x {} cells "
                                       "from ({}, {}): they share a grid",
                                       what, grid.width, grid.height, grid.west, grid.north, target.width(),
                                       target.height(), target.grid().west, target.grid().north));
        }
    };
    require(patch.mask.grid(), "a mask");
    require(patch.z.grid(), "a patch");
    if (params.keep.cells() > 0) {
        require(params.keep.grid(), "cells to keep");
    }
}

// Counts what of the mask does not change, too.
Mask changes_of(Patch const& patch, PasteParams const& params, Pasted& pasted) {
    Mask changes(patch.mask.grid());
    for (std::int64_t i = 0; i < changes.cells(); ++i) {
        if (patch.mask[i] == 0) {
            continue;
        }
        if (std::isinf(patch.z[i])) {
            Cell const c = changes.grid().at(i);
            throw BadInput(
                fmt::format("blend.paste: the patch's height at column {}, row {} is infinite", c.col, c.row));
        }
        bool const kept = params.keep.cells() > 0 && params.keep[i] != 0;
        bool const hole = std::isnan(patch.z[i]);
        pasted.kept += kept ? 1 : 0;
        pasted.holes += hole ? 1 : 0;
        changes[i] = !kept && (!hole || params.holes == Holes::fill) ? 1 : 0;
    }
    return changes;
}

Raster<double> cut_out(Raster<double> const& z, Opening const& opening) {
    Raster<double> part(opening.kind.grid());
    for (std::int64_t row = 0; row < part.height(); ++row) {
        std::ranges::copy(
            z.row(row + opening.corner.row)
                .subspan(static_cast<std::size_t>(opening.corner.col), static_cast<std::size_t>(part.width())),
            part.row(row).begin());
    }
    return part;
}

// The patch; where it has no height the target's; where that has none either, a mean.
Raster<double> carrier_of(Raster<double> const& source, Opening const& opening) {
    Raster<double> carrier = source;
    double sum = 0.0;
    double count = 0.0;
    for (std::int64_t i = 0; i < carrier.cells(); ++i) {
        if (opening.kind[i] == fixed_cell) {
            sum += opening.target[i];
            count += 1.0;
        }
    }
    for (std::int64_t i = 0; i < carrier.cells(); ++i) {
        if (std::isnan(carrier[i])) {
            carrier[i] = std::isnan(opening.target[i]) ? sum / count : opening.target[i];
        }
    }
    return carrier;
}

/// The differences the pasted land shall have.
class Wanted {
public:
    Wanted(Raster<double> const& source, Opening const& opening, PasteParams const& params, Run const& run)
        : source_(source), opening_(opening), relief_(params.relief), feather_(params.feather_cells) {
        if (feather_ > 0.0) {
            Mask changes(opening.kind.grid());
            for (std::int64_t i = 0; i < changes.cells(); ++i) {
                // What is outside keeps no height that the land could differ from.
                changes[i] = opening.kind[i] == fixed_cell ? 0 : 1;
            }
            distance_ = distance_within(changes, run);
        }
    }

    double operator()(std::int64_t here, std::int64_t there) const {
        double const own = opening_.target[there] - opening_.target[here];
        double const patch = source_[there] - source_[here];
        if (std::isnan(patch)) {
            return std::isnan(own) ? 0.0 : own;
        }
        if (std::isnan(own)) {
            return patch;
        }
        double const taken = relief_ == Relief::mixed && std::fabs(own) > std::fabs(patch) ? own : patch;
        return feather_ > 0.0 ? own + weight(here, there) * (taken - own) : taken;
    }

private:
    double weight(std::int64_t here, std::int64_t there) const {
        double const middle = 0.5 * (static_cast<double>(distance_[here]) + static_cast<double>(distance_[there]));
        double const t = std::min(middle / feather_, 1.0);
        return t * t * (3.0 - 2.0 * t);
    }

    Raster<double> const& source_;
    Opening const& opening_;
    Relief relief_;
    double feather_;
    Raster<float> distance_;
};

bool has_gap(Raster<double> const& source, Opening const& opening) {
    for (std::int64_t i = 0; i < source.cells(); ++i) {
        if (opening.kind[i] != outside_cell && std::isnan(source[i])) {
            return true;
        }
    }
    return false;
}

// None where the differences are the patch's own: then Laplace's equation is left.
Guidance guidance_of(Raster<double> const& source, Opening const& opening, PasteParams const& params, Run const& run) {
    if (params.relief == Relief::source && params.feather_cells == 0.0 && !has_gap(source, opening)) {
        return {};
    }
    Wanted const wanted(source, opening, params, run);
    Guidance guidance{Raster<double>(source.grid()), Raster<double>(source.grid())};
    std::int64_t const width = source.width();
    parallel_ranges(run, source.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin * width; i < end * width; ++i) {
            guidance.east[i] = i % width + 1 < width ? wanted(i, i + 1) : 0.0;
            guidance.south[i] = i + width < source.cells() ? wanted(i, i + width) : 0.0;
        }
    });
    return guidance;
}

struct Seam {
    double max = 0.0;
    double squares = 0.0;
    double pairs = 0.0;
};

Seam seam_of(Raster<double> const& z, Opening const& opening) {
    Seam seam;
    std::int64_t const width = z.width();
    auto const meet = [&](std::int64_t a, std::int64_t b) {
        bool const is_seam = (opening.kind[a] == free_cell && opening.kind[b] == fixed_cell) ||
                             (opening.kind[a] == fixed_cell && opening.kind[b] == free_cell);
        double const own = opening.target[a] - opening.target[b];
        if (!is_seam || std::isnan(own)) {
            return;
        }
        double const jump = std::fabs(z[a] - z[b]) - std::fabs(own);
        seam.max = std::max(seam.max, jump);
        seam.squares += jump * jump;
        seam.pairs += 1.0;
    };
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        if (i % width + 1 < width) {
            meet(i, i + 1);
        }
        if (i + width < z.cells()) {
            meet(i, i + width);
        }
    }
    return seam;
}

} // namespace

Pasted paste(Raster<float> const& target, Patch const& patch, PasteParams const& params, Run const& run) {
    check(target, patch, params);
    Pasted pasted;
    Opening const opening = open_target(target, changes_of(patch, params, pasted), {}, "blend.paste", run);
    Raster<double> const source = cut_out(patch.z, opening);
    Guidance const guidance = guidance_of(source, opening, params, run);
    solver::PoissonParams solving;
    solving.tolerance = params.tolerance;
    auto const solution = follow(opening.kind, opening.target, carrier_of(source, opening), guidance, solving, run);
    Seam const seam = seam_of(solution.value, opening);
    pasted.dem = target;
    for (std::int64_t i = 0; i < opening.kind.cells(); ++i) {
        if (opening.kind[i] == free_cell) {
            Cell const c = opening.kind.grid().at(i);
            pasted.dem[{c.col + opening.corner.col, c.row + opening.corner.row}] =
                static_cast<float>(solution.value[i]);
        }
    }
    pasted.cells = opening.cells;
    pasted.seam_max_m = seam.max;
    pasted.seam_rms_m = seam.pairs > 0.0 ? std::sqrt(seam.squares / seam.pairs) : 0.0;
    pasted.iterations = solution.iterations;
    pasted.residual = solution.residual;
    return pasted;
}

} // namespace thalweg::blend
