// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which files and layers hold rivers or a network, and in whose schema.
#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>

namespace thalweg::io {

namespace {

namespace fs = std::filesystem;

bool names_database(std::string const& path) {
    return path.starts_with("PG:") || path.starts_with("postgresql:");
}

// "NAME_arcs" and "arcs" end in "arcs" and have their counterpart in "NAME_nodes" and "nodes".
bool ends_as(fs::path const& path, std::string_view layer) {
    std::string const stem = path.stem().string();
    return stem == layer || stem.ends_with(fmt::format("_{}", layer));
}

/// The files of networks in a folder: the network.gpkg that `make` wrote, else the arcs that `convert` wrote, else, if
/// not only shapefiles are meant, GeoPackages.
std::vector<std::string> networks_in(fs::path const& folder, bool shapefiles_alone) {
    std::error_code error;
    if (fs::path const file = folder / "network.gpkg"; fs::exists(file, error)) {
        return {file.string()};
    }
    std::vector<std::string> arcs;
    std::vector<std::string> packages;
    for (auto const& entry : fs::directory_iterator(folder, error)) {
        std::string const ending = lower_case(entry.path().extension().string());
        bool const of_layers = ending == ".shp" || (!shapefiles_alone && (ending == ".fgb" || ending == ".geojson"));
        if (of_layers && ends_as(entry.path(), "arcs")) {
            arcs.push_back(entry.path().string());
        } else if (ending == ".gpkg") {
            packages.push_back(entry.path().string());
        }
    }
    refuse_if<IoError>(static_cast<bool>(error), "io.read_network", "{}: {}", folder.string(), error.message());
    bool const is_terrain = fs::exists(folder / "recipe.toml"); // whose only package would hold contours
    return arcs.empty() && !is_terrain && !shapefiles_alone ? packages : arcs;
}

/// Why a folder that GDAL does not open holds no rivers.
char const* why_not(fs::path const& folder) {
    if (fs::is_empty(folder)) {
        return "the folder is empty";
    }
    return fs::exists(folder / "recipe.toml")
               ? "its terrain has no rivers; to make it again, give its recipe.toml"
               : "it holds neither network.gpkg, nor one other GeoPackage, nor shapefiles; name a file in it";
}

NetworkPlace pair_of(fs::path const& path, bool whole) {
    std::error_code ignored;
    auto const sibling = [&](std::string_view layer, std::string_view other) {
        std::string const stem = path.stem().string();
        std::string const name = stem.substr(0, stem.size() - layer.size()) + std::string(other);
        return (path.parent_path() / (name + path.extension().string())).string();
    };
    if (ends_as(path, "arcs")) {
        std::string const nodes = sibling("arcs", "nodes");
        return {path.string(), whole || fs::exists(nodes, ignored) ? nodes : ""};
    }
    if (ends_as(path, "nodes")) {
        return {sibling("nodes", "arcs"), path.string()};
    }
    refuse_if<BadInput>(whole, "io.read_network", "{} is neither NAME_arcs.shp nor NAME_nodes.shp", path.string());
    return {path.string(), ""};
}

Layer layer_of(NetworkSource const& source, OGRLayer& layer, std::string const& name) {
    return {&layer, {source.about.where, fmt::format("{}, layer {}", source.about.name, name)}};
}

[[noreturn]] void refuse_layer(NetworkSource const& source, std::string const& wanted) {
    throw BadInput(source.about.where, fmt::format("{} has no layer {} (there are {})", source.about.name, wanted,
                                                   listed(layer_names(layers_of(*source.dataset)))));
}

// "native: arc_id, ...; taudem: ...", for a message: what recognised() looks for.
std::string what_tells() {
    std::vector<std::string> schemas;
    for (SchemaTable const& table : all_schemas()) {
        std::vector<std::string> fields;
        for (std::string_view const names : table.told_by) {
            fields.push_back(fmt::format("{}", fmt::join(words_of(names), " or ")));
        }
        schemas.push_back(fmt::format("{}: {}", table.name, listed(fields)));
    }
    return fmt::format("{}", fmt::join(schemas, "; "));
}

/// Several layers as one, which lives as long as the layer is used.
Layer layer_of(NetworkSource const& source, std::vector<OGRLayer*> layers) {
    ChosenLayer chosen = as_one(layers, source.about);
    Layer layer = layer_of(source, *chosen.layer, chosen.name);
    layer.holds = std::shared_ptr<GDALDataset>(std::move(chosen.holds));
    layer.read_from = std::move(layers);
    return layer;
}

} // namespace

RiverSource find_rivers(std::string const& path) {
    std::error_code ignored;
    RiverSource source{path, ""};
    while (source.path.size() > 1 && source.path.ends_with('/')) {
        source.path.pop_back();
    }
    bool const is_file = !names_database(path) && !path.starts_with("/vsi");
    refuse_if<BadInput>(is_file && !fs::exists(path, ignored), "io.find_rivers", "{} does not exist", path);
    refuse_if<BadInput>(is_file && fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) == 0,
                        "io.find_rivers", "{} is empty", path);
    bool is_plain_folder = false;
    if (is_file && fs::is_directory(path, ignored)) {
        std::vector<std::string> const networks = networks_in(source.path, false);
        is_plain_folder = networks.size() != 1;
        source.path = is_plain_folder ? source.path : networks.front();
    }
    Driver const driver;
    Dataset const data = open_unchanged(source.path, GDAL_OF_VECTOR | GDAL_OF_RASTER);
    if (!data) {
        std::string const words = driver.take();
        throw BadInput("io.find_rivers", is_plain_folder
                                             ? fmt::format("{} holds no rivers: {}", path, why_not(path))
                                             : fmt::format("{} is not a file with lines that GDAL can read{}",
                                                           source.path, words.empty() ? "" : " (" + words + ")"));
    }
    refuse_if<BadInput>(data->GetLayerCount() == 0 && data->GetRasterCount() > 0, "io.find_rivers",
                        "{} is a raster, not river lines", source.path);
    require_lines(*data, {"io.find_rivers", source.path});
    source.layer = data->GetLayerByName("arcs") != nullptr ? "arcs" : is_osm_file(*data) ? "lines" : "";
    return source;
}

