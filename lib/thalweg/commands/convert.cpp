// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/convert.hpp>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/make/line_sources.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/import/from_file.hpp>
#include <thalweg/network/order/main_stems.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/planform/split_confluences.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::commands {

namespace {

namespace fs = std::filesystem;

/// A network with everything that its tables need.
struct Ready {
    network::FileNetwork source;
    NetworkOrders orders;
    std::vector<double> node_area_m2;
};

/// What the file says of areas.
enum class Areas : std::uint8_t { none, some, all };

Areas areas_of(network::FileNetwork const& source) {
    auto const is_known = [](double a) { return !std::isnan(a); };
    bool const all =
        std::ranges::all_of(source.us_area_m2, is_known) && std::ranges::all_of(source.ds_area_m2, is_known);
    bool const some = std::ranges::any_of(source.ds_area_m2, is_known);
    return all ? Areas::all : some ? Areas::some : Areas::none;
}

/// NaN as files have it.
void mark_unknown(std::vector<double>& areas) {
    for (double& area : areas) {
        area = std::isnan(area) ? -1.0 : area;
    }
}

Raster<float> read_dem(ConvertParams const& params, std::string const& crs, std::vector<Finding>& findings,
                       Run const& run) {
    io::DemFile read = io::read_dem_file(params.dem, params.reading, run);
    append(findings, read.findings);
    Raster<float> dem = std::move(read.dem);
    refuse_if<BadInput>(!io::same_crs(dem.grid().crs, crs, params.dem, params.path), "commands.run_convert",
                        "{} is in {:.60}, {} in {:.60}: warp it (gdalwarp -novshift -t_srs {:.60})", params.dem,
                        dem.grid().crs, params.path, crs, crs);
    return dem;
}

/// Adds what the source lacks: heights, areas.
void complete(Ready& ready, NetworkFile const& file, Raster<float> const* dem, ConvertResult& converted,
              Run const& run) {
    network::FileNetwork& source = ready.source;
    if (!file.says.heights) {
        converted.heights = dem != nullptr ? "dem" : "none";
        if (dem != nullptr) {
            source.network = network::drape(source.network.planform, *dem);
        } else {
            std::ranges::fill(source.network.node_z, 0.0);
            for (auto& z : source.network.arc_z) {
                std::ranges::fill(z, 0.0);
            }
        }
    }
    Areas const areas_in_file = areas_of(source);
    if (areas_in_file != Areas::all && dem != nullptr) {
        converted.areas = "d8";
        flow::ContributingAreas areas = flow::areas_d8(source.network.planform, flow::route(*dem, run), run);
        source.us_area_m2 = std::move(areas.us_area_m2);
        source.ds_area_m2 = std::move(areas.ds_area_m2);
        ready.node_area_m2 = std::move(areas.node_m2);
    } else {
        converted.areas = areas_in_file == Areas::none ? "none" : "file";
        mark_unknown(source.us_area_m2);
        mark_unknown(source.ds_area_m2);
        ready.node_area_m2 = make::node_areas(source.network.planform, source.us_area_m2, source.ds_area_m2);
    }
}

void split(Ready& ready, ConvertParams const& params, ConvertResult& converted, Run const& run) {
    network::FileNetwork& source = ready.source;
    network::Split made =
        network::split_confluences(source.network, {params.max_upstream, params.split_distance_m}, run);
    converted.split = static_cast<std::int64_t>(made.pieces.size());
    make::add_pieces(made.pieces, source.us_area_m2, source.ds_area_m2);
    for (network::SplitPiece const& piece : made.pieces) {
        source.braided.push_back(source.braided[piece.of]);
        source.own_area_m2[piece.of] = std::numeric_limits<double>::quiet_NaN(); // of both together
        source.own_area_m2.push_back(source.own_area_m2[piece.of]);
        source.records.push_back(source.records[piece.of]);
        source.clues.arcs.push_back(source.clues.arcs[piece.of]);
    }
    source.stretches = make::LineSources(source.network.planform, source.stretches).redrawn(made.network.planform);
    source.network = std::move(made.network);
    ready.node_area_m2 = make::node_areas(source.network.planform, source.us_area_m2, source.ds_area_m2);
}

/// The grid of a mask: the DEM's, or one around the network.
Grid grid_of(StreamNetwork const& plan, ConvertParams const& params, Raster<float> const* dem, std::string const& crs) {
    if (dem != nullptr) {
        return dem->grid();
    }
    refuse_if<BadParameter>(!(params.cell_m > 0.0), "commands.run_convert",
                            "a raster needs cells: give --dem or --cell");
    RiverLines lines{{}, crs, params.path, false};
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        RiverLine line;
        for (Vec2 const p : plan.arc(arc).line) {
            line.vertices.push_back({p.x, p.y, 0.0});
        }
        lines.lines.push_back(std::move(line));
    }
    recipe::GridRecipe wanted;
    wanted.cell_m = params.cell_m;
    return recipe::frame_lines(lines, wanted);
}

