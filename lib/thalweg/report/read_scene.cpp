// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/read_scene.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/bounded_json.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/network/import/prepare_lines.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/report/page.hpp>
#include <thalweg/surface/dilation/increment.hpp>

namespace thalweg::report {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_text = 1 << 30;

/// Builds the network of thalweg's own file.
ElevatedNetwork network_of(NetworkFile const& file, std::string const& name) {
    ElevatedNetwork out;
    NetworkDraft plan;
    std::unordered_map<std::int64_t, NodeId> nodes;
    for (NetworkFile::FileNode const& node : file.nodes) {
        NodeId const id = plan.add_node({node.at.x, node.at.y});
        refuse_if<BadInput>(!nodes.emplace(node.id, id).second, "report.read_scene",
                            "{}: node {} is there twice; check the network (thalweg check)", name, node.id);
        out.node_z.push_back(node.at.z);
    }
    for (NetworkFile::FileArc const& arc : file.arcs) {
        auto const from = nodes.find(arc.from_node);
        auto const to = nodes.find(arc.to_node);
        refuse_if<BadInput>(from == nodes.end() || to == nodes.end() || arc.line.size() < 2, "report.read_scene",
                            "{}: arc {} lacks a node or a line; check the network (thalweg check)", name, arc.id);
        Arc drawn;
        std::vector<double> z;
        for (Vec3 const v : arc.line) {
            drawn.line.push_back({v.x, v.y});
            z.push_back(v.z);
        }
        plan.add_arc(from->second, to->second, std::move(drawn));
        out.arc_z.push_back(std::move(z));
    }
    out.planform = std::move(plan);
    return out;
}

/// Heights of a DEM along an arc; interpolated across holes.
std::vector<double> draped(std::vector<Vec2> const& line, Raster<float> const& dem, double where_none) {
    std::vector<double> z(line.size());
    std::transform(line.begin(), line.end(), z.begin(), [&](Vec2 p) { return draw::height_at(dem, p); });
    std::size_t known = line.size(); // the last vertex with a height
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (!std::isfinite(z[i])) {
            continue;
        }
        for (std::size_t k = known == line.size() ? 0 : known + 1; k < i; ++k) {
            double const share =
                known == line.size() ? 1.0 : static_cast<double>(k - known) / static_cast<double>(i - known);
            z[k] = known == line.size() ? z[i] : z[known] + (z[i] - z[known]) * share;
        }
        known = i;
    }
    for (std::size_t k = known == line.size() ? 0 : known + 1; k < z.size(); ++k) {
        z[k] = known == line.size() ? where_none : z[known];
    }
    return z;
}

double lowest_of(Raster<float> const& dem) {
    double low = 0.0;
    bool first = true;
    for (float const z : dem.values()) {
        if (std::isfinite(z)) {
            low = first ? static_cast<double>(z) : std::min(low, static_cast<double>(z));
            first = false;
        }
    }
    return low;
}

ElevatedNetwork drape(StreamNetwork plan, Raster<float> const& dem) {
    ElevatedNetwork out{std::move(plan), {}, {}};
    double const lowest = lowest_of(dem);
    out.node_z.assign(out.planform.node_count(), lowest);
    for (ArcId arc = 0; arc < out.planform.arc_count(); ++arc) {
        out.arc_z.push_back(draped(out.planform.arc(arc).line, dem, lowest));
        out.node_z[out.planform.from(arc)] = out.arc_z.back().front();
        out.node_z[out.planform.to(arc)] = out.arc_z.back().back();
    }
    return out;
}

/// Rivers from any line file on a DEM; nothing: none lies on it.
std::optional<ElevatedNetwork> rivers_on(Raster<float> const& dem, std::string const& file,
                                         std::vector<Finding>& findings, Run const& run) {
    io::ReadRiversParams params;
    params.path = file;
    params.crs = dem.grid().crs;
    RiverLines const lines = network::clip_lines(io::read_rivers(params, run), dem.grid());
    for (Finding const& finding : lines.findings) {
        if (finding.kind == FindingKind("not_a_line")) {
            findings.push_back(finding);
            findings.back().text = fmt::format("{}: {}", lines.name, finding.text);
        }
    }
    if (lines.lines.empty()) {
        findings.push_back({.kind = "no_rivers",
                            .text = fmt::format("no river of {} runs on the DEM", lines.name),
                            .layer = lines.name});
        return std::nullopt;
    }
    network::ImportedNetwork imported = network::import_lines(lines, {}, run);
    if (!imported.arc_z.empty()) {
        try {
            return network::take_file_heights(imported, lines);
        } catch (BadInput const&) { // they run uphill somewhere, or were clipped
            findings.push_back(
                {.kind = "heights_not_falling",
                 .text =
                     fmt::format("heights of {} do not fall all the way: the rivers take those of the DEM", lines.name),
                 .layer = lines.name});
        }
    }
    return drape(std::move(imported.network), dem);
}