// Files of a network.

NetworkPlace find_network(std::string const& path, bool whole) {
    std::error_code ignored;
    fs::path file = path;
    bool const is_folder = !names_database(path) && fs::is_directory(file, ignored) && file.extension() != ".gdb";
    if (is_folder) {
        std::vector<std::string> const networks = networks_in(file, true);
        refuse_if<BadInput>(networks.size() != 1, "io.read_network",
                            "{} holds {} files NAME_arcs.shp and no network.gpkg: name the file", path,
                            networks.size());
        file = networks.front();
    }
    bool const is_shapefile = lower_case(file.extension().string()) == ".shp";
    bool const is_pair = is_shapefile || (!whole && (ends_as(file, "arcs") || ends_as(file, "nodes")));
    return names_database(path) || !is_pair ? NetworkPlace{file.string(), file.string()}
                                            : pair_of(file, whole || is_folder);
}

NetworkSource open_network(std::string const& path, Driver const& driver) {
    About const about{"io.read_network", without_passwords(path)};
    std::error_code ignored;
    refuse_if<BadInput>(!names_database(path) && !fs::exists(path, ignored), about.where, "{} does not exist",
                        about.name);
    Dataset dataset = open_unchanged(path, GDAL_OF_VECTOR);
    if (dataset == nullptr) {
        std::string const words = driver.take();
        auto const say = [&](std::string_view part) { return words.find(part) != std::string::npos; };
        refuse_if<IoError>(say("database is locked") || say("readonly database"), about.where,
                           "{} is locked by another program, or was left in the middle of a change: close it there, or "
                           "open it once with the program that wrote it",
                           about.name);
        throw BadInput(about.where, fmt::format("{} cannot be read: {}", about.name, words));
    }
    forget_archive(path, driver);
    return {about, std::move(dataset)};
}

// Layers of a network.

void Layer::each(Driver const& driver, Run const& run, std::function<void(OGRFeature const&)> const& body) const {
    GIntBig const announced = layer->GetFeatureCount();
    GIntBig read = 0;
    for (auto const& feature : *layer) {
        run.check();
        body(*feature);
        ++read;
    }
    driver.check(about.where, about.name);
    refuse_if<IoError>(announced >= 0 && read != announced, about.where,
                       "{}: {} of {} features could be read: the file is damaged", about.name, read, announced);
}

