// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/measure.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/make/internal/file_values.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>

namespace thalweg::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr char const* d8 = "d8";
constexpr char const* dinf = "dinf";
constexpr char const* directions = "directions";
constexpr char const* outlines = "catchments";

struct Measured {
    std::string dem;
    std::string network; ///< "": none
};

Measured source_of(MeasureParams const& params) {
    std::error_code ignored;
    Measured source{params.dem, params.network};
    if (fs::is_directory(params.dem, ignored)) {
        source.dem = (fs::path(params.dem) / "dem.tif").string();
        if (fs::path const beside = fs::path(params.dem) / "network.gpkg";
            source.network.empty() && fs::exists(beside, ignored)) {
            source.network = beside.string();
        }
    }
    return source;
}

std::set<std::string> wanted_of(MeasureParams const& params, Measured const& source) {
    std::vector<std::string> const known{d8, dinf, directions, outlines};
    for (std::string const& word : params.what) {
        if (std::find(known.begin(), known.end(), word) == known.end()) {
            throw BadParameter(fmt::format("pipeline.run_measure: unknown measure '{}'; the measures are {}.{}", word,
                                           fmt::join(known, ", "), did_you_mean(word, known)));
        }
    }
    std::set<std::string> wanted(params.what.begin(), params.what.end());
    if (wanted.empty()) {
        wanted = {d8, dinf};
        if (!source.network.empty()) {
            wanted.insert(outlines);
        }
    }
    refuse_if<BadInput>(wanted.contains(outlines) && source.network.empty(),
                        "pipeline.run_measure: catchments need rivers: name a network after the DEM");
    return wanted;
}

/// Powers of two clockwise from the east: the D8 codes of most hydrology programs.
Raster<std::uint8_t> d8_codes(Raster<flow::Direction> const& direction) {
    Raster<std::uint8_t> codes(direction.grid());
    for (std::int64_t i = 0; i < codes.cells(); ++i) {
        flow::Direction const way = direction[i];
        codes[i] = way == flow::Direction::no_data ? io::no_code
                                                   : static_cast<std::uint8_t>(goes_on(way) ? 1 << index_of(way) : 0);
    }
    return codes;
}

/// Radians counterclockwise from the east: Tarboton's D-infinity angles.
Raster<double> dinf_angles(Raster<float> const& bearing) {
    Raster<double> angles(bearing.grid(), std::numeric_limits<double>::quiet_NaN());
    for (std::int64_t i = 0; i < angles.cells(); ++i) {
        auto const eighths = static_cast<double>(bearing[i]);
        if (bearing[i] == flow::dinf_leaves) {
            angles[i] = -1.0;
        } else if (!std::isnan(eighths)) {
            angles[i] = (eighths == 0.0 ? 0.0 : 8.0 - eighths) * (portable::pi / 4.0);
        }
    }
    return angles;
}

double greatest(Raster<double> const& areas) {
    double most = 0.0;
    for (double const area : areas.values()) {
        most = area > most ? area : most; // never NaN
    }
    return most;
}

/// Writes the folder's new files if they are requested.
class Writer {
public:
    Writer(std::string const& folder, std::set<std::string> const& wanted, io::Existing existing)
        : folder_(folder), out_(folder, io::Existing::add, there(folder, wanted, existing)) {}

    std::string path(std::string const& name) {
        names_.push_back(name);
        return out_.path(name);
    }
    /// A file that goes with one of these, and is not listed.
    std::string beside(std::string const& name) const { return out_.path(name); }
    std::vector<std::string> commit() {
        out_.commit();
        std::vector<std::string> files;
        for (std::string const& name : names_) {
            files.push_back((fs::path(folder_) / name).string());
        }
        return files;
    }

private:
    static std::vector<std::string> there(std::string const& folder, std::set<std::string> const& wanted,
                                          io::Existing existing) {
        std::vector<std::string> names;
        for (auto const& [measure, name] : {std::pair{d8, "area_d8.tif"},
                                            {d8, "area_d8.qml"},
                                            {dinf, "area_dinf.tif"},
                                            {dinf, "area_dinf.qml"},
                                            {directions, "direction_d8.tif"},
                                            {directions, "direction_dinf.tif"},
                                            {outlines, "catchments.gpkg"}}) {
            if (wanted.contains(measure) && fs::exists(fs::symlink_status(fs::path(folder) / name))) {
                names.emplace_back(name);
            }
        }
        if (!names.empty() && existing == io::Existing::refuse) {
            throw BadInput(fmt::format("pipeline.run_measure: {} already exists: name another folder or use "
                                       "--overwrite",
                                       (fs::path(folder) / names.front()).string()));
        }
        return names;
    }

    std::string folder_;
    io::OutputFolder out_;
    std::vector<std::string> names_;
};

