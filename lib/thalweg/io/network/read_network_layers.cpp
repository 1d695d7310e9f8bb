// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

bool is_shapefile(fs::path const& path) {
    return path.extension() == ".shp" || path.extension() == ".SHP";
}

bool is_database(std::string const& path) {
    return path.starts_with("PG:") || path.starts_with("postgresql:");
}

// "NAME_arcs" and "arcs" end in "arcs" and have their counterpart in "NAME_nodes" and "nodes".
bool ends_as(fs::path const& path, std::string_view layer) {
    std::string const stem = path.stem().string();
    return stem == layer || stem.ends_with(fmt::format("_{}", layer));
}

fs::path counterpart(fs::path const& path, std::string_view layer, std::string_view other) {
    std::string const stem = path.stem().string();
    return path.parent_path() /
           fmt::format("{}{}{}", stem.substr(0, stem.size() - layer.size()), other, path.extension().string());
}

NetworkPlace pair_of(fs::path const& path, bool whole) {
    std::error_code ignored;
    if (ends_as(path, "arcs")) {
        fs::path const nodes = counterpart(path, "arcs", "nodes");
        return {path.string(), whole || fs::exists(nodes, ignored) ? nodes.string() : ""};
    }
    if (ends_as(path, "nodes")) {
        return {counterpart(path, "nodes", "arcs").string(), path.string()};
    }
    if (whole) {
        throw BadInput(fmt::format("io.read_network: {} is neither NAME_arcs.shp nor NAME_nodes.shp", path.string()));
    }
    return {path.string(), ""};
}

// A line of GDAL's that says what is the matter with a database file, in our words.
[[noreturn]] void refuse(std::string const& what, std::string const& words) {
    auto const say = [&](std::string_view part) { return words.find(part) != std::string::npos; };
    refuse_if<IoError>(say("database is locked"), "{} is locked by another program; close it there and try again",
                       what);
    refuse_if<IoError>(say("readonly database"),
                       "{} was left in the middle of a change (there is a -journal beside it); open it once with the "
                       "program that wrote it",
                       what);
    throw BadInput(fmt::format("{} cannot be read: {}", what, words));
}

Dataset open(std::string const& path, std::string const& what, Driver const& driver) {
    bool const database = is_database(path);
    if (std::error_code ignored; !database && !fs::exists(path, ignored)) {
        throw BadInput(what + " does not exist");
    }
    Dataset dataset = open_undisturbed(path, GDAL_OF_VECTOR);
    if (dataset == nullptr) {
        refuse(what, driver.take());
    }
    return dataset;
}

} // namespace

NetworkPlace find_network(std::string const& path, bool whole) {
    std::error_code error;
    if (is_database(path)) {
        return {path, path};
    }
    fs::path const file = path;
    if (!fs::is_directory(file, error) || file.extension() == ".gdb") {
        bool const in_pairs = is_shapefile(file) || (!whole && (ends_as(file, "arcs") || ends_as(file, "nodes")));
        return in_pairs ? pair_of(file, whole) : NetworkPlace{path, path};
    }
    if (fs::path const gpkg = file / "network.gpkg"; fs::exists(gpkg, error)) {
        return {gpkg.string(), gpkg.string()};
    }
    std::vector<fs::path> found;
    for (auto const& entry : fs::directory_iterator(file, error)) {
        if (is_shapefile(entry.path()) && ends_as(entry.path(), "arcs")) {
            found.push_back(entry.path());
        }
    }
    if (error) {
        throw IoError(fmt::format("io.read_network: {}: {}", path, error.message()));
    }
    refuse_if<BadInput>(found.size() != 1,
                        "io.read_network: {} holds {} files NAME_arcs.shp and no network.gpkg: name the file", path,
                        found.size());
    return pair_of(found.front(), true);
}

NetworkSource::NetworkSource(std::string const& path, Driver const& driver)
    : what_("io.read_network: " + without_passwords(path)), dataset_(open(path, what_, driver)) {}

