// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/line_features.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string_view>

#include <cpl_port.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/network/schema.hpp>

namespace thalweg::io {
namespace {

enum class Holds : std::uint8_t { lines, other, nothing };

bool is_line(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbCurve) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiCurve) != 0;
}

// A layer of any shapes holds lines when one of its first features is one: exports of OpenStreetMap begin with nodes.
Holds content_of(OGRLayer& layer, std::string const& what) {
    constexpr int most_features = 1000000;
    auto const type = wkbFlatten(layer.GetGeomType());
    if (type != wkbUnknown && !is_line(type)) {
        return type == wkbGeometryCollection ? Holds::lines : Holds::other;
    }
    Driver const driver;
    Holds holds = Holds::nothing;
    layer.ResetReading();
    for (int i = 0; i < most_features && holds != Holds::lines; ++i) {
        OGRFeatureUniquePtr const feature(layer.GetNextFeature());
        if (!feature) {
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

/// How clearly a name says that a layer holds the rivers: 0 most; anything else is more than any.
std::size_t rank_of(std::string_view name) {
    // thalweg; NHD and NHDPlus HR; EU-Hydro; OpenStreetMap; OS Open Rivers; and what people call them.
    static constexpr std::array exact{"arcs",      "nhdflowline", "networknhdflowline", "nhdflowlinenetwork",
                                      "rivernetl", "waterways",   "watercourselink"};
    static constexpr std::array parts{"hydrorivers", "flowline", "waterway", "watercourse", "river", "stream"};
    std::string const own = simple_name(name);
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (own == exact[i]) {
            return i;
        }
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (own.find(parts[i]) != std::string::npos && own.find("catchment") == std::string::npos &&
            own.find("nonnetwork") == std::string::npos) {
            return exact.size() + i;
        }
    }
    return exact.size() + parts.size();
}

std::vector<std::string> layer_names_of(std::vector<OGRLayer*> const& layers) {
    std::vector<std::string> names;
    for (OGRLayer* const layer : layers) {
        names.emplace_back(layer->GetName());
    }
    return names;
}

OGRLayer& named(std::vector<OGRLayer*> const& layers, std::string const& wanted, std::string const& what) {
    auto const at = std::ranges::find_if(layers, [&](OGRLayer* layer) { return layer->GetName() == wanted; });
    if (at == layers.end()) {
        auto const names = layer_names_of(layers);
        throw BadInput(fmt::format(
            "{} has no layer '{}'.{}", what, wanted,
            names.empty() ? "" : fmt::format("{} ({})", did_you_mean(wanted, names), fmt::join(names, ", "))));
    }
    auto const type = wkbFlatten((*at)->GetGeomType());
    if (type != wkbUnknown && type != wkbGeometryCollection && !is_line(type)) {
        throw BadInput(fmt::format("{}, layer {}: it holds {}, not lines", what, wanted, OGRGeometryTypeToName(type)));
    }
    return **at;
}

struct LineLayers {
    std::vector<OGRLayer*> lines;
    std::vector<OGRLayer*> empty; ///< that may get some
};

LineLayers line_layers(GDALDataset& data, std::string const& what) {
    LineLayers found;
    std::vector<OGRLayer*> all;
    for (OGRLayer* const layer : data.GetLayers()) {
        all.push_back(layer);
        Holds const holds = content_of(*layer, what);
        if (holds != Holds::other) {
            (holds == Holds::lines ? found.lines : found.empty).push_back(layer);
        }
    }
    if (found.lines.empty() && found.empty.empty()) {
        throw BadInput(fmt::format("{} has no layer with lines{}", what,
                                   all.empty() ? "" : fmt::format(" ({})", fmt::join(layer_names_of(all), ", "))));
    }
    return found;
}

} // namespace

void require_lines(GDALDataset& data, std::string const& name, std::string const& who) {
    line_layers(data, who + ": " + name);
}

OGRLayer& rivers_layer(GDALDataset& data, std::string const& wanted, std::string const& name, std::string const& who) {
    std::string const what = who + ": " + name;
    if (!wanted.empty()) {
        std::vector<OGRLayer*> layers;
        for (OGRLayer* const layer : data.GetLayers()) {
            layers.push_back(layer);
        }
        return named(layers, wanted, what);
    }
    LineLayers const found = line_layers(data, what);
    std::vector<OGRLayer*> const& lines = found.lines.empty() ? found.empty : found.lines;
    auto const less = [](OGRLayer* a, OGRLayer* b) { return rank_of(a->GetName()) < rank_of(b->GetName()); };
    OGRLayer* const best = *std::ranges::min_element(lines, less);
    if (std::ranges::count_if(lines, [&](OGRLayer* l) { return !less(best, l); }) > 1) {
        throw BadInput(fmt::format("{} has {} layers with lines ({}): name the one with the rivers, "
                                   "--set network.lines.layer=NAME",
                                   what, lines.size(), fmt::join(layer_names_of(lines), ", ")));
    }
    return *best;
}

namespace {

std::vector<Vec3> vertices_of(OGRLineString const& line) {
    bool const has_z = line.Is3D() != 0;
    std::vector<Vec3> vertices;
    vertices.reserve(static_cast<std::size_t>(line.getNumPoints()));
    for (int i = 0; i < line.getNumPoints(); ++i) {
        vertices.push_back(
            {line.getX(i), line.getY(i), has_z ? line.getZ(i) : std::numeric_limits<double>::quiet_NaN()});
    }
    return vertices;
}

// Adds the parts that are lines.
void add_parts(OGRGeometry const& shape, std::int64_t feature, std::vector<std::vector<Vec3>>& parts,
               OtherShapes& others) {
    auto const flat = wkbFlatten(shape.getGeometryType());
    if (flat == wkbLineString) {
        if (shape.IsEmpty() == 0) {
            parts.push_back(vertices_of(*shape.toLineString()));
        }
        return;
    }
    if (flat != wkbMultiLineString && flat != wkbGeometryCollection) {
        others.add(shape, feature);
        return;
    }
    for (auto const* const part : *shape.toGeometryCollection()) {
        add_parts(*part, feature, parts, others);
    }
}

using Place = std::pair<double, double>;

Place begin_of(std::vector<Vec3> const& part) {
    return {part.front().x, part.front().y};
}

Place end_of(std::vector<Vec3> const& part) {
    return {part.back().x, part.back().y};
}

// The parts one after the other, each beginning where the last ends; empty when there is no such order, or several.
std::vector<std::size_t> order_of(std::vector<std::vector<Vec3>> const& parts) {
    std::map<Place, std::size_t> begins;
    std::map<Place, std::size_t> ends;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        bool const placed = std::isfinite(begin_of(parts[i]).first) && std::isfinite(begin_of(parts[i]).second) &&
                            std::isfinite(end_of(parts[i]).first) && std::isfinite(end_of(parts[i]).second);
        if (!placed || !begins.emplace(begin_of(parts[i]), i).second || !ends.emplace(end_of(parts[i]), i).second) {
            return {};
        }
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < parts.size() && order.empty(); ++i) {
        if (!ends.contains(begin_of(parts[i]))) {
            order.push_back(i);
        }
    }
    while (!order.empty() && order.size() < parts.size()) {
        auto const next = begins.find(end_of(parts[order.back()]));
        if (next == begins.end()) {
            return {};
        }
        order.push_back(next->second);
    }
    return order;
}

void join(std::vector<std::vector<Vec3>>& parts) {
    auto const order = order_of(parts);
    if (order.empty()) {
        return;
    }
    std::vector<Vec3> line = std::move(parts[order.front()]);
    for (std::size_t k = 1; k < order.size(); ++k) {
        auto const& part = parts[order[k]];
        line.insert(line.end(), part.begin() + 1, part.end());
    }
    parts.clear();
    parts.push_back(std::move(line));
}

} // namespace