MeasuredCatchments write_catchments(NetworkFile const& file, flow::FlowField const& drainage, std::string const& path,
                                    Run const& run) {
    FileReaches const rivers = reaches_of_file(file, drainage.direction.grid());
    flow::Catchments const catchments = flow::catchments(rivers.reaches, drainage, run);
    auto const rows = catchment_rows(rivers.reaches, rivers.basins, catchments);
    return {io::write_catchments({catchments.reach, rows}, path, run),
            static_cast<std::int64_t>(rows.size()),
            rivers.cut,
            rivers.outside,
            rivers.nowhere,
            catchments.without};
}

/// QML beside a raster of areas.
std::string style_of_areas(Grid const& grid, double greatest_m2) {
    double const cell_m2 = grid.cell_m * grid.cell_m;
    return io::qml(io::area_style(cell_m2, std::max(cell_m2, greatest_m2)));
}

std::vector<Finding> findings_on(NetworkFile const& file, MeasuredCatchments const& c) {
    std::vector<Finding> findings = file.findings;
    auto const find = [&](FindingKind kind, std::int64_t amount, std::string text) {
        if (amount != 0) {
            findings.push_back({.kind = kind, .amount = static_cast<double>(amount), .text = std::move(text)});
        }
    };
    find("renumbered", file.id_shift, fmt::format("arc_id is the file's and {}", file.id_shift));
    find("arcs_off_dem", c.arcs_cut + c.arcs_outside,
         fmt::format("{} of {} arcs leave the DEM and {} lie outside it", c.arcs_cut, c.arcs, c.arcs_outside));
    find("left_out", c.arcs_nowhere,
         fmt::format("{} arcs have a vertex that is not a number and were left out", c.arcs_nowhere));
    std::int64_t const idle = std::max<std::int64_t>(0, c.arcs - c.arcs_outside - c.count.catchments);
    find("no_catchment", idle, fmt::format("{} arcs have no catchment: other arcs own their cells", idle));
    find("water_without_river", c.cells_without,
         fmt::format("water of {} cells leaves the DEM before it meets a river", c.cells_without));
    return findings;
}

} // namespace

MeasureResult run_measure(MeasureParams const& params, Run const& run) {
    Measured const source = source_of(params);
    auto const wanted = wanted_of(params, source);
    Writer out(params.output, wanted, params.existing);
    io::DemFile const read = io::read_dem_file(source.dem, params.reading, run);
    Raster<float> const& dem = read.dem;
    require_metres(dem.grid(), source.dem, "pipeline.run_measure");
    NetworkFile network;
    if (wanted.contains(outlines)) {
        io::ReadNetworkParams how = params.read;
        how.crs = dem.grid().crs;
        network = io::read_network(source.network, how, run);
        refuse_if<BadInput>(!network.crs.empty() && dem.grid().crs.empty(),
                            "pipeline.run_measure: {} has no CRS, {} is in {:.60}: give the DEM its CRS first "
                            "(gdal_translate -a_srs)",
                            source.dem, source.network, network.crs);
    }

    flow::FlowField const drainage = flow::route(dem, run);
    MeasureResult made;
    made.findings = read.findings;
    made.pits = drainage.pits;
    made.cells = std::count_if(drainage.direction.values().begin(), drainage.direction.values().end(),
                               [](flow::Direction way) { return way != flow::Direction::no_data; });
    made.area_m2 = static_cast<double>(made.cells) * dem.grid().cell_m * dem.grid().cell_m;
    if (wanted.contains(d8)) {
        Raster<double> const areas = areas_m2(drainage);
        made.d8_m2 = greatest(areas);
        io::write_field(areas, out.path("area_d8.tif"), run);
        io::write_text(out.beside("area_d8.qml"), style_of_areas(dem.grid(), made.d8_m2.value_or(0.0)));
    }
    if (wanted.contains(directions)) {
        io::write_codes(d8_codes(drainage.direction), out.path("direction_d8.tif"), run);
    }
    if (wanted.contains(dinf) || wanted.contains(directions)) {
        flow::DinfFlow const parted = flow::route_dinf(dem, drainage, run);
        if (wanted.contains(dinf)) {
            Raster<double> const areas = areas_m2(parted.area_cells);
            made.dinf_m2 = greatest(areas);
            io::write_field(areas, out.path("area_dinf.tif"), run);
            io::write_text(out.beside("area_dinf.qml"), style_of_areas(dem.grid(), made.dinf_m2.value_or(0.0)));
        }
        if (wanted.contains(directions)) {
            io::write_field(dinf_angles(parted.bearing), out.path("direction_dinf.tif"), run);
        }
    }
    if (wanted.contains(outlines)) {
        made.catchments = write_catchments(network, drainage, out.path("catchments.gpkg"), run);
        append(made.findings, findings_on(network, *made.catchments));
    }
    made.files = out.commit();
    run.report(made.findings);
    return made;
}

} // namespace thalweg::pipeline