OGRLayer* NetworkSource::layer(std::string const& name) const {
    return dataset_->GetLayerByName(name.c_str());
}

std::vector<OGRLayer*> NetworkSource::layers() const {
    std::vector<OGRLayer*> found;
    for (OGRLayer* const layer : dataset_->GetLayers()) {
        found.push_back(layer);
    }
    return found;
}

namespace {

// Whether a layer's features may be lines.
bool may_hold_lines(OGRLayer& layer) {
    auto const flat = wkbFlatten(layer.GetGeomType());
    return flat == wkbUnknown || flat == wkbGeometryCollection || OGR_GT_IsSubClassOf(flat, wkbCurve) != 0 ||
           OGR_GT_IsSubClassOf(flat, wkbMultiCurve) != 0;
}

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    while (!text.empty()) {
        auto const end = std::min(text.find(' '), text.size());
        words.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return words;
}

// All of a text, blanks around it aside.
double number_in(std::string_view text) {
    auto const first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) {
        return nan;
    }
    text = text.substr(first, text.find_last_not_of(" \t") - first + 1);
    double value = nan;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? value : nan;
}

std::optional<std::int64_t> whole_in(double value) {
    constexpr double exact = 9007199254740992.0; // whole doubles are exact below 2^53
    if (!(std::fabs(value) < exact) || value != std::floor(value)) {
        return std::nullopt;
    }
    return static_cast<std::int64_t>(value);
}

std::string names_of(SchemaField const& field) {
    return fmt::format("{} {}", field.name, field.also);
}

std::vector<std::string> field_names(OGRLayer& layer) {
    std::vector<std::string> names;
    for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i) {
        names.emplace_back(layer.GetLayerDefn()->GetFieldDefn(i)->GetNameRef());
    }
    return names;
}

std::string names_of(std::vector<OGRLayer*> const& layers) {
    std::vector<std::string> names;
    for (OGRLayer* const layer : layers) {
        names.emplace_back(layer->GetName());
    }
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

Layer named(OGRLayer& layer, std::string const& what, std::string const& name) {
    return {&layer, fmt::format("{}, layer {}", what, name)};
}

// The schemas of which a layer has all the fields that tell it.
std::vector<Schema> recognised(OGRLayer& layer) {
    std::vector<Schema> found;
    for (SchemaTable const& table : all_schemas()) {
        if (std::ranges::all_of(table.told_by, [&](std::string_view names) {
                return FileColumn(layer, std::string(names)).is_there();
            })) {
            found.push_back(table.schema);
        }
    }
    return found;
}

// "native: arc_id, ...; taudem: ...", for a message: what recognised() looks for.
std::string what_tells() {
    std::vector<std::string> schemas;
    for (SchemaTable const& table : all_schemas()) {
        std::vector<std::string> fields;
        for (std::string_view const names : table.told_by) {
            fields.push_back(fmt::format("{}", fmt::join(words_of(names), " or ")));
        }
        schemas.push_back(fmt::format("{}: {}", table.name, fmt::join(fields, ", ")));
    }
    return fmt::format("{}", fmt::join(schemas, "; "));
}

// Whether fields that a user names make a schema needless.
bool is_enough(std::map<Quantity, std::string> const& mapped) {
    return mapped.contains(Quantity::arc_id) &&
           (mapped.contains(Quantity::ds_arc) ||
            (mapped.contains(Quantity::from_node) && mapped.contains(Quantity::to_node)));
}

} // namespace

FileColumn::FileColumn(OGRLayer& layer, std::string const& names) {
    for (std::string const& name : words_of(names)) {
        if (int const field = layer.GetLayerDefn()->GetFieldIndex(name.c_str()); field >= 0) {
            field_ = field;
            OGRFieldDefn const& definition = *layer.GetLayerDefn()->GetFieldDefn(field);
            is_text_ = definition.GetType() == OFTString;
            name_ = definition.GetNameRef();
            return;
        }
        if (EQUAL(name.c_str(), layer.GetFIDColumn())) {
            field_ = feature_id;
            name_ = name;
            return;
        }
    }
}

