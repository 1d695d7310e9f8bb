// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/check.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/commands/internal/repair_network.hpp>
#include <thalweg/core/append.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/report/report.hpp>

namespace thalweg::commands {
namespace {

// Rasters beside a network; cells above 0 count; "": none. Those on another grid than the DEM's are ignored.
struct RiverRasters {
    std::string drawn = {}; // cells into which rivers were drawn
    std::string lakes = {}; // cells of lakes
    bool waive = false;     // only drawn cells are honoured: patches replaced others
};

/// By reach: the contributing area that the file gives for its lower end.
std::vector<double> areas_of(NetworkFile const& file, std::vector<flow::Reach> const& reaches) {
    std::unordered_map<std::int64_t, double> by_id;
    for (NetworkFile::FileArc const& arc : file.arcs) {
        by_id.try_emplace(arc.id, arc.ds_area_m2);
    }
    std::vector<double> areas;
    areas.reserve(reaches.size());
    for (flow::Reach const& reach : reaches) {
        areas.push_back(file.says.areas ? by_id.at(reach.id) : std::numeric_limits<double>::quiet_NaN());
    }
    return areas;
}

/// The cells of a raster above 0; without cells if there is no raster on this grid.
Mask cells_in(std::string const& raster, Grid const& grid) {
    if (raster.empty()) {
        return {};
    }
    Raster<float> const values = io::read_stored_dem(raster, {.values = io::CellValues::codes});
    if (values.grid() != grid) {
        return {};
    }
    Mask cells(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        cells[i] = values[i] > 0.0F ? 1 : 0;
    }
    return cells;
}

// Certifies a DEM file along any network. Parts of the network off the DEM are findings (outside_dem) and do not count
// otherwise. Level parts of rivers count as lakes; nodes of the kind "sink" end their rivers. Throws BadInput when a
// raster cannot be read, the network and the DEM have different CRS or only one has any, or no arc lies on the DEM; as
// reaches_of_file for a network without directions; IoError.
measure::Certificate certify_files(NetworkFile const& network, CheckParams const& params, RiverRasters const& rasters,
                                   Run const& run) {
    std::string const& dem = params.dem;
    Raster<float> const land = io::read_stored_dem(dem, params.reading, run); // the unit does not change the flow
    if (!io::same_crs(network.crs, land.grid().crs, "the network", dem)) {
        std::string const lines = network.crs.substr(0, 60);
        throw BadInput("commands.run_check", fmt::format("the network is in {}, {} in {}; reproject one of them "
                                                         "(ogr2ogr -t_srs, gdalwarp -novshift -t_srs {} {} OUT.tif)",
                                                         lines, dem, land.grid().crs.substr(0, 60), lines, dem));
    }
    make::FileReaches const found = make::reaches_of_file(network, land.grid());
    measure::Claims claims;
    claims.ds_area_m2 = areas_of(network, found.reaches);
    claims.still = make::either(make::still_cells(network, land.grid()), cells_in(rasters.lakes, land.grid()));
    claims.drawn = cells_in(rasters.drawn, land.grid());
    claims.honoured = rasters.waive ? claims.drawn : Mask{};
    flow::FlowField const drainage = flow::route(land, make::sinks_of(network, land), run);
    measure::Certificate certificate = measure::certify(land, drainage, found.reaches, claims, run);
    for (flow::Reach const& reach : found.reaches) {
        if (reach.lines.empty()) {
            certificate.findings.push_back(
                {"outside_dem", reach.id, {}, 0.0, fmt::format("arc {} lies outside the DEM", reach.id)});
        }
    }
    return certificate;
}

namespace fs = std::filesystem;

/// An output file, or the files of two shapefiles, created together.
class CheckOutput {
public:
    CheckOutput(std::string const& path, char const* option, bool may_be_shapefile, CheckParams const& params)
        : folder_(fs::path(path).has_parent_path() ? fs::path(path).parent_path().string() : "."),
          stem_(fs::path(path).stem().string()) {
        std::string const ending = fs::path(path).extension().string();
        auto const is = [&](std::string_view known) {
            return std::ranges::equal(ending, known, {}, [](unsigned char c) { return std::tolower(c); });
        };
        if (is(".gpkg")) {
            names_ = {stem_ + ending};
        } else if (is(".shp") && may_be_shapefile) {
            if (stem_.ends_with("_arcs")) {
                stem_.resize(stem_.size() - std::string("_arcs").size());
            }
            for (char const* const layer : {"_arcs", "_nodes"}) {
                for (char const* const part : {".shp", ".shx", ".dbf", ".prj", ".cpg"}) {
                    names_.push_back(stem_ + layer + part);
                }
            }
        } else {
            throw BadParameter("commands.run_check", fmt::format("{} {}: it must end in {}", option, path,
                                                                 may_be_shapefile ? ".gpkg or .shp" : ".gpkg"));
        }
        refuse_present(option, params);
    }

