// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_rivers.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/network/internal/line_features.hpp>
#include <thalweg/io/network/internal/river_fields.hpp>

namespace thalweg::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(std::string const& text) {
    throw BadInput("io.find_rivers: " + text);
}

/// The file with the rivers of a folder that thalweg wrote; "" where it is no such folder.
std::string network_in(fs::path const& folder) {
    if (fs::path const file = folder / "network.gpkg"; fs::exists(file)) {
        return file.string();
    }
    std::vector<fs::path> arcs;
    std::vector<fs::path> packages;
    for (auto const& entry : fs::directory_iterator(folder)) {
        std::string const ending = entry.path().extension().string();
        bool const of_layers = ending == ".shp" || ending == ".fgb" || ending == ".geojson";
        if (of_layers && entry.path().stem().string().ends_with("_arcs")) {
            arcs.push_back(entry.path());
        } else if (ending == ".gpkg") {
            packages.push_back(entry.path());
        }
    }
    if (arcs.empty() && !fs::exists(folder / "recipe.toml")) { // whose only package would hold contours
        arcs = std::move(packages);
    }
    return arcs.size() == 1 ? arcs.front().string() : "";
}

/// Why a folder that GDAL does not open holds no rivers.
std::string why_not(fs::path const& folder) {
    if (fs::is_empty(folder)) {
        return "the folder is empty";
    }
    if (fs::exists(folder / "recipe.toml")) {
        return "its terrain has no rivers; to make it again, give its recipe.toml";
    }
    return "it holds neither network.gpkg, nor one other GeoPackage, nor shapefiles; name a file in it";
}

bool names_database(std::string const& path) {
    return path.starts_with("PG:") || path.starts_with("postgresql:");
}

} // namespace

RiverSource find_rivers(std::string const& path) {
    std::error_code ignored;
    RiverSource source{path, ""};
    while (source.path.size() > 1 && source.path.ends_with('/')) {
        source.path.pop_back();
    }
    bool const is_file = !names_database(path) && !path.starts_with("/vsi");
    if (is_file && !fs::exists(path, ignored)) {
        refuse(fmt::format("{} does not exist", path));
    }
    bool const is_folder = is_file && fs::is_directory(path, ignored);
    if (is_file && !is_folder && fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) == 0) {
        refuse(path + " is empty");
    }
    if (is_folder) {
        if (std::string const network = network_in(source.path); !network.empty()) {
            source.path = network;
        }
    }
    Driver const driver;
    Dataset const data = open_undisturbed(source.path, GDAL_OF_VECTOR | GDAL_OF_RASTER);
    if (!data) {
        std::string const words = driver.take();
        refuse(is_folder && source.path.size() <= path.size()
                   ? fmt::format("{} holds no rivers: {}", path, why_not(path))
                   : fmt::format("{} is not a file with lines that GDAL can read{}", source.path,
                                 words.empty() ? "" : " (" + words + ")"));
    }
    if (data->GetLayerCount() == 0 && data->GetRasterCount() > 0) {
        refuse(fmt::format("{} is a raster, not river lines", source.path));
    }
    require_lines(*data, source.path, "io.find_rivers");
    source.layer = data->GetLayerByName("arcs") != nullptr ? "arcs" : "";
    return source;
}

