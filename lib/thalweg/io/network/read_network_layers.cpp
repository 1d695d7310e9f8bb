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

std::vector<OGRLayer*> layers_of(GDALDataset& data) {
    auto const layers = data.GetLayers();
    return {layers.begin(), layers.end()};
}

std::vector<std::string> layer_names(std::vector<OGRLayer*> const& layers) {
    std::vector<std::string> names;
    for (OGRLayer* const layer : layers) {
        names.emplace_back(layer->GetName());
    }
    return names;
}

bool is_line(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbCurve) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiCurve) != 0;
}

bool may_hold_lines(OGRLayer& layer) {
    auto const type = wkbFlatten(layer.GetGeomType());
    return type == wkbUnknown || type == wkbGeometryCollection || is_line(type);
}

// Layers of rivers.

enum class Holds : std::uint8_t { lines, other, nothing };

// A layer of any shapes holds lines when one of its first features is one: exports of OpenStreetMap begin with nodes.
Holds content_of(OGRLayer& layer, std::string const& what) {
    constexpr int most_features = 1000000;
    auto const type = wkbFlatten(layer.GetGeomType());
    if (type != wkbUnknown && !is_line(type)) {
        return type == wkbGeometryCollection ? Holds::lines : Holds::other;
    }
    Driver const driver;
    Holds holds = Holds::nothing;
    int looked_at = 0;
    for (auto const& feature : layer) {
        if (holds == Holds::lines || ++looked_at > most_features) {
            break;
        }
        OGRGeometry const* const shape = feature->GetGeometryRef();
        auto const drawn = shape == nullptr ? type : wkbFlatten(shape->getGeometryType());
        holds = is_line(drawn) || drawn == wkbGeometryCollection ? Holds::lines : Holds::other;
    }
    layer.ResetReading();
    driver.check(fmt::format("{}, layer {}", what, layer.GetName()));
    return holds;
}

/// How clearly a name says that a layer holds the rivers: 0 most; all that do not say so are equal.
std::size_t rank_of(std::string_view name) {
    // thalweg; NHD and NHDPlus HR; EU-Hydro; OpenStreetMap; OS Open Rivers; and common names.
    static constexpr std::array exact{"arcs",      "nhdflowline", "networknhdflowline", "nhdflowlinenetwork",
                                      "rivernetl", "waterways",   "watercourselink"};
    static constexpr std::array parts{"hydrorivers", "flowline", "waterway", "watercourse", "river", "stream"};
    std::string const own = simple_name(name);
    auto const has = [&](char const* part) { return own.find(part) != std::string::npos; };
    if (auto const* const same = std::ranges::find(exact, own); same != exact.end()) {
        return static_cast<std::size_t>(same - exact.begin());
    }
    bool const is_other = has("catchment") || has("nonnetwork");
    auto const* const part = is_other ? parts.end() : std::ranges::find_if(parts, has);
    return exact.size() + static_cast<std::size_t>(part - parts.begin());
}

/// The layers with lines; where there is none, those without features that may get some.
std::vector<OGRLayer*> line_layers(GDALDataset& data, std::string const& what) {
    std::vector<OGRLayer*> lines;
    std::vector<OGRLayer*> empty;
    std::vector<OGRLayer*> const all = layers_of(data);
    for (OGRLayer* const layer : all) {
        Holds const holds = content_of(*layer, what);
        if (holds != Holds::other) {
            (holds == Holds::lines ? lines : empty).push_back(layer);
        }
    }
    refuse_if<BadInput>(lines.empty() && empty.empty(), "{} has no layer with lines ({})", what,
                        listed(layer_names(all)));
    return lines.empty() ? empty : lines;
}

} // namespace

void require_lines(GDALDataset& data, std::string const& name, std::string const& who) {
    line_layers(data, who + ": " + name);
}

OGRLayer& rivers_layer(GDALDataset& data, std::string const& wanted, std::string const& name, std::string const& who) {
    std::string const what = who + ": " + name;
    if (!wanted.empty()) {
        std::vector<OGRLayer*> const layers = layers_of(data);
        auto const at = std::ranges::find(layers, wanted, [](OGRLayer* layer) { return layer->GetName(); });
        if (at == layers.end()) {
            auto const names = layer_names(layers);
            throw BadInput(
                fmt::format("{} has no layer '{}'.{} ({})", what, wanted, did_you_mean(wanted, names), listed(names)));
        }
        refuse_if<BadInput>(!may_hold_lines(**at), "{}, layer {}: it holds {}, not lines", what, wanted,
                            OGRGeometryTypeToName(wkbFlatten((*at)->GetGeomType())));
        return **at;
    }
    std::vector<OGRLayer*> const lines = line_layers(data, what);
    auto const rank = [](OGRLayer* layer) { return rank_of(layer->GetName()); };
    OGRLayer* const best = *std::ranges::min_element(lines, {}, rank);
    if (std::ranges::count(lines, rank(best), rank) > 1) {
        throw BadInput(fmt::format("{} has {} layers with lines ({}): name the one with the rivers, "
                                   "--set network.lines.layer=NAME",
                                   what, lines.size(), listed(layer_names(lines))));
    }
    return *best;
}

namespace {

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
    refuse_if<IoError>(static_cast<bool>(error), "io.read_network: {}: {}", folder.string(), error.message());
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

} // namespace