/// The stem common to the files of one network: NAME of NAME_arcs.dbf.
std::string common_name(fs::path const& file) {
    std::string const stem = file.stem().string();
    for (std::string const layer : {"_arcs", "_nodes"}) {
        if (stem.ends_with(layer)) {
            return stem.substr(0, stem.size() - layer.size());
        }
    }
    return stem;
}

/// Whether an existing file may belong to the network being read. Decided without GDAL: opening some formats leaves
/// files beside them.
bool may_be_read(fs::path const& file, fs::path const& source) {
    std::error_code ignored;
    if (!fs::exists(file, ignored) || !fs::exists(source, ignored)) { // or it is a database
        return false;
    }
    fs::path const folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (fs::is_directory(source, ignored)) {
        return fs::equivalent(folder, source, ignored);
    }
    fs::path const own = source.has_parent_path() ? source.parent_path() : fs::path(".");
    auto const kind = [](fs::path const& f) {
        std::string const ending = f.extension().string();
        return ending == ".shx" || ending == ".dbf" || ending == ".prj" || ending == ".cpg" ? ".shp" : ending;
    };
    return fs::equivalent(file, source, ignored) ||
           (fs::equivalent(folder, own, ignored) && common_name(file) == common_name(source) &&
            kind(file) == kind(source));
}

/// Throws BadInput if an output would replace the input.
void require_other(std::vector<std::string> const& files, fs::path const& folder, std::string const& source) {
    for (std::string const& file : files) {
        if (may_be_read(folder / file, source)) {
            throw BadInput("commands.run_convert",
                           fmt::format("{} may be the input: name another output", (folder / file).string()));
        }
    }
}

class ConvertOutput {
public:
    explicit ConvertOutput(ConvertParams const& params) : params_(params), database_(io::is_postgis(params.output)) {
        std::string const& output = params.output;
        if (database_) {
            refuse_if<BadInput>(output == params.path && params.existing == io::Existing::replace,
                                "commands.run_convert",
                                "the output is the input database: name another table and leave out --overwrite");
            return;
        }
        write_ = {io::network_format(params.format, output), params.schema, {}};
        fs::path const path(output);
        folder_ = path.has_parent_path() ? path.parent_path() : fs::path(".");
        std::error_code ignored;
        refuse_if<BadParameter>(!path.has_filename(), "commands.run_convert", "'{}' is not a valid file name", output);
        if (!fs::is_directory(folder_, ignored)) {
            throw BadInput("commands.run_convert",
                           fmt::format("there is no folder {} for {}", folder_.string(), output));
        }
        files_ = io::network_files(output, write_);
        require_other(files_, folder_, params.path);
        io::files_there(folder_.string(), files_, params.existing);
    }

    bool is_mask() const { return !database_ && write_.format == io::NetworkFormat::mask; }
    bool is_in_degrees() const { return !database_ && write_.format == io::NetworkFormat::geojson; }