/// Reads the increments of the surface: the recipe names them, the report has their number and scale.
void read_increments(Scene& scene, recipe::Recipe const& recipe, std::string const& report) {
    auto const json = bounded_json<nlohmann::json>(report, {.most_keys = std::size_t{1} << 20U});
    auto const dem = json.is_object() && json.contains("dem") ? json["dem"] : nlohmann::json();
    if (!recipe.surface || !dem.is_object() || !dem.contains("levels") || !dem["levels"].is_number_integer() ||
        !dem.contains("metres_per_unit") || !dem["metres_per_unit"].is_number()) {
        return;
    }
    constexpr std::int64_t most = 1 << 24;
    std::int64_t const levels = dem["levels"].get<std::int64_t>();
    if (levels < 1 || levels > most) {
        return;
    }
    surface::IncrementParams const& wanted = recipe.surface->dilate.increment;
    scene.increments = surface::increments(levels, wanted);
    scene.increment = wanted.increment;
    for (double& increment : scene.increments) {
        increment *= dem["metres_per_unit"].get<double>();
    }
}

/// Reads how layers of rock lie: the recipe says it, and the report by how much lower.
void read_rock(Scene& scene, recipe::Recipe const& recipe, std::string const& report) {
    auto const json = bounded_json<nlohmann::json>(report, {.most_keys = std::size_t{1} << 20U});
    auto const made = json.is_object() && json.contains("equilibrium") ? json["equilibrium"] : nlohmann::json();
    if (scene.dem && made.is_object() && made.contains("strata_shift_m") && made["strata_shift_m"].is_number()) {
        scene.rock = layers_below(recipe, *scene.dem, made["strata_shift_m"].get<double>());
    }
}

SceneRead read_folder(ReadSceneParams const& params, Run const& run) {
    fs::path const folder = params.source;
    SceneRead out;
    Scene& scene = out.scene;
    std::string const dem = (folder / "dem.tif").string();
    std::string const rivers = (folder / "network.gpkg").string();
    std::string const recipe = (folder / "recipe.toml").string();
    std::string const report = (folder / "report.json").string();
    if (!fs::exists(dem) && !fs::exists(rivers)) {
        throw BadInput(
            "report.read_scene",
            fmt::format("{} holds neither dem.tif nor network.gpkg: name a folder written by make, or a raster",
                        folder.string()));
    }
    if (fs::exists(dem)) {
        io::Drawable read = io::read_drawable(
            dem, {.most_side = params.most_side, .metres = io::MetresOf::any_crs, .reading = params.reading},
            run); // the choice of its maker
        scene.dem = std::move(read.dem);
        out.findings = std::move(read.findings);
    }
    if (params.network.empty() && fs::exists(rivers)) {
        NetworkFile const file = io::read_network(rivers, run);
        scene.network = network_of(file, rivers);
        for (NetworkFile::FileArc const& arc : file.arcs) {
            scene.ds_area_m2.push_back(arc.ds_area_m2);
        }
    }
    if (std::string const lakes = (folder / "lakes.tif").string(); fs::exists(lakes) && scene.dem) {
        scene.lakes = io::read_mask({lakes}, scene.dem->grid(), run);
    }
    if (fs::exists(recipe)) {
        recipe::Recipe const made = recipe::read_recipe(io::read_text(recipe, 2 << 20), recipe);
        scene.title = recipe::title_of(made);
        scene.sea = sea_of(made);
        bool const in_metres = made.output.units == HeightUnit::metre; // pictures are always in metres
        scene.contour_interval_m = in_metres ? made.output.contour_interval : 0.0;
        if (fs::exists(report)) {
            std::string const told = io::read_text(report, largest_text);
            read_increments(scene, made, told);
            read_rock(scene, made, told);
        }
    }
    return out;
}

} // namespace

SceneRead read_scene(ReadSceneParams const& params, Run const& run) {
    std::string const& source = params.source;
    std::string const& network = params.network;
    SceneRead out;
    std::error_code ignored;
    if (fs::is_directory(source, ignored) &&
        (fs::exists(fs::path(source) / "dem.tif") || fs::exists(fs::path(source) / "report.json") ||
         fs::exists(fs::path(source) / "network.gpkg") || fs::path(source).extension().empty())) {
        out = read_folder(params, run);
    } else {
        io::Drawable read = io::read_drawable(source, {.most_side = params.most_side, .reading = params.reading}, run);
        out.scene.dem = std::move(read.dem);
        out.findings = std::move(read.findings);
        out.scene.title = fs::path(source).stem().string();
    }
    if (!network.empty()) {
        if (!out.scene.dem) {
            throw BadInput("report.read_scene", fmt::format("there is no DEM to lay the rivers of {} on", network));
        }
        out.scene.network = rivers_on(*out.scene.dem, network, out.findings, run);
    }
    if (out.scene.network) {
        out.scene.orders = network::order(out.scene.network->planform);
    }
    return out;
}

} // namespace thalweg::report