bool FileColumn::is_null(OGRFeature const& feature) const {
    return field_ == absent || (field_ >= 0 && feature.IsFieldSetAndNotNull(field_) == 0);
}

std::optional<std::int64_t> FileColumn::whole(OGRFeature const& feature) const {
    if (field_ == feature_id) {
        return feature.GetFID();
    }
    if (is_text_) {
        return whole_in(number_in(feature.GetFieldAsString(field_)));
    }
    if (feature.GetFieldDefnRef(field_)->GetType() == OFTReal) {
        return whole_in(feature.GetFieldAsDouble(field_));
    }
    return feature.GetFieldAsInteger64(field_);
}

double FileColumn::real(OGRFeature const& feature) const {
    if (is_null(feature)) {
        return nan;
    }
    if (field_ == feature_id) {
        return static_cast<double>(feature.GetFID());
    }
    return is_text_ ? number_in(feature.GetFieldAsString(field_)) : feature.GetFieldAsDouble(field_);
}

std::string FileColumn::text(OGRFeature const& feature) const {
    if (field_ == feature_id) {
        return fmt::format("{}", feature.GetFID());
    }
    return is_null(feature) ? "" : as_utf8(feature.GetFieldAsString(field_));
}

void FileColumn::require_numbers(OGRLayer& layer, std::string const& what, Notes& notes) const {
    if (field_ < 0) {
        return;
    }
    OGRFieldType const type = layer.GetLayerDefn()->GetFieldDefn(field_)->GetType();
    if (is_text_) {
        notes.add(what,
                  {"text_number", 0, {}, 0.0, fmt::format("field {} holds text, which is read as numbers", name_)});
    } else if (type != OFTInteger && type != OFTInteger64 && type != OFTReal) {
        throw BadInput(fmt::format("{}: field {} does not hold numbers, but {}; name another field", what, name_,
                                   OGRFieldDefn::GetFieldTypeName(type)));
    }
}

ArcColumns::ArcColumns(OGRLayer& layer, std::optional<Schema> schema, std::map<Quantity, std::string> const& mapped,
                       std::string const& what, Notes& notes) {
    SchemaTable const& table = table_of(schema.value_or(Schema::native));
    for (SchemaField const& field : table.fields) {
        if (field.quantity != Quantity::constant && schema && !has(field.quantity)) {
            columns_[field.quantity] = {FileColumn(layer, names_of(field)), &field};
        }
    }
    for (auto const& [quantity, name] : mapped) {
        FileColumn column(layer, name);
        if (!column.is_there()) {
            throw BadInput(fmt::format("{}: no field {}.{} (there are {})", what, name,
                                       did_you_mean(name, field_names(layer)), fields_of(layer)));
        }
        columns_[quantity] = {std::move(column), field_of(table, quantity)};
    }
    for (Told const& told : columns_.entries) {
        if (&told != &columns_[Quantity::type] && told.column.is_there()) {
            told.column.require_numbers(layer, what, notes);
        }
    }
}

double ArcColumns::real(OGRFeature const& feature, Quantity quantity) const {
    Told const& told = columns_[quantity];
    if (!told.column.is_there()) {
        return nan;
    }
    double const value = told.column.real(feature);
    if (told.field == nullptr) {
        return value;
    }
    return value == told.field->unknown ? nan : value * told.field->unit;
}

std::optional<std::int64_t> ArcColumns::none(Quantity quantity) const {
    SchemaField const* const field = columns_[quantity].field;
    return field == nullptr ? std::nullopt : whole_in(field->unknown);
}

