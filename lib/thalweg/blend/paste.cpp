// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/paste.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <thalweg/blend/internal/region.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>

namespace thalweg::blend {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// [cells] rounding of coordinates in the millions of metres.
constexpr double snap = 1e-6;

/// A position on the source in columns and rows; whole numbers are cell centres.
struct Place {
    double col;
    double row;
};

double snapped(double v) {
    double const whole = std::floor(v + 0.5);
    return std::fabs(v - whole) <= snap ? whole : v;
}

// Cells without data that are connected to the source's edge: beyond its outline, not holes in it.
Mask beyond_outline(Raster<float> const& source) {
    Grid const& grid = source.grid();
    Mask beyond(grid);
    std::vector<Cell> reached;
    auto const take = [&](Cell c) {
        if (grid.contains(c) && beyond[c] == 0 && std::isnan(source[c])) {
            beyond[c] = 1;
            reached.push_back(c);
        }
    };
    for (std::int64_t col = 0; col < grid.width; ++col) {
        take({col, 0});
        take({col, grid.height - 1});
    }
    for (std::int64_t row = 0; row < grid.height; ++row) {
        take({0, row});
        take({grid.width - 1, row});
    }
    while (!reached.empty()) {
        Cell const c = reached.back();
        reached.pop_back();
        take({c.col - 1, c.row});
        take({c.col + 1, c.row});
        take({c.col, c.row - 1});
        take({c.col, c.row + 1});
    }
    return beyond;
}

std::int64_t count(Mask const& mask, Run const& run) {
    return sum_rows(run, mask.height(), [&](std::int64_t r) {
        return static_cast<std::int64_t>(std::ranges::count_if(mask.row(r), [](std::uint8_t m) { return m != 0; }));
    });
}

/// The transformation between target and source.
class Placement {
public:
    Placement(Raster<float> const& source, SourceWindow const& window, PlacePatchParams const& params)
        : source_(source), beyond_(beyond_outline(source)), window_(window),
          middle_{static_cast<double>(window.col) + 0.5 * static_cast<double>(window.width - 1),
                  static_cast<double>(window.row) + 0.5 * static_cast<double>(window.height - 1)},
          cosine_(portable::cos(params.rotate_deg * (portable::pi / 180.0))),
          sine_(portable::sin(params.rotate_deg * (portable::pi / 180.0))),
          cell_m_(params.scale * source.grid().cell_m) {
        Grid const& grid = source.grid();
        at_ = params.at.value_or(
            Vec2{grid.west + (middle_.col + 0.5) * grid.cell_m, grid.north - (middle_.row + 0.5) * grid.cell_m});
    }

    Place on_source(Vec2 p) const {
        double const east = (p.x - at_.x) / cell_m_;
        double const north = (p.y - at_.y) / cell_m_;
        return {snapped(middle_.col + (cosine_ * east + sine_ * north)),
                snapped(middle_.row - (cosine_ * north - sine_ * east))};
    }

    Vec2 on_target(Place place) const {
        double const east = (place.col - middle_.col) * cell_m_;
        double const north = (middle_.row - place.row) * cell_m_;
        return {at_.x + (cosine_ * east - sine_ * north), at_.y + (sine_ * east + cosine_ * north)};
    }

    bool on_lattice(Place p) const {
        if (!(p.col >= 0.0 && p.row >= 0.0 && p.col <= static_cast<double>(source_.width() - 1) &&
              p.row <= static_cast<double>(source_.height() - 1))) {
            return false;
        }
        auto const col = static_cast<std::int64_t>(p.col);
        auto const row = static_cast<std::int64_t>(p.row);
        std::int64_t const east = static_cast<double>(col) < p.col ? col + 1 : col;
        std::int64_t const south = static_cast<double>(row) < p.row ? row + 1 : row;
        return (beyond_[{col, row}] | beyond_[{east, row}] | beyond_[{col, south}] | beyond_[{east, south}]) == 0;
    }

    bool in_window(Place p) const {
        auto const within = [](double v, std::int64_t first, std::int64_t count) {
            double const cell = std::floor(v + (0.5 + snap));
            return cell >= static_cast<double>(first) && cell < static_cast<double>(first + count);
        };
        return within(p.col, window_.col, window_.width) && within(p.row, window_.row, window_.height);
    }