RiverSource find_rivers(std::string const& path) {
    std::error_code ignored;
    RiverSource source{path, ""};
    while (source.path.size() > 1 && source.path.ends_with('/')) {
        source.path.pop_back();
    }
    bool const is_file = !names_database(path) && !path.starts_with("/vsi");
    refuse_if<BadInput>(is_file && !fs::exists(path, ignored), "io.find_rivers: {} does not exist", path);
    refuse_if<BadInput>(is_file && fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) == 0,
                        "io.find_rivers: {} is empty", path);
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
        throw BadInput(is_plain_folder ? fmt::format("io.find_rivers: {} holds no rivers: {}", path, why_not(path))
                                       : fmt::format("io.find_rivers: {} is not a file with lines that GDAL can read{}",
                                                     source.path, words.empty() ? "" : " (" + words + ")"));
    }
    refuse_if<BadInput>(data->GetLayerCount() == 0 && data->GetRasterCount() > 0,
                        "io.find_rivers: {} is a raster, not river lines", source.path);
    require_lines(*data, source.path, "io.find_rivers");
    source.layer = data->GetLayerByName("arcs") != nullptr ? "arcs" : "";
    return source;
}

// Files of a network.

namespace {

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
    refuse_if<BadInput>(whole, "io.read_network: {} is neither NAME_arcs.shp nor NAME_nodes.shp", path.string());
    return {path.string(), ""};
}

} // namespace

NetworkPlace find_network(std::string const& path, bool whole) {
    std::error_code ignored;
    fs::path file = path;
    bool const is_folder = !names_database(path) && fs::is_directory(file, ignored) && file.extension() != ".gdb";
    if (is_folder) {
        std::vector<std::string> const networks = networks_in(file, true);
        refuse_if<BadInput>(networks.size() != 1,
                            "io.read_network: {} holds {} files NAME_arcs.shp and no network.gpkg: name the file", path,
                            networks.size());
        file = networks.front();
    }
    bool const is_shapefile = lower_case(file.extension().string()) == ".shp";
    bool const is_pair = is_shapefile || (!whole && (ends_as(file, "arcs") || ends_as(file, "nodes")));
    return names_database(path) || !is_pair ? NetworkPlace{file.string(), file.string()}
                                            : pair_of(file, whole || is_folder);
}

NetworkSource open_network(std::string const& path, Driver const& driver) {
    std::string const what = "io.read_network: " + without_passwords(path);
    std::error_code ignored;
    refuse_if<BadInput>(!names_database(path) && !fs::exists(path, ignored), "{} does not exist", what);
    Dataset dataset = open_unchanged(path, GDAL_OF_VECTOR);
    if (dataset == nullptr) {
        std::string const words = driver.take();
        auto const say = [&](std::string_view part) { return words.find(part) != std::string::npos; };
        refuse_if<IoError>(say("database is locked") || say("readonly database"),
                           "{} is locked by another program, or was left in the middle of a change: close it there, or "
                           "open it once with the program that wrote it",
                           what);
        throw BadInput(fmt::format("{} cannot be read: {}", what, words));
    }
    return {what, std::move(dataset)};
}

// Layers of a network.

namespace {

Layer layer_of(NetworkSource const& source, OGRLayer& layer, std::string const& name) {
    return {&layer, fmt::format("{}, layer {}", source.what, name)};
}

[[noreturn]] void refuse_layer(NetworkSource const& source, std::string const& wanted) {
    throw BadInput(fmt::format("{} has no layer {} (there are {})", source.what, wanted,
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

} // namespace

void Layer::each(Driver const& driver, Run const& run, std::function<void(OGRFeature const&)> const& body) const {
    GIntBig const announced = layer->GetFeatureCount();
    GIntBig read = 0;
    for (auto const& feature : *layer) {
        run.check();
        body(*feature);
        ++read;
    }
    driver.check(what);
    refuse_if<IoError>(announced >= 0 && read != announced, "{}: {} of {} features could be read: the file is damaged",
                       what, read, announced);
}

Layer choose_arcs(NetworkSource const& source, Wish const& wish) {
    std::string const name = wish.arcs_layer.empty() ? "arcs" : wish.arcs_layer;
    if (OGRLayer* const layer = source.dataset->GetLayerByName(name.c_str())) {
        return layer_of(source, *layer, name);
    }
    if (!wish.arcs_layer.empty()) {
        refuse_layer(source, name);
    }
    std::vector<OGRLayer*> const all = layers_of(*source.dataset);
    std::vector<OGRLayer*> lines = all;
    std::erase_if(lines, [](OGRLayer* layer) { return !may_hold_lines(*layer); });
    refuse_if<BadInput>(wish.whole && (all.size() != 1 || lines.empty()), "{} has no layer arcs", source.what);
    if (lines.size() > 1) {
        std::vector<OGRLayer*> understood = lines;
        std::erase_if(understood, [](OGRLayer* layer) { return recognised(*layer).empty(); });
        lines = understood.size() == 1 ? understood : lines;
    }
    refuse_if<BadInput>(lines.empty(), "{} has no layer of lines (there are {})", source.what,
                        listed(layer_names(all)));
    refuse_if<BadInput>(lines.size() > 1, "{} has {} layers of lines; name one of them ({})", source.what, lines.size(),
                        listed(layer_names(lines)));
    return layer_of(source, *lines.front(), wish.whole ? "arcs" : lines.front()->GetName());
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
    refuse_if<BadInput>(
        found.empty(),
        "{}: its fields ({}) match no schema ({}); name the schema, or the fields that hold arc_id and ds_arc, or "
        "arc_id, from_node and to_node{}",
        arcs.what, listed(field_names(*arcs.layer)), what_tells(),
        field_names(*arcs.layer).empty() ? "; a shapefile without fields has lost its .dbf" : "");
    std::vector<std::string> names;
    for (Schema const schema : found) {
        names.emplace_back(table_of(schema).name);
    }
    throw BadInput(
        fmt::format("{}: its fields match several schemas ({}); name one of them", arcs.what, listed(names)));
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