std::string fields_of(OGRLayer& layer) {
    std::vector<std::string> const names = field_names(layer);
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

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

bool takes_any_lines(Wish const& wish) {
    return wish.any_lines && wish.fields.empty();
}

Layer choose_arcs(NetworkSource const& source, Wish const& wish) {
    std::string const& what = source.what();
    if (!wish.arcs_layer.empty()) {
        if (OGRLayer* const layer = source.layer(wish.arcs_layer)) {
            return named(*layer, what, wish.arcs_layer);
        }
        throw BadInput(
            fmt::format("{} has no layer {} (there are {})", what, wish.arcs_layer, names_of(source.layers())));
    }
    if (OGRLayer* const layer = source.layer("arcs")) {
        return named(*layer, what, "arcs");
    }
    std::vector<OGRLayer*> lines = source.layers();
    refuse_if<BadInput>(wish.whole && (lines.size() != 1 || !may_hold_lines(*lines.front())), "{} has no layer arcs",
                        what);
    std::erase_if(lines, [](OGRLayer* layer) { return !may_hold_lines(*layer); });
    if (lines.size() > 1) {
        std::vector<OGRLayer*> understood = lines;
        std::erase_if(understood, [](OGRLayer* layer) { return recognised(*layer).empty(); });
        lines = understood.size() == 1 ? understood : lines;
    }
    if (lines.size() != 1) {
        throw BadInput(
            lines.empty()
                ? fmt::format("{} has no layer of lines (there are {})", what, names_of(source.layers()))
                : fmt::format("{} has {} layers of lines; name one of them ({})", what, lines.size(), names_of(lines)));
    }
    return named(*lines.front(), what, wish.whole ? "arcs" : lines.front()->GetName());
}

std::optional<Schema> choose_schema(Layer const& arcs, Wish const& wish) {
    if (wish.schema) {
        return wish.schema;
    }
    auto const found = recognised(*arcs.layer);
    // Thalweg's own files hold the columns of the user's beside theirs.
    if (std::ranges::find(found, Schema::native) != found.end()) {
        return Schema::native;
    }
    if (found.size() == 1) {
        return found.front();
    }
    if (is_enough(wish.fields) || (found.empty() && takes_any_lines(wish))) {
        return std::nullopt;
    }
    std::vector<std::string_view> names;
    for (Schema const schema : found) {
        names.push_back(table_of(schema).name);
    }
    if (found.empty()) {
        throw BadInput(fmt::format(
            "{}: its fields ({}) match no schema ({}); name the schema, or the fields "
            "that hold arc_id and ds_arc, or arc_id, from_node and to_node{}",
            arcs.what, fields_of(*arcs.layer), what_tells(),
            arcs.layer->GetLayerDefn()->GetFieldCount() == 0 ? "; a shapefile without fields has lost its .dbf" : ""));
    }
    throw BadInput(
        fmt::format("{}: its fields match several schemas ({}); name one of them", arcs.what, fmt::join(names, ", ")));
}

std::optional<Layer> choose_nodes(NetworkSource const* source, NetworkSource const& arcs_source, Layer const& arcs,
                                  std::optional<Schema> schema, Wish const& wish) {
    if (!wish.nodes_layer.empty()) {
        for (NetworkSource const* const place : {source, &arcs_source}) {
            if (OGRLayer* const layer = place == nullptr ? nullptr : place->layer(wish.nodes_layer)) {
                return named(*layer, place->what(), wish.nodes_layer);
            }
        }
        throw BadInput(fmt::format("{} has no layer {} (there are {})", arcs_source.what(), wish.nodes_layer,
                                   names_of(arcs_source.layers())));
    }
    if (source == nullptr || (schema ? schema != Schema::native : takes_any_lines(wish))) {
        return std::nullopt;
    }
    if (OGRLayer* const layer = source->layer("nodes")) {
        return named(*layer, source->what(), "nodes");
    }
    auto const layers = source->layers();
    bool const own_file = layers.size() == 1 && layers.front() != arcs.layer;
    return own_file ? std::optional(named(*layers.front(), source->what(), "nodes")) : std::nullopt;
}

} // namespace thalweg::io