namespace {

[[noreturn]] void refuse_rivers(std::string const& text) {
    throw BadInput("io.read_rivers: " + text);
}

std::string listed(std::vector<std::string> const& names) {
    std::string text;
    for (auto const& name : names) {
        text += (text.empty() ? "" : ", ") + name;
    }
    return text;
}

// " Did you mean 'x'? (x, y, z)"
std::string suggestion(std::string const& wanted, std::vector<std::string> const& names) {
    if (names.empty()) {
        return "";
    }
    return did_you_mean(wanted, names) + " (" + listed(names) + ")";
}

std::vector<std::string> field_names(OGRFeatureDefn& schema) {
    std::vector<std::string> names;
    for (int i = 0; i < schema.GetFieldCount(); ++i) {
        names.emplace_back(schema.GetFieldDefn(i)->GetNameRef());
    }
    return names;
}

// -1 when it may be missing and is.
int find_field(OGRLayer& layer, std::string const& field, bool may_miss, std::string const& name) {
    int const index = layer.GetLayerDefn()->GetFieldIndex(field.c_str());
    if (index < 0 && !may_miss) {
        refuse_rivers(fmt::format("layer {} of {} has no field '{}'.{}", layer.GetName(), name, field,
                                  suggestion(field, field_names(*layer.GetLayerDefn()))));
    }
    return index;
}

int find_rank_field(OGRLayer& layer, ReadRiversParams const& params, std::string const& name) {
    bool const is_default = params.rank_field.empty();
    int const index = find_field(layer, is_default ? "hydroseq" : params.rank_field, is_default, name);
    if (index < 0) {
        return index;
    }
    auto const type = layer.GetLayerDefn()->GetFieldDefn(index)->GetType();
    bool const is_number = type == OFTInteger || type == OFTInteger64 || type == OFTReal;
    if (!is_number && !is_default) {
        refuse_rivers(
            fmt::format("field {} of {} is not a number field: it cannot rank rivers", params.rank_field, name));
    }
    return is_number ? index : -1;
}

std::int64_t rank_of(OGRFeature const& feature, int field, std::int64_t number, std::string const& name) {
    if (field < 0 || feature.IsFieldSetAndNotNull(field) == 0) {
        return 0;
    }
    double const value = feature.GetFieldAsDouble(field);
    if (!(std::fabs(value) < 9e15) || value != std::floor(value)) { // beyond, doubles leave out whole numbers
        refuse_rivers(fmt::format("feature {} of {} has the rank {}: a whole number is required", number, name, value));
    }
    return feature.GetFieldAsInteger64(field);
}

// A text counts when all of it is a number.
double number_in(OGRFeature const& feature, int field) {
    auto const type = feature.GetFieldDefnRef(field)->GetType();
    if (type == OFTInteger || type == OFTInteger64 || type == OFTReal) {
        return feature.GetFieldAsDouble(field);
    }
    std::string const text = feature.GetFieldAsString(field);
    double value = std::numeric_limits<double>::quiet_NaN();
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? value : std::numeric_limits<double>::quiet_NaN();
}

int lambda_of(OGRFeature const& feature, int field, RiverLine const& line, std::string const& name) {
    if (field < 0 || feature.IsFieldSetAndNotNull(field) == 0) {
        return 0;
    }
    double const value = number_in(feature, field);
    if (!(value >= 1.0 && value <= 50.0) || value != std::floor(value)) {
        refuse_rivers(
            fmt::format("feature {} of {}, which begins at ({}, {}), has the {} '{}': a whole number from 1 to 50 "
                        "is required, or none",
                        line.feature, name, line.vertices.front().x, line.vertices.front().y,
                        feature.GetFieldDefnRef(field)->GetNameRef(), feature.GetFieldAsString(field)));
    }
    return static_cast<int>(value);
}

// One line for each part that is one.
void add_lines(OGRGeometry const& geometry, RiverLine const& feature, std::string const& name,
               std::vector<RiverLine>& lines, OtherShapes& others) {
    auto const flat = wkbFlatten(geometry.getGeometryType());
    if (OGR_GT_IsSubClassOf(flat, wkbGeometryCollection) != 0) {
        for (auto const* const part : *geometry.toGeometryCollection()) {
            add_lines(*part, feature, name, lines, others);
        }
        return;
    }
    if (flat != wkbLineString) {
        others.add(geometry, feature.feature);
        return;
    }
    auto const& drawn = *geometry.toLineString();
    RiverLine line = feature;
    for (int i = 0; i < drawn.getNumPoints(); ++i) {
        double const x = drawn.getX(i);
        double const y = drawn.getY(i);
        double const z = drawn.Is3D() != 0 ? drawn.getZ(i) : std::numeric_limits<double>::quiet_NaN();
        if (!std::isfinite(x) || !std::isfinite(y) || std::isinf(z)) {
            refuse_rivers(fmt::format("vertex {} of feature {} of {} is not finite: ({}, {}, {}); correct the file",
                                      i + 1, feature.feature, name, x, y, z));
        }
        line.vertices.push_back({x, y, z});
    }
    bool const has_length = std::ranges::any_of(
        line.vertices, [&](Vec3 v) { return v.x != line.vertices.front().x || v.y != line.vertices.front().y; });
    if (has_length) {
        lines.push_back(std::move(line));
    }
}

// A feature that holds no line.
Finding left_out(std::int64_t feature, OGRGeometry const* drawn) {
    OGREnvelope box;
    if (drawn != nullptr && drawn->IsEmpty() == 0) {
        drawn->getEnvelope(&box);
    }
    return {"left_out",
            feature,
            {box.IsInit() != 0 ? box.MinX : 0.0, box.IsInit() != 0 ? box.MinY : 0.0},
            0.0,
            fmt::format("feature {} {}; it is left out", feature,
                        drawn == nullptr ? "has no geometry" : "has no line of any length")};
}

// Where lines of the layer go, in its coordinates.
struct Read {
    std::vector<RiverLine> lines;
    std::vector<RiverLine> unnatural;
    std::vector<RiverFields::Unnatural> why; ///< of these
    std::vector<bool> coasts;                ///< likewise
    OtherShapes others;
    std::vector<Finding> findings;
    AttributeTable attributes;
};

Read read_lines(OGRLayer& layer, ReadRiversParams const& params, std::string const& name, Run const& run) {
    int const type_field =
        params.type_field.empty() ? -1 : find_field(layer, params.type_field, params.type_field == "rosgen", name);
    int const rank_field = find_rank_field(layer, params, name);
    int const lambda_field = params.lambda_field.empty()
                                 ? -1
                                 : find_field(layer, params.lambda_field, params.lambda_field == "lambda", name);
    auto const link_field = [&](std::string const& field) {
        return field.empty() ? -1 : find_field(layer, field, false, name);
    };
    RiverFields fields(layer, link_field(params.id_field), link_field(params.down_field));
    AttributeReader attributes(layer);
    Read read;
    std::int64_t number = 0;
    for (auto const& feature : layer) {
        run.check();
        RiverLine line;
        line.feature = ++number;
        line.rank = rank_of(*feature, rank_field, number, name);
        if (type_field >= 0 && feature->IsFieldSetAndNotNull(type_field) != 0) {
            line.type = as_utf8(feature->GetFieldAsString(type_field));
        }
        fields.read(*feature, line);
        attributes.read(*feature);
        OGRGeometry const* const drawn = feature->GetGeometryRef();
        RiverFields::Unnatural const why =
            params.filter == LineFilter::natural ? fields.unnatural(*feature) : RiverFields::Unnatural();
        auto& lines = why.reason.empty() ? read.lines : read.unnatural;
        std::size_t const first = lines.size();
        std::int64_t const others = read.others.count();
        if (drawn != nullptr && drawn->IsEmpty() == 0) {
            std::unique_ptr<OGRGeometry> const straight(drawn->getLinearGeometry());
            add_lines(*straight, line, name, lines, read.others);
        }
        if (lines.size() == first && read.others.count() == others) {
            read.findings.push_back(left_out(number, drawn));
        }
        for (std::size_t k = first; k < lines.size(); ++k) {
            lines[k].lambda = lambda_of(*feature, lambda_field, lines[first], name);
        }
        read.why.resize(read.unnatural.size(), why);
        read.coasts.resize(read.unnatural.size(), !why.reason.empty() && fields.is_coast(*feature));
    }
    fields.link(read.lines);
    fields.link(read.unnatural);
    for (std::vector<Finding> const& more : {read.others.findings(), attributes.findings()}) {
        read.findings.insert(read.findings.begin(), more.begin(), more.end());
    }
    read.attributes = attributes.take();
    return read;
}

FileBox extent_of(std::vector<RiverLine> const& lines) {
    FilePlaces places;
    for (auto const& line : lines) {
        for (auto const& v : line.vertices) {
            places.add(v.x, v.y);
        }
    }
    return places.box();
}

void bring(std::vector<RiverLine>& lines, IntoMetres const& metres, std::string const& name, Driver const& driver,
           Run const& run) {
    for (auto& line : lines) {
        run.check();
        auto const done = metres.apply(line.vertices);
        for (std::size_t i = 0; i < done.size(); ++i) {
            auto const& v = line.vertices[i];
            if (done[i] == 0) {
                refuse_rivers(fmt::format("vertex {} of feature {} of {}, ({}, {}), cannot be reprojected to {}: {}",
                                          i + 1, line.feature, name, v.x, v.y, metres.crs(), driver.take()));
            }
        }
    }
}

void bring(std::vector<Finding>& findings, IntoMetres const& metres) {
    for (Finding& finding : findings) {
        Vec3 at{finding.where.x, finding.where.y, 0.0};
        bool const has_place = finding.where.x != 0.0 || finding.where.y != 0.0;
        finding.where = has_place && metres.apply({&at, 1}).front() != 0 ? Vec2{at.x, at.y} : Vec2{};
    }
}

std::string nothing_left(Read const& read, std::string const& what) {
    if (!read.unnatural.empty()) {
        return fmt::format("{} holds no natural watercourse: {} lines are left out, the first of them for its {}; set "
                           "network.lines.filter = \"none\" to take them all",
                           what, read.unnatural.size(), read.why.front().reason);
    }
    auto const why = std::ranges::find_if(
        read.findings, [](Finding const& f) { return f.kind == "not_a_line" || f.kind == "left_out"; });
    if (why != read.findings.end()) {
        return fmt::format("{} holds no line: {}", what, why->text);
    }
    return what + " is empty";
}

// As coarse as what was projected: a millionth of a metre.
bool have_heights(std::vector<RiverLine> const& lines) {
    double const first = lines.front().vertices.front().z;
    bool differ = false;
    for (auto const& line : lines) {
        for (auto const& v : line.vertices) {
            if (std::isnan(v.z)) {
                return false;
            }
            differ = differ || v.z != first;
        }
    }
    return differ;
}

} // namespace

