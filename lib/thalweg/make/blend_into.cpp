// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/blend_into.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/recipe/read_inputs.hpp>

namespace thalweg::make {
namespace {

Raster<float> cut(Raster<float> const& source, blend::SourceWindow const& w, std::string const& path) {
    refuse_if<BadInput>(w.col < 0 || w.row < 0 || w.width < 1 || w.height < 1 || w.width > source.width() ||
                            w.height > source.height() || w.col > source.width() - w.width ||
                            w.row > source.height() - w.height,
                        "make.blend_into",
                        "a window of {} x {} cells at column {}, row {} of {}, which has {} x {}; it must lie within",
                        w.width, w.height, w.col, w.row, path, source.width(), source.height());
    Grid frame = source.grid();
    frame.west += static_cast<double>(w.col) * frame.cell_m;
    frame.north -= static_cast<double>(w.row) * frame.cell_m;
    frame.width = w.width;
    frame.height = w.height;
    Raster<float> part(frame);
    for (std::int64_t row = 0; row < w.height; ++row) {
        std::ranges::copy(
            source.row(w.row + row).subspan(static_cast<std::size_t>(w.col), static_cast<std::size_t>(w.width)),
            part.row(row).begin());
    }
    return part;
}

/// The source in metres or in the target's coordinates, and the remaining window.
struct PastedSource {
    Raster<float> dem;
    blend::SourceWindow window;
    bool is_warped = false;
    bool is_elsewhere = false; // its coordinates are unrelated to the target's
    std::vector<Finding> findings = {};
};

/// The coordinates in which a source is placed on the target.
Grid frame_for(Grid const& source, Grid const& target, BlendIntoParams const& params, PastedSource& as) {
    std::string const& whose = params.source.path;
    std::string const target_words = "the target " + params.target;
    bool const is_same = io::same_crs(source.crs, target.crs, whose, target_words);
    bool const is_distorted = io::is_distorted(target); // a metre has its local length
    if ((is_same && !is_distorted) || io::overlap_on_earth(source, target, whose, target_words)) {
        return target;
    }
    if (is_distorted) {
        throw BadInput("make.blend_into",
                       fmt::format("{} does not overlap {}, whose CRS {:.60} has metres of another length there: warp "
                                   "the target first (gdalwarp -novshift -t_srs {:.60})",
                                   whose, target_words, target.crs, io::ground_cell(target).crs));
    }
    refuse_if<BadInput>(io::ground_cell(target).unit != io::GridUnit::metres, "make.blend_into",
                        "{} does not overlap {}, whose cells are not in metres, so its size there is unknown: warp the "
                        "target (gdalwarp -novshift -t_srs)",
                        whose, target_words);
    as.is_elsewhere = true;
    Grid frame = source;
    frame.cell_m = target.cell_m;
    frame.crs = io::metric_crs(source, whose);
    return frame;
}

PastedSource read_source(BlendIntoParams const& params, Grid const& grid, Run const& run) {
    io::DemFile read = io::read_dem_file(params.source, params.reading, run);
    Raster<float> dem = std::move(read.dem);
    PastedSource source;
    source.findings = std::move(read.findings);
    Grid const frame = frame_for(dem.grid(), grid, params, source);
    std::string const& what = params.source.path;
    source.is_warped =
        !io::same_crs(dem.grid().crs, frame.crs, what, "the target") || !io::same_size(dem.grid(), frame);
    if (!source.is_warped) {
        source.window = params.window.value_or(blend::SourceWindow{0, 0, dem.width(), dem.height()});
        source.dem = std::move(dem);
        return source;
    }
    source.dem = io::warp_to_grid(params.window ? cut(dem, *params.window, params.source.path) : dem, frame, what, run);
    source.window = {0, 0, source.dem.width(), source.dem.height()};
    return source;
}

Vec2 middle_of(Grid const& grid, blend::SourceWindow const& w) {
    return {grid.west + (static_cast<double>(w.col) + 0.5 * static_cast<double>(w.width)) * grid.cell_m,
            grid.north - (static_cast<double>(w.row) + 0.5 * static_cast<double>(w.height)) * grid.cell_m};
}

bool overlap(Grid const& source, blend::SourceWindow const& w, Grid const& target) {
    Vec2 const m = middle_of(source, w);
    double const half_width = 0.5 * static_cast<double>(w.width) * source.cell_m;
    double const half_height = 0.5 * static_cast<double>(w.height) * source.cell_m;
    return m.x + half_width > target.west && m.x - half_width < target.east() && m.y + half_height > target.south() &&
           m.y - half_height < target.north;
}

// The position nearest to the middle at which centres of equal cells coincide.
Vec2 target_middle(Grid const& target, blend::SourceWindow const& w) {
    auto const cells = [](std::int64_t of_target, std::int64_t of_source) {
        // NOLINTNEXTLINE(bugprone-integer-division): whole halves
        return static_cast<double>(of_target / 2) + (of_source % 2 != 0 ? 0.5 : 0.0);
    };
    return {target.west + cells(target.width, w.width) * target.cell_m,
            target.north - cells(target.height, w.height) * target.cell_m};
}

} // namespace

BlendedDem blend_into(Raster<float> const& target, Mask keep, BlendIntoParams const& params, Run const& run) {
    Grid const& grid = target.grid();
    refuse_if<BadInput>(params.rotate_deg != 0.0 && io::ground_cell(grid).unit == io::GridUnit::degrees,
                        "make.blend_into",
                        "{} is in degrees, so its cells are not square and a patch cannot be rotated: warp it "
                        "(gdalwarp -novshift -t_srs)",
                        params.target);
    PastedSource const source = read_source(params, grid, run);
    blend::PlacePatchParams placing;
    placing.rotate_deg = params.rotate_deg;
    placing.scale = params.scale;
    placing.gain = params.gain;
    placing.window = source.window;
    placing.part = recipe::read_part(params.mask, grid, run);
    BlendedDem made;
    made.is_warped = source.is_warped;
    made.findings = source.findings;
    if (params.at) {
        placing.at = params.at;
    } else if (!source.is_elsewhere && overlap(source.dem.grid(), source.window, grid)) {
        made.place = PatchPlace::own;
    } else {
        made.place = PatchPlace::middle;
        placing.at = target_middle(grid, source.window);
    }
    made.at = placing.at.value_or(middle_of(source.dem.grid(), source.window));
    blend::PasteParams pasting;
    pasting.relief = params.relief;
    pasting.holes = params.holes;
    pasting.feather_cells = params.feather_cells;
    pasting.keep = std::move(keep);
    run.at(0.0, "blend");
    blend::Patch const patch = blend::place_patch(source.dem, grid, placing, run);
    made.outside = patch.outside;
    made.pasted = blend::paste(target, patch, pasting, run);
    return made;
}

} // namespace thalweg::make