void OtherShapes::add(OGRGeometry const& shape, std::int64_t feature) {
    Type& type = types_[OGRGeometryTypeToName(wkbFlatten(shape.getGeometryType()))];
    if (type.count++ == 0) {
        OGREnvelope box;
        shape.getEnvelope(&box);
        type.first = feature;
        type.where = box.IsInit() != 0 ? Vec2{box.MinX, box.MinY} : Vec2{};
    }
}

std::int64_t OtherShapes::count() const {
    std::int64_t count = 0;
    for (auto const& [name, type] : types_) {
        count += type.count;
    }
    return count;
}

std::vector<Finding> OtherShapes::findings() const {
    std::vector<Finding> findings;
    for (auto const& [name, type] : types_) {
        findings.push_back(
            {"not_a_line", 0, type.where, static_cast<double>(type.count),
             type.count == 1
                 ? fmt::format("1 shape of type {} is not a line and is skipped; it is in feature {}", name, type.first)
                 : fmt::format("{} shapes of type {} are not lines and are skipped; the first is in feature {}",
                               type.count, name, type.first)});
    }
    return findings;
}

DrawnLine drawn_line(OGRGeometry const* shape, std::int64_t feature, OtherShapes& others) {
    DrawnLine line;
    if (shape == nullptr) {
        line.parts.emplace_back();
        return line;
    }
    std::unique_ptr<OGRGeometry> straight;
    line.curved = shape->hasCurveGeometry(TRUE) != 0;
    if (shape->hasCurveGeometry(FALSE) != 0) { // also of types for curves that hold straight parts alone
        straight.reset(shape->getLinearGeometry());
        shape = straight.get();
    }
    std::int64_t const before = others.count();
    add_parts(*shape, feature, line.parts, others);
    line.is_line = !line.parts.empty() || others.count() == before;
    if (!line.is_line) {
        return line;
    }
    line.has_z = shape->Is3D() != 0 && !line.parts.empty();
    line.has_m = shape->IsMeasured() != 0;
    line.drawn_parts = static_cast<int>(line.parts.size());
    if (line.parts.size() > 1) {
        join(line.parts);
    }
    if (line.parts.empty()) {
        line.parts.emplace_back();
    }
    return line;
}