    /// Reports the user's columns that are renamed.
    void report_renamed_columns(io::NetworkTables const& tables, std::vector<Finding>& findings) const {
        if (!database_ && write_.format == io::NetworkFormat::shapefile) {
            for (io::ShortenedName const& one : io::shortened_names(tables, params_.schema)) {
                findings.push_back({"shortened_field", 0, nowhere, 1.0,
                                    fmt::format("field {} is {} in the shapefile", one.name, one.in_shapefile)});
            }
        }
    }

    std::vector<std::string> write(io::NetworkTables const& tables, Grid const& grid, Run const& run) {
        bool const overwrite = params_.existing == io::Existing::replace;
        if (database_) {
            return io::write_postgis(tables, params_.output, {params_.schema, params_.table, overwrite}, run);
        }
        io::OutputFolder staged(folder_.string(), io::Existing::add, overwrite ? files_ : std::vector<std::string>{});
        write_.grid = grid;
        io::write_network(tables, staged.path(fs::path(params_.output).filename().string()), write_, run);
        std::vector<std::string> written = staged.files();
        staged.commit();
        for (std::string& file : written) {
            file = fs::path(params_.output).has_parent_path() ? (folder_ / file).string() : file;
        }
        return written;
    }

private:
    ConvertParams const& params_;
    bool database_;
    io::WriteNetworkParams write_ = {};
    fs::path folder_;
    std::vector<std::string> files_;
};

} // namespace

ConvertResult run_convert(ConvertParams const& params, Run const& run) {
    ConvertOutput out(params);
    io::ReadNetworkParams read = params.read;
    read.bridge = true;
    NetworkFile file = io::read_network(params.path, read, run);
    ConvertResult converted;
    converted.schema = file.schema;
    converted.crs = file.crs;
    converted.findings = std::move(file.findings);
    if (!out.is_mask() && io::table_of(params.schema).divergences) {
        std::tie(file, converted.divergences) = network::divide(std::move(file));
    }
    Ready ready{network::from_file(file), {}, {}};
    std::optional<Raster<float>> dem;
    if (!params.dem.empty()) {
        dem = read_dem(params, file.crs, converted.findings, run);
    }
    complete(ready, file, dem ? &*dem : nullptr, converted, run);
    if (params.max_upstream != 0) {
        split(ready, params, converted, run);
    }
    StreamNetwork const& plan = ready.source.network.planform;
    ready.orders = network::order(plan, network::main_inflows(plan, ready.source.clues, params.main));
    converted.arcs = static_cast<std::int64_t>(plan.arc_count());
    converted.nodes = static_cast<std::int64_t>(plan.node_count());
    io::NetworkTables tables{ready.source.network,
                             ready.orders,
                             ready.source.us_area_m2,
                             ready.source.ds_area_m2,
                             ready.node_area_m2,
                             file.crs,
                             {}};
    tables.run = {{"version", report::version()},
                  {"schema_from", file.schema},
                  {"heights_from", converted.heights},
                  {"area_from", converted.areas}};
    tables.braided = &ready.source.braided;
    tables.own_area_m2 = &ready.source.own_area_m2;
    tables.heights = std::string(converted.heights) != "none";
    tables.sinks = make::sinks_in(plan, file);
    io::UserData const user{std::move(file.attributes), ready.source.records, ready.source.stretches};
    tables.user = &user;
    out.report_renamed_columns(tables, converted.findings);
    if (out.is_in_degrees()) {
        converted.findings.push_back(
            {.kind = "in_degrees",
             .text = fmt::format("GeoJSON is written in degrees (WGS 84), as RFC 7946 has it, not in {}; --format "
                                 "geojson2008 keeps its coordinates",
                                 file.crs)});
    }
    Grid const grid = out.is_mask() ? grid_of(plan, params, dem ? &*dem : nullptr, file.crs) : Grid{};
    converted.written = out.write(tables, grid, run);
    return converted;
}

} // namespace thalweg::commands