RiverLines read_rivers(ReadRiversParams const& params, Run const& run) {
    if (params.id_field.empty() != params.down_field.empty()) {
        throw BadParameter(fmt::format("io.read_rivers: the field '{}' is named without its other half: links need the "
                                       "field of a line's id and that of the id downstream",
                                       params.id_field.empty() ? params.down_field : params.id_field));
    }
    std::string const& path = params.path.path;
    Driver const driver;
    auto const name = std::filesystem::path(path).filename().string();
    Dataset const data = open_undisturbed(params.path, GDAL_OF_VECTOR);
    if (!data) {
        auto const words = driver.take();
        VSIStatBufL status;
        if (path.empty() || VSIStatL(path.c_str(), &status) != 0) {
            refuse_rivers(fmt::format("there is no file '{}'{}", path, words.empty() ? "" : " (" + words + ")"));
        }
        refuse_rivers(path + " is not a vector file that GDAL can read (" + words + ")");
    }
    OGRLayer& layer = rivers_layer(*data, params.layer, name, "io.read_rivers");
    RiverLines rivers;
    rivers.name = name;
    Read read = read_lines(layer, params, name, run);
    driver.check("io.read_rivers: " + path);
    if (read.lines.empty()) {
        refuse_rivers(nothing_left(read, fmt::format("layer {} of {}", layer.GetName(), name)));
    }
    rivers.lines = std::move(read.lines);
    rivers.findings = std::move(read.findings);
    rivers.attributes = std::move(read.attributes);
    std::string const source_crs = params.source_crs.value_or("");
    OGRSpatialReference const own = crs_of_layer(layer.GetSpatialRef(), source_crs);
    if (own.IsEmpty() != 0) {
        refuse_rivers(fmt::format("layer {} of {} has no CRS; assign one (ogr2ogr -a_srs EPSG:n){}", layer.GetName(),
                                  name, params.source_crs ? " or name it (--source-crs EPSG:n)" : ""));
    }
    IntoMetres const metres(own, params.crs, extent_of(rivers.lines), name);
    rivers.crs = metres.crs();
    double const unit = height_unit_of(layer, source_crs);
    for (auto* const lines : {&rivers.lines, &read.unnatural}) {
        bring(*lines, metres, name, driver, run);
        for (auto& line : *lines) {
            for (auto& v : line.vertices) {
                v = {rounded(v.x), rounded(v.y), unit * v.z};
            }
        }
    }
    for (std::size_t k = 0; k < read.unnatural.size(); ++k) {
        if (!read.coasts[k] && read.why[k].is_channel) {
            read.unnatural[k].artificial = std::move(read.why[k].reason);
            rivers.channels.push_back(std::move(read.unnatural[k]));
            continue;
        }
        rivers.secondary.push_back({read.unnatural[k].feature, std::move(read.unnatural[k].vertices),
                                    std::move(read.why[k].reason), read.unnatural[k].feature,
                                    read.coasts[k] ? LeftOut::coast : LeftOut::filter});
    }
    bring(rivers.findings, metres);
    rivers.has_z = have_heights(rivers.lines);
    return rivers;
}

} // namespace thalweg::io
