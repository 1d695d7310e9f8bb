// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/deform.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/blend/internal/region.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>

namespace thalweg::blend {
namespace {

using solver::free_cell;
using solver::outside_cell;

void check(Raster<float> const& target, Mask const& region, DeformParams const& params) {
    require_in("blend.deform", "scale", params.scale, Range::finite());
    require_same_grid(region.grid(), target.grid(), "blend.deform", "the region and the target", "they share a grid");
}

// Cells with data in the region; infinite ones are rejected.
Mask bendable(Raster<float> const& target, Mask const& region) {
    Mask cells(target.grid());
    for (std::int64_t i = 0; i < target.cells(); ++i) {
        if (region[i] != 0 && std::isinf(target[i])) {
            Cell const c = target.grid().at(i);
            throw BadInput(
                "blend.deform",
                fmt::format("the target's height at column {}, row {} is infinite: correct it", c.col, c.row));
        }
        cells[i] = region[i] != 0 && !std::isnan(target[i]) ? 1 : 0;
    }
    return cells;
}

// Removes each handle's cell from the free cells.
Mask grip(Mask& cells, std::vector<Handle> const& handles, Raster<double>& heights) {
    Mask held(cells.grid());
    for (Handle const& handle : handles) {
        Cell const c = handle.cell;
        auto const refuse = [&](std::string const& why) {
            throw BadInput("blend.deform",
                           fmt::format("the handle at column {}, row {} to {} m {}", c.col, c.row, handle.z, why));
        };
        if (!cells.grid().contains(c)) {
            refuse(fmt::format("lies outside the target of {} x {} cells", cells.width(), cells.height()));
        }
        if (!std::isfinite(static_cast<float>(handle.z))) {
            refuse("is not a height");
        }
        if (held[c] != 0) {
            if (heights[c] != handle.z) {
                refuse(fmt::format("is there already, to {} m: give one of them", heights[c]));
            }
            continue;
        }
        if (cells[c] == 0) {
            refuse("lies in no cell of the region that has a height: move it or widen the region");
        }
        cells[c] = 0;
        held[c] = 1;
        heights[c] = handle.z;
    }
    return held;
}

DeformedDem with_handles_only(Raster<float> const& target, std::vector<Handle> const& handles) {
    DeformedDem deformed;
    deformed.dem = target;
    for (Handle const& handle : handles) {
        deformed.dem[handle.cell] = static_cast<float>(handle.z);
    }
    return deformed;
}

bool is_empty(Mask const& mask) {
    return std::ranges::all_of(mask.values(), [](std::uint8_t m) { return m == 0; });
}

} // namespace

DeformedDem deform(Raster<float> const& target, Mask const& region, std::vector<Handle> const& handles,
                   DeformParams const& params, Run const& run) {
    check(target, region, params);
    Mask free = bendable(target, region);
    Raster<double> pulled(target.grid());
    Mask const held = grip(free, handles, pulled);
    std::int64_t grips = 0;
    for (std::uint8_t const m : held.values()) {
        grips += m;
    }
    DeformedDem deformed = with_handles_only(target, handles);
    deformed.cells = grips;
    if (grips > 0 && is_empty(free)) {
        return deformed;
    }
    EditRegion edit_region = edit_region_of(target, free, held, "blend.deform", run);
    Raster<double> carrier = edit_region.target;
    for (std::int64_t i = 0; i < carrier.cells(); ++i) {
        if (edit_region.kind[i] == outside_cell) {
            continue;
        }
        Cell const c = carrier.grid().at(i);
        Cell const there{c.col + edit_region.corner.col, c.row + edit_region.corner.row};
        carrier[i] *= params.scale;
        if (held[there] != 0) {
            edit_region.target[i] = pulled[there];
        }
    }
    solver::PoissonParams solving;
    solving.tolerance = params.tolerance;
    auto const solution = solve_guided(edit_region.kind, edit_region.target, carrier, {}, solving, run);
    for (std::int64_t i = 0; i < edit_region.kind.cells(); ++i) {
        if (edit_region.kind[i] == free_cell) {
            Cell const c = edit_region.kind.grid().at(i);
            deformed.dem[{c.col + edit_region.corner.col, c.row + edit_region.corner.row}] =
                static_cast<float>(solution.value[i]);
        }
    }
    deformed.cells += edit_region.cells;
    deformed.iterations = solution.iterations;
    deformed.residual = solution.residual;
    return deformed;
}

} // namespace thalweg::blend