namespace {

using AttributeType = AttributeTable::Type;

// Nothing for a type that no table here has.
bool attribute_type(OGRFieldType type, AttributeType& result) {
    switch (type) {
    case OFTInteger: result = AttributeType::integer; return true;
    case OFTInteger64: result = AttributeType::integer64; return true;
    case OFTReal: result = AttributeType::real; return true;
    case OFTString: result = AttributeType::text; return true;
    case OFTDate: result = AttributeType::date; return true;
    case OFTTime: result = AttributeType::time; return true;
    case OFTDateTime: result = AttributeType::datetime; return true;
    default: result = AttributeType::text; return false;
    }
}

bool is_of_schema(std::string const& name) {
    return name == "z_unit" || std::ranges::any_of(table_of(Schema::native).fields, [&](SchemaField const& field) {
               return EQUAL(std::string(field.name).c_str(), name.c_str());
           });
}

AttributeTable::Value attribute_value(OGRFeature const& feature, int field, AttributeType type) {
    if (feature.IsFieldSetAndNotNull(field) == 0) {
        return {};
    }
    switch (type) {
    case AttributeType::integer:
    case AttributeType::integer64: return static_cast<std::int64_t>(feature.GetFieldAsInteger64(field));
    case AttributeType::real: {
        double const value = feature.GetFieldAsDouble(field);
        return std::isfinite(value) ? AttributeTable::Value(value) : AttributeTable::Value();
    }
    default: return as_utf8(feature.GetFieldAsString(field));
    }
}

} // namespace

bool is_in_network_schema(OGRLayer& layer) {
    OGRFeatureDefn& schema = *layer.GetLayerDefn();
    return std::ranges::all_of(table_of(Schema::native).told_by, [&](std::string_view name) {
        return schema.GetFieldIndex(std::string(name).c_str()) >= 0;
    });
}

AttributeReader::AttributeReader(OGRLayer& layer) {
    bool const is_ours = is_in_network_schema(layer);
    OGRFeatureDefn& schema = *layer.GetLayerDefn();
    for (int i = 0; i < schema.GetFieldCount(); ++i) {
        OGRFieldDefn const& field = *schema.GetFieldDefn(i);
        std::string const name = printable(field.GetNameRef());
        if (is_ours && is_of_schema(name)) {
            continue;
        }
        AttributeTable::Column column{name, AttributeType::text};
        if (!attribute_type(field.GetType(), column.type)) {
            findings_.push_back({"as_text",
                                 0,
                                 {},
                                 1.0,
                                 fmt::format("field {} holds {}: its values are kept as text", name,
                                             OGRFieldDefn::GetFieldTypeName(field.GetType()))});
        }
        fields_.push_back(i);
        table_.columns.push_back(std::move(column));
    }
}

void AttributeReader::read(OGRFeature const& feature) {
    auto& row = table_.rows.emplace_back();
    row.reserve(fields_.size());
    for (std::size_t c = 0; c < fields_.size(); ++c) {
        row.push_back(attribute_value(feature, fields_[c], table_.columns[c].type));
        bool const is_text = std::holds_alternative<std::string>(row.back());
        escaped_ += is_text && !is_utf8(feature.GetFieldAsString(fields_[c])) ? 1 : 0;
    }
}

std::vector<Finding> AttributeReader::findings() const {
    std::vector<Finding> all = findings_;
    if (escaped_ > 0) {
        all.push_back({"not_utf8",
                       0,
                       {},
                       static_cast<double>(escaped_),
                       fmt::format("{} values are not UTF-8: their bytes are kept as \\xNN; name their encoding (of a "
                                   "shapefile, in a file .cpg beside it)",
                                   escaped_)});
    }
    return all;
}

} // namespace thalweg::io