    bool is_shapefile() const { return names_.size() > 1; }

    /// Calls write(path), for a shapefile without its extension, then moves the files into place.
    /// \return their paths
    template <class Write> std::vector<std::string> put(Write const& write) const {
        io::OutputFolder folder(folder_, fs::exists(folder_) ? io::Existing::add : io::Existing::refuse, present_);
        write(folder.path(is_shapefile() ? stem_ : names_.front()));
        std::vector<std::string> written;
        for (std::string const& name : folder.files()) {
            written.push_back((fs::path(folder_) / name).lexically_normal().string());
        }
        folder.commit();
        return written;
    }

private:
    void refuse_present(char const* option, CheckParams const& params) {
        std::error_code error;
        fs::path const input = params.network;
        for (std::string const& name : names_) {
            fs::path const file = (fs::path(folder_) / name).lexically_normal();
            if (!fs::exists(file, error)) {
                continue;
            }
            bool const in_input = fs::is_directory(input, error) && fs::equivalent(folder_, input, error);
            bool const of_input = input.has_filename() && fs::exists(input, error) &&
                                  fs::equivalent(folder_, input.parent_path() / ".", error) &&
                                  stem_of(file) == stem_of(input);
            if (fs::equivalent(file, input, error) || in_input || of_input) {
                throw BadParameter(
                    "commands.run_check",
                    fmt::format("{} {}: the input is not touched; name another file", option, file.string()));
            }
            if (params.existing == io::Existing::refuse) {
                throw BadInput("commands.run_check",
                               fmt::format("{} {}: it exists; --overwrite replaces it", option, file.string()));
            }
            present_.push_back(name);
        }
    }
    /// For a network: arcs and nodes are two files with a common stem.
    static std::string stem_of(fs::path const& file) {
        std::string stem = file.stem().string();
        for (std::string const layer : {"_arcs", "_nodes"}) {
            if (stem.ends_with(layer)) {
                stem.resize(stem.size() - layer.size());
            }
        }
        return stem;
    }