    /// p: a position on the lattice.
    double height(Place p) const {
        Cell const cell{static_cast<std::int64_t>(p.col), static_cast<std::int64_t>(p.row)};
        double const x = p.col - static_cast<double>(cell.col);
        double const y = p.row - static_cast<double>(cell.row);
        double const north = along_row(cell, x);
        if (y == 0.0) {
            return north;
        }
        double const south = along_row({cell.col, cell.row + 1}, x);
        return north + y * (south - north);
    }

    /// The window's corners on the target.
    std::array<Vec2, 4> corners() const {
        double const west = static_cast<double>(window_.col) - 0.5;
        double const north = static_cast<double>(window_.row) - 0.5;
        double const east = west + static_cast<double>(window_.width);
        double const south = north + static_cast<double>(window_.height);
        return {on_target({west, north}), on_target({east, north}), on_target({east, south}), on_target({west, south})};
    }

private:
    double along_row(Cell cell, double x) const {
        double const west = source_[cell];
        return x == 0.0 ? west : west + x * (static_cast<double>(source_[{cell.col + 1, cell.row}]) - west);
    }

    Raster<float> const& source_;
    Mask beyond_;
    SourceWindow window_;
    Place middle_;
    double cosine_;
    double sine_;
    double cell_m_; // side of a source's cell on the target
    Vec2 at_;
};

void check(PlacePatchParams const& params) {
    require_in("blend.place_patch", "rotation", params.rotate_deg, Range::between(-360.0, 360.0), "degrees");
    require_in("blend.place_patch", "scale", params.scale, Range::above(0.0));
    require_in("blend.place_patch", "gain", params.gain, Range::finite());
    if (params.at && (!std::isfinite(params.at->x) || !std::isfinite(params.at->y))) {
        throw BadParameter("blend.place_patch",
                           fmt::format("a patch at ({}, {}); give finite coordinates", params.at->x, params.at->y));
    }
}

SourceWindow window_of(Raster<float> const& source, PlacePatchParams const& params) {
    SourceWindow const w = params.window.value_or(SourceWindow{0, 0, source.width(), source.height()});
    refuse_if<BadInput>(
        w.col < 0 || w.row < 0 || w.width < 1 || w.height < 1 || w.width > source.width() ||
            w.height > source.height() || w.col > source.width() - w.width || w.row > source.height() - w.height,
        "blend.place_patch",
        "a window of {} x {} cells at column {}, row {} of a source of {} x {} cells; it lies within the source",
        w.width, w.height, w.col, w.row, source.width(), source.height());
    return w;
}

/// Cells that the window may touch, and their neighbours.
struct Span {
    std::int64_t first_col;
    std::int64_t end_col;
    std::int64_t first_row;
    std::int64_t end_row;
};

Span span_of(Placement const& placement, Grid const& target) {
    auto const clamped = [](double v, std::int64_t most) {
        return !(v > 0.0) ? 0 : v >= static_cast<double>(most) ? most : static_cast<std::int64_t>(v);
    };
    double west = std::numeric_limits<double>::infinity();
    double east = -west;
    double south = west;
    double north = -west;
    for (Vec2 const& p : placement.corners()) {
        west = std::min(west, p.x);
        east = std::max(east, p.x);
        south = std::min(south, p.y);
        north = std::max(north, p.y);
    }
    return {clamped((west - target.west) / target.cell_m - 2.0, target.width),
            clamped((east - target.west) / target.cell_m + 3.0, target.width),
            clamped((target.north - north) / target.cell_m - 2.0, target.height),
            clamped((target.north - south) / target.cell_m + 3.0, target.height)};
}

[[noreturn]] void refuse_empty(Placement const& placement, SourceWindow const& window, Grid const& target,
                               bool has_part) {
    auto const corners = placement.corners();
    throw BadInput(
        "blend.place_patch",
        fmt::format(
            "the patch of {} x {} source cells with its corners at ({:.3f}, {:.3f}), ({:.3f}, {:.3f}), ({:.3f}, "
            "{:.3f}) and ({:.3f}, {:.3f}) covers no cell{} of the target, which reaches from ({:.3f}, {:.3f}) to "
            "({:.3f}, {:.3f}), that has all its neighbours on the source: move it or take a larger one",
            window.width, window.height, corners[0].x, corners[0].y, corners[1].x, corners[1].y, corners[2].x,
            corners[2].y, corners[3].x, corners[3].y, has_part ? " of the mask" : "", target.west, target.south(),
            target.east(), target.north));
}

using solver::fixed_cell;
using solver::free_cell;
using solver::outside_cell;

void check(Raster<float> const& target, Patch const& patch, PasteParams const& params) {
    require_in("blend.paste", "feather", params.feather_cells, Range::between(0.0, 1e6), "cells");
    auto const require = [&](Grid const& grid, char const* what) {
        refuse_if<BadInput>(
            grid != target.grid(), "blend.paste",
            "{} of {} x {} cells from ({}, {}) for a target of {} x {} cells from ({}, {}): they share a grid", what,
            grid.width, grid.height, grid.west, grid.north, target.width(), target.height(), target.grid().west,
            target.grid().north);
    };
    require(patch.mask.grid(), "a mask");
    require(patch.z.grid(), "a patch");
    if (params.keep.cells() > 0) {
        require(params.keep.grid(), "cells to keep");
    }
}

// Also counts the cells of the mask that do not change.
Mask changes_of(Patch const& patch, PasteParams const& params, PastedDem& pasted) {
    Mask changes(patch.mask.grid());
    for (std::int64_t i = 0; i < changes.cells(); ++i) {
        if (patch.mask[i] == 0) {
            continue;
        }
        if (std::isinf(patch.z[i])) {
            Cell const c = changes.grid().at(i);
            throw BadInput("blend.paste",
                           fmt::format("the patch's height at column {}, row {} is infinite", c.col, c.row));
        }
        bool const kept = params.keep.cells() > 0 && params.keep[i] != 0;
        bool const hole = std::isnan(patch.z[i]);
        pasted.kept += kept ? 1 : 0;
        pasted.holes += hole ? 1 : 0;
        changes[i] = !kept && (!hole || params.holes == Holes::fill) ? 1 : 0;
    }
    return changes;
}

Raster<double> cut_out(Raster<double> const& z, EditRegion const& edit_region) {
    Raster<double> part(edit_region.kind.grid());
    for (std::int64_t row = 0; row < part.height(); ++row) {
        std::ranges::copy(
            z.row(row + edit_region.corner.row)
                .subspan(static_cast<std::size_t>(edit_region.corner.col), static_cast<std::size_t>(part.width())),
            part.row(row).begin());
    }
    return part;
}

// The patch's heights; where missing the target's; where missing too, their mean.
Raster<double> carrier_of(Raster<double> const& source, EditRegion const& edit_region) {
    Raster<double> carrier = source;
    double sum = 0.0;
    double count = 0.0;
    for (std::int64_t i = 0; i < carrier.cells(); ++i) {
        if (edit_region.kind[i] == fixed_cell) {
            sum += edit_region.target[i];
            count += 1.0;
        }
    }
    for (std::int64_t i = 0; i < carrier.cells(); ++i) {
        if (std::isnan(carrier[i])) {
            carrier[i] = std::isnan(edit_region.target[i]) ? sum / count : edit_region.target[i];
        }
    }
    return carrier;
}

/// The differences that the pasted terrain should have.
class WantedDifferences {
public:
    WantedDifferences(Raster<double> const& source, EditRegion const& edit_region, PasteParams const& params,
                      Run const& run)
        : source_(source), edit_region_(edit_region), relief_(params.relief), feather_(params.feather_cells) {
        if (feather_ > 0.0) {
            Mask changes(edit_region.kind.grid());
            for (std::int64_t i = 0; i < changes.cells(); ++i) {
                // Cells outside have no heights to take differences from.
                changes[i] = edit_region.kind[i] == fixed_cell ? 0 : 1;
            }
            distance_ = distance_within(changes, run);
        }
    }