Layer choose_arcs(NetworkSource const& source, Wish const& wish) {
    GDALDataset& data = *source.dataset;
    std::string const name = wish.arcs_layer.empty() ? "arcs" : wish.arcs_layer;
    if (OGRLayer* const layer = data.GetLayerByName(name.c_str())) {
        return layer_of(source, *layer, name);
    }
    if (!wish.arcs_layer.empty()) {
        return layer_of(source, rivers_layers(data, name, source.about));
    }
    std::vector<OGRLayer*> const all = layers_of(data);
    std::vector<OGRLayer*> lines = all;
    std::erase_if(lines, [](OGRLayer* layer) { return !may_hold_lines(*layer); });
    refuse_if<BadInput>(wish.whole && (all.size() != 1 || lines.empty()), source.about.where, "{} has no layer arcs",
                        source.about.name);
    if (lines.size() > 1) {
        std::vector<OGRLayer*> understood = lines;
        std::erase_if(understood, [](OGRLayer* layer) { return recognised(*layer).empty(); });
        lines = understood.size() == 1 ? understood : rivers_layers(data, "", source.about);
    }
    refuse_if<BadInput>(lines.empty(), source.about.where, "{} has no layer of lines (there are {})", source.about.name,
                        listed(layer_names(all)));
    return wish.whole ? layer_of(source, *lines.front(), "arcs") : layer_of(source, lines);
}

std::optional<Schema> choose_schema(Layer const& arcs, Wish const& wish) {
    if (wish.schema) {
        return wish.schema;
    }
    auto const found = recognised(*arcs.layer);
    if (is_in_network_schema(*arcs.layer)) { // and the user's columns may be another's
        return Schema::native;
    }
    if (found.size() == 1) {
        return found.front();
    }
    auto const names_field = [&](Quantity quantity) { return wish.columns.contains(quantity); };
    bool const is_enough =
        names_field(Quantity::arc_id) &&
        (names_field(Quantity::ds_arc) || (names_field(Quantity::from_node) && names_field(Quantity::to_node)));
    if (is_enough || (found.empty() && takes_any_lines(wish))) {
        return std::nullopt;
    }
    refuse_if<BadInput>(found.empty(), arcs.about.where,
                        "{}: its fields ({}) match no schema ({}); name the schema, or the fields that hold arc_id and "
                        "ds_arc, or arc_id, from_node and to_node{}",
                        arcs.about.name, listed(field_names(*arcs.layer)), what_tells(),
                        field_names(*arcs.layer).empty() ? "; a shapefile without fields has lost its .dbf" : "");
    std::vector<std::string> names;
    for (Schema const schema : found) {
        names.emplace_back(table_of(schema).name);
    }
    throw BadInput(arcs.about.where, fmt::format("{}: its fields match several schemas ({}); name one of them",
                                                 arcs.about.name, listed(names)));
}

std::optional<Layer> choose_nodes(NetworkSource const* source, NetworkSource const& arcs_source, Layer const& arcs,
                                  std::optional<Schema> schema, Wish const& wish) {
    std::string const name = wish.nodes_layer.empty() ? "nodes" : wish.nodes_layer;
    if (wish.nodes_layer.empty() &&
        (source == nullptr || (schema ? schema != Schema::native : takes_any_lines(wish)))) {
        return std::nullopt;
    }
    for (NetworkSource const* const place : {source == nullptr ? &arcs_source : source, &arcs_source}) {
        if (OGRLayer* const layer = place->dataset->GetLayerByName(name.c_str())) {
            return layer_of(*place, *layer, name);
        }
    }
    if (!wish.nodes_layer.empty()) {
        refuse_layer(arcs_source, name);
    }
    auto const layers = layers_of(*source->dataset);
    bool const own_file = layers.size() == 1 && layers.front() != arcs.layer;
    return own_file ? std::optional(layer_of(*source, *layers.front(), name)) : std::nullopt;
}

} // namespace thalweg::io