    std::string folder_;
    std::string stem_;
    std::vector<std::string> names_ = {};
    std::vector<std::string> present_ = {};
};

void write_copy(RepairedNetwork const& mended, NetworkFile const& file, CheckOutput const& output, CheckResult& checked,
                Run const& run) {
    io::NetworkTables const tables{mended.network,
                                   mended.orders,
                                   mended.us_area_m2,
                                   mended.ds_area_m2,
                                   mended.node_area_m2,
                                   file.crs,
                                   {{"version", report::version()}, {"mended", std::to_string(mended.mended.size())}},
                                   &mended.braided,
                                   nullptr,
                                   &mended.secondary,
                                   &mended.user,
                                   HeightUnit::metre,
                                   mended.has_heights,
                                   make::sinks_in(mended.network.planform, file)};
    if (output.is_shapefile()) {
        for (io::ShortenedName const& one : io::shortened_names(tables)) {
            checked.notes.push_back({"shortened_field", 0, nowhere, 1.0,
                                     fmt::format("field {} is {} in the shapefile", one.name, one.in_shapefile)});
        }
    }
    append(checked.written, output.put([&](std::string const& path) {
        output.is_shapefile() ? io::write_shapefiles(tables, path, run) : io::write_geopackage(tables, path, run);
    }));
}

/// The rasters that a folder written by make has for its rivers; none for other networks.
RiverRasters rasters_beside(std::string const& network) {
    auto const beside = [&](char const* name) {
        std::string const path = (fs::path(network) / name).string();
        std::error_code ignored;
        return fs::is_regular_file(path, ignored) ? path : std::string();
    };
    std::string const recipe = beside("recipe.toml");
    if (recipe.empty()) {
        return {};
    }
    RiverRasters rasters{beside("network.tif"), beside("lakes.tif"), false};
    try {
        rasters.waive = recipe::replaces_rivers(recipe::read_recipe(io::read_text(recipe, 2 << 20), recipe));
    } catch (Error const&) { // not our recipe: every cell counts
        return {};
    }
    return rasters;
}

/// Whether the direction and the receiver of each arc are unambiguous.
bool has_direction(measure::TopologyReport const& topology) {
    return std::none_of(topology.findings.begin(), topology.findings.end(), [](Finding const& f) {
        return f.kind == FindingKind("cycle") || f.kind == FindingKind("duplicate_arc_id") ||
               f.kind == FindingKind("nan");
    });
}

/// A note of the arcs whose inflows have more area together than they have themselves; none where no areas overlap.
std::vector<Finding> areas_that_overlap(NetworkFile const& file) {
    constexpr double rounding = 1e-6; // of areas in a file
    if (file.schema != "native" || !file.says.areas || !file.says.downstream) {
        return {};
    }
    std::unordered_map<std::int64_t, double> arriving_m2; // by the arc downstream
    for (NetworkFile::FileArc const& arc : file.arcs) {
        if (arc.ds_arc != 0 && arc.ds_area_m2 > 0.0) {
            arriving_m2[arc.ds_arc] += arc.ds_area_m2;
        }
    }
    NetworkFile::FileArc const* worst = nullptr;
    double most_m2 = 0.0;
    std::size_t count = 0;
    for (NetworkFile::FileArc const& arc : file.arcs) {
        auto const found = arriving_m2.find(arc.id);
        double const over_m2 = found == arriving_m2.end() ? 0.0 : found->second - arc.us_area_m2;
        if (over_m2 > rounding * arc.us_area_m2) { // false for NaN
            ++count;
            worst = over_m2 > most_m2 ? &arc : worst;
            most_m2 = std::max(most_m2, over_m2);
        }
    }
    if (worst == nullptr) {
        return {};
    }
    return {{"areas_overlap", worst->id - file.id_shift, worst->line.empty() ? nowhere : in_plan(worst->line.front()),
             static_cast<double>(count),
             fmt::format("the inflows of {} arcs have more contributing area together than the arc, by up to {:.6g} "
                         "km2 (arc {}): right where rivers divide above and count common water in both branches",
                         count, most_m2 * 1e-6, worst->id - file.id_shift)}};
}

} // namespace

bool CheckResult::ok() const {
    return std::all_of(checks.begin(), checks.end(), [](Check const& c) { return c.ok; });
}

CheckResult run_check(CheckParams const& params, Run const& run) {
    std::optional<CheckOutput> fix;
    if (!params.fix.empty()) {
        fix.emplace(params.fix, "--fix", true, params);
    }
    std::optional<CheckOutput> layer;
    if (!params.findings.empty()) {
        layer.emplace(params.findings, "--findings", false, params);
    }
    io::ReadNetworkParams read = params.read;
    read.any_lines = !params.fix.empty();
    read.bridge = true;
    NetworkFile const network = io::read_network(params.network, read, run);
    CheckResult checked;
    checked.arcs = static_cast<std::int64_t>(network.arcs.size());
    checked.nodes = static_cast<std::int64_t>(network.nodes.size());
    checked.schema = network.schema;
    checked.notes = network.findings;

    measure::TopologyReport const topology = measure::check_topology(network, {params.near_m}, run);
    append(checked.checks, topology.checks);
    append(checked.findings, topology.findings);

    append(checked.notes, areas_that_overlap(network));
    if (!params.dem.empty() && has_direction(topology)) {
        RiverRasters const rasters = rasters_beside(params.network);
        checked.certificate = certify_files(network, params, rasters, run);
        if (checked.certificate->waived_cells > 0) {
            checked.notes.push_back({"not_honoured", 0, nowhere, static_cast<double>(checked.certificate->waived_cells),
                                     fmt::format("{} river cells are not checked against the DEM: a patch with rivers "
                                                 "= \"replace\" took their place, or that of rivers below ({})",
                                                 checked.certificate->waived_cells, rasters.drawn)});
        }
        append(checked.checks, checked.certificate->checks());
        append(checked.findings, checked.certificate->findings);
    } else if (!params.dem.empty()) {
        checked.notes.push_back({"no_certificate", 0, nowhere, 0.0,
                                 "the DEM was not checked: rivers run in circles, share ids or have vertices that are "
                                 "no numbers"});
    }

    if (fix) {
        StageLog stage_log(run);
        Raster<float> const dem = recipe::read_dem_in(params.dem, network.crs, "--dem", params.reading, stage_log, run);
        append(checked.notes, stage_log.take_findings());
        RepairedNetwork const mended =
            repair_network(network, topology, {params.near_m, dem.cells() > 0 ? &dem : nullptr, params.main}, run);
        checked.mended = mended.mended;
        append(checked.notes, mended.doubts);
        if (mended.done) {
            write_copy(mended, network, *fix, checked, run);
        }
    }
    if (layer) {
        append(checked.written, layer->put([&](std::string const& path) {
            io::write_findings(checked.findings, network.crs, path, run);
        }));
    }
    return checked;
}

std::string as_json(CheckResult const& checked) {
    using nlohmann::ordered_json;
    ordered_json out{{"ok", checked.ok()},
                     {"arcs", checked.arcs},
                     {"nodes", checked.nodes},
                     {"schema", checked.schema},
                     {"checks", ordered_json::parse(report::checks_json(checked.checks))},
                     {"findings", ordered_json::parse(report::findings_json(checked.findings))},
                     {"notes", ordered_json::parse(report::findings_json(checked.notes))},
                     {"mended", ordered_json::parse(report::findings_json(checked.mended))},
                     {"written", checked.written}};
    if (checked.certificate) {
        out["certificate"] = ordered_json::parse(report::certificate_json(*checked.certificate));
    }
    return out.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

} // namespace thalweg::commands