    double operator()(std::int64_t here, std::int64_t there) const {
        double const own = edit_region_.target[there] - edit_region_.target[here];
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
    EditRegion const& edit_region_;
    Relief relief_;
    double feather_;
    Raster<float> distance_;
};

bool has_gap(Raster<double> const& source, EditRegion const& edit_region) {
    for (std::int64_t i = 0; i < source.cells(); ++i) {
        if (edit_region.kind[i] != outside_cell && std::isnan(source[i])) {
            return true;
        }
    }
    return false;
}

// Empty if the differences are the patch's own, which leaves Laplace's equation.
Guidance guidance_of(Raster<double> const& source, EditRegion const& edit_region, PasteParams const& params,
                     Run const& run) {
    if (params.relief == Relief::source && params.feather_cells == 0.0 && !has_gap(source, edit_region)) {
        return {};
    }
    WantedDifferences const wanted(source, edit_region, params, run);
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

Seam seam_of(Raster<double> const& z, EditRegion const& edit_region) {
    Seam seam;
    std::int64_t const width = z.width();
    auto const meet = [&](std::int64_t a, std::int64_t b) {
        bool const is_seam = (edit_region.kind[a] == free_cell && edit_region.kind[b] == fixed_cell) ||
                             (edit_region.kind[a] == fixed_cell && edit_region.kind[b] == free_cell);
        double const own = edit_region.target[a] - edit_region.target[b];
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

Patch place_patch(Raster<float> const& source, Grid const& target, PlacePatchParams const& params, Run const& run) {
    check(params);
    SourceWindow const window = window_of(source, params);
    bool const has_part = params.part.cells() > 0;
    if (has_part) {
        require_same_grid(params.part.grid(), target, "blend.place_patch", "the mask and the target",
                          "they share a grid");
    }
    std::int64_t const wanted = has_part ? count(params.part, run) : 0;
    refuse_if<BadInput>(has_part && wanted == 0, "blend.place_patch", "the mask holds no cell of the target");
    Placement const placement(source, window, params);
    Patch patch{Mask(target), Raster<double>(target, not_a_number)};
    Span const span = span_of(placement, target);
    auto const on_lattice = [&](Cell c) {
        return !target.contains(c) || placement.on_lattice(placement.on_source(target.centre(c)));
    };
    parallel_ranges(run, std::max<std::int64_t>(span.end_row - span.first_row, 0), 8,
                    [&](std::int64_t begin, std::int64_t end) {
                        for (std::int64_t row = span.first_row + begin; row < span.first_row + end; ++row) {
                            for (std::int64_t col = span.first_col; col < span.end_col; ++col) {
                                Cell const c{col, row};
                                Place const place = placement.on_source(target.centre(c));
                                if (!placement.on_lattice(place)) {
                                    continue;
                                }
                                patch.z[c] = params.gain * placement.height(place);
                                bool const asked = (!has_part || params.part[c] != 0) && placement.in_window(place);
                                patch.mask[c] = asked && on_lattice({col - 1, row}) && on_lattice({col + 1, row}) &&
                                                        on_lattice({col, row - 1}) && on_lattice({col, row + 1})
                                                    ? 1
                                                    : 0;
                            }
                        }
                    });
    std::int64_t const covered = count(patch.mask, run);
    if (covered == 0) {
        refuse_empty(placement, window, target, has_part);
    }
    patch.outside = has_part ? wanted - covered : 0;
    return patch;
}

PastedDem paste(Raster<float> const& target, Patch const& patch, PasteParams const& params, Run const& run) {
    check(target, patch, params);
    PastedDem pasted;
    EditRegion const edit_region = edit_region_of(target, changes_of(patch, params, pasted), {}, "blend.paste", run);
    Raster<double> const source = cut_out(patch.z, edit_region);
    Guidance const guidance = guidance_of(source, edit_region, params, run);
    solver::PoissonParams solving;
    solving.tolerance = params.tolerance;
    auto const solution =
        solve_guided(edit_region.kind, edit_region.target, carrier_of(source, edit_region), guidance, solving, run);
    Seam const seam = seam_of(solution.value, edit_region);
    pasted.dem = target;
    for (std::int64_t i = 0; i < edit_region.kind.cells(); ++i) {
        if (edit_region.kind[i] == free_cell) {
            Cell const c = edit_region.kind.grid().at(i);
            pasted.dem[{c.col + edit_region.corner.col, c.row + edit_region.corner.row}] =
                static_cast<float>(solution.value[i]);
        }
    }
    pasted.cells = edit_region.cells;
    pasted.seam_max_m = seam.max;
    pasted.seam_rms_m = seam.pairs > 0.0 ? std::sqrt(seam.squares / seam.pairs) : 0.0;
    pasted.iterations = solution.iterations;
    pasted.residual = solution.residual;
    return pasted;
}

} // namespace thalweg::blend
