// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <system_error>

#include <cpl_port.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    while (!text.empty()) {
        auto const end = std::min(text.find(' '), text.size());
        words.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return words;
}

std::vector<std::string> names_of(SchemaField const& field) {
    std::vector<std::string> names = words_of(field.also);
    names.insert(names.begin(), std::string(field.name));
    return names;
}

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

std::string listed(std::vector<std::string> const& names) {
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::string> field_names(OGRLayer& layer) {
    std::vector<std::string> names;
    for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i) {
        names.emplace_back(layer.GetLayerDefn()->GetFieldDefn(i)->GetNameRef());
    }
    return names;
}

namespace {

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

// In the order of AttributeTable::Type.
constexpr std::array<OGRFieldType, 7> attribute_types{OFTInteger, OFTInteger64, OFTReal,    OFTString,
                                                      OFTDate,    OFTTime,      OFTDateTime};

bool is_of_schema(std::string const& name) {
    return name == "z_unit" || std::ranges::any_of(table_of(Schema::native).fields, [&](SchemaField const& field) {
               return field.name == lower_case(name);
           });
}

AttributeTable::Value attribute_value(OGRFeature const& feature, int field, AttributeTable::Type type) {
    if (feature.IsFieldSetAndNotNull(field) == 0) {
        return {};
    }
    if (type == AttributeTable::Type::integer || type == AttributeTable::Type::integer64) {
        return static_cast<std::int64_t>(feature.GetFieldAsInteger64(field));
    }
    if (type == AttributeTable::Type::real) {
        double const value = feature.GetFieldAsDouble(field);
        return std::isfinite(value) ? AttributeTable::Value(value) : AttributeTable::Value();
    }
    return as_utf8(feature.GetFieldAsString(field));
}

using Kind = Column::Kind;

struct RiverColumns {
    RiverQuantity quantity;
    Kind kind;              ///< real: only columns of numbers are meant
    std::string_view names; ///< the first that a layer has counts; of sizes and classes all, compared in this order
};

constexpr std::array<RiverColumns, 8> river_columns{{
    // What a minor channel carries, areas, discharge, orders: NHDPlus, HydroRIVERS, MERIT-Basins, TauDEM, EU-Hydro,
    // GRASS.
    {RiverQuantity::size, Kind::real, "divdasqkm upland_skm uparea dis_av_cms ds_area dscontarea totdasqkm"},
    {RiverQuantity::size, Kind::real, "streamcalc streamorde streamorder ord_stra strahler strmorder"},
    {RiverQuantity::size, Kind::real, "stream_ord strord horton"},
    {RiverQuantity::river_class, Kind::real, "streamleve streamlevel ord_clas ord_flow hack"},
    {RiverQuantity::divergence, Kind::real, "divergence"}, // NHDPlus
    {RiverQuantity::calculated_order, Kind::real, "streamcalc"},
    {RiverQuantity::order, Kind::real, "streamorde streamorder"},
    {RiverQuantity::name, Kind::text, "name gnis_name nametxtint river_name rivername riv_name"},
}};

using Parts = std::vector<std::vector<Vec3>>;

void add_parts(OGRGeometry const& shape, std::int64_t feature, Parts& parts, OtherShapes& others) {
    auto const flat = wkbFlatten(shape.getGeometryType());
    if (OGR_GT_IsSubClassOf(flat, wkbGeometryCollection) != 0) {
        for (auto const* const part : *shape.toGeometryCollection()) {
            add_parts(*part, feature, parts, others);
        }
    } else if (flat != wkbLineString) {
        others.add(shape, feature);
    } else if (shape.IsEmpty() == 0) {
        OGRLineString const& drawn = *shape.toLineString();
        std::vector<Vec3>& line = parts.emplace_back();
        for (int i = 0; i < drawn.getNumPoints(); ++i) {
            line.push_back({drawn.getX(i), drawn.getY(i), drawn.Is3D() != 0 ? drawn.getZ(i) : nan});
        }
    }
}

// Joins parts that are one line when each begins where the last ends. They stay where there is no such order, or
// several.
void join(Parts& parts) {
    using Place = std::pair<double, double>;
    auto const begin_of = [](std::vector<Vec3> const& part) { return Place{part.front().x, part.front().y}; };
    auto const end_of = [](std::vector<Vec3> const& part) { return Place{part.back().x, part.back().y}; };
    std::map<Place, std::size_t> begins;
    std::map<Place, std::size_t> ends;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        bool const placed = is_finite(in_plan(parts[i].front())) && is_finite(in_plan(parts[i].back()));
        if (!placed || !begins.emplace(begin_of(parts[i]), i).second || !ends.emplace(end_of(parts[i]), i).second) {
            return;
        }
    }
    auto const first = std::ranges::find_if(parts, [&](auto const& part) { return !ends.contains(begin_of(part)); });
    if (first == parts.end()) {
        return;
    }
    std::vector<Vec3> line = *first;
    std::size_t joined = 1;
    for (auto next = begins.find(end_of(line)); next != begins.end(); next = begins.find(end_of(line))) {
        line.insert(line.end(), parts[next->second].begin() + 1, parts[next->second].end());
        ++joined;
    }
    if (joined == parts.size()) {
        parts = {std::move(line)};
    }
}

} // namespace

FileColumn::FileColumn(OGRLayer& layer, std::vector<std::string> const& names, bool or_feature_id) {
    for (std::string const& name : names) {
        if (int const field = layer.GetLayerDefn()->GetFieldIndex(name.c_str()); field >= 0) {
            OGRFieldDefn const& definition = *layer.GetLayerDefn()->GetFieldDefn(field);
            field_ = field;
            type_ = definition.GetType();
            name_ = definition.GetNameRef();
            return;
        }
        if (or_feature_id && EQUAL(name.c_str(), layer.GetFIDColumn())) {
            field_ = feature_id;
            type_ = OFTInteger64;
            name_ = name;
            return;
        }
    }
}

FileColumn FileColumn::with_tags(OGRLayer& layer) {
    return {layer, {"other_tags", "all_tags", "tags"}, false};
}

FileColumn FileColumn::of_tags(OGRLayer& layer, std::string const& key) {
    FileColumn column = with_tags(layer);
    if (!column.is_there() || FileColumn(layer, {key}, false).is_there()) {
        return {};
    }
    column.name_ = key;
    column.tag_ = key;
    column.type_ = OFTString;
    return column;
}

bool FileColumn::is_number() const {
    return type_ == OFTInteger || type_ == OFTInteger64 || type_ == OFTReal;
}

bool FileColumn::is_null(OGRFeature const& feature) const {
    return field_ == absent || (field_ >= 0 && feature.IsFieldSetAndNotNull(field_) == 0) ||
           (!tag_.empty() && text(feature).empty());
}

std::optional<std::int64_t> FileColumn::whole(OGRFeature const& feature) const {
    if (is_null(feature) || type_ == OFTString || type_ == OFTReal) {
        return whole_in(real(feature));
    }
    return field_ == feature_id ? feature.GetFID() : feature.GetFieldAsInteger64(field_);
}

double FileColumn::real(OGRFeature const& feature) const {
    if (is_null(feature)) {
        return nan;
    }
    if (field_ == feature_id) {
        return static_cast<double>(feature.GetFID());
    }
    return type_ == OFTString ? number_in(text(feature)) : feature.GetFieldAsDouble(field_);
}

std::string FileColumn::text(OGRFeature const& feature) const {
    if (field_ == feature_id) {
        return fmt::format("{}", feature.GetFID());
    }
    if (field_ == absent || feature.IsFieldSetAndNotNull(field_) == 0) {
        return "";
    }
    std::string const value = as_utf8(feature.GetFieldAsString(field_));
    return tag_.empty() ? value : value_of_tag(value, tag_);
}

void FileColumn::require_numbers(About const& about, Notes& notes) const {
    if (type_ == OFTString) {
        notes.add(about, "text_number", 0, 0.0, fmt::format("field {} holds text, which is read as numbers", name_));
    } else if (!is_number()) {
        throw BadInput(about.where,
                       fmt::format("{}: field {} does not hold numbers, but {}; name another field", about.name, name_,
                                   OGRFieldDefn::GetFieldTypeName(static_cast<OGRFieldType>(type_))));
    }
}

std::optional<std::int64_t> whole_in(double value) {
    constexpr double exact = 9007199254740992.0; // whole doubles are exact below 2^53
    if (!(std::fabs(value) < exact) || value != std::floor(value)) {
        return std::nullopt;
    }
    return static_cast<std::int64_t>(value);
}

// The columns of a user's layer.

std::vector<Schema> recognised(OGRLayer& layer) {
    std::vector<Schema> found;
    for (SchemaTable const& table : all_schemas()) {
        if (std::ranges::all_of(
                table.told_by, [&](std::string_view names) { return FileColumn(layer, words_of(names)).is_there(); })) {
            found.push_back(table.schema);
        }
    }
    return found;
}

bool is_in_network_schema(OGRLayer& layer) {
    return std::ranges::count(recognised(layer), Schema::native) > 0;
}

AttributeReader::AttributeReader(OGRLayer& layer) {
    bool const is_ours = is_in_network_schema(layer);
    for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i) {
        OGRFieldDefn const& field = *layer.GetLayerDefn()->GetFieldDefn(i);
        std::string const name = printable(field.GetNameRef());
        if (is_ours && is_of_schema(name)) {
            continue;
        }
        auto const* const type = std::ranges::find(attribute_types, field.GetType());
        bool const is_known = type != attribute_types.end();
        auto const number = static_cast<AttributeTable::Type>(type - attribute_types.begin());
        fields_.push_back(i);
        table_.columns.push_back({name, is_known ? number : AttributeTable::Type::text});
        if (!is_known) {
            std::string const word = OGRFieldDefn::GetFieldTypeName(field.GetType());
            findings_.push_back(
                {"as_text", 0, {}, 1.0, fmt::format("field {} holds {}: its values are kept as text", name, word)});
        }
    }
}

void AttributeReader::read(OGRFeature const& feature) {
    auto& row = table_.rows.emplace_back();
    for (std::size_t c = 0; c < fields_.size(); ++c) {
        row.push_back(attribute_value(feature, fields_[c], table_.columns[c].type));
        bool const is_text = std::holds_alternative<std::string>(row.back());
        escaped_ += is_text && !is_utf8(feature.GetFieldAsString(fields_[c])) ? 1 : 0;
    }
}

std::vector<Finding> AttributeReader::findings() const {
    std::vector<Finding> all = findings_;
    if (escaped_ > 0) {
        std::string const text = fmt::format("{} values are not UTF-8: their bytes are kept as \\xNN; name their "
                                             "encoding (of a shapefile, in a file .cpg beside it)",
                                             escaped_);
        all.push_back({"not_utf8", 0, nowhere, static_cast<double>(escaped_), text});
    }
    return all;
}

// What the columns of others' river files say.

std::vector<DataSet const*> data_sets_of(OGRLayer& layer) {
    std::vector<DataSet const*> found;
    for (DataSet const& set : all_data_sets()) {
        if (set.told_by.empty() || FileColumn(layer, words_of(set.told_by), false).is_there()) {
            found.push_back(&set);
        }
    }
    return found;
}

RiverFields::RiverFields(OGRLayer& layer) {
    for (RiverColumns const& known : river_columns) {
        for (std::string const& name : words_of(known.names)) {
            FileColumn column(layer, {name}, false);
            if (column.is_there() && (known.kind == Kind::text || column.is_number())) {
                found_[known.quantity].push_back({std::move(column)});
            }
        }
    }
    if (FileColumn name = FileColumn::of_tags(layer, "name"); !has(RiverQuantity::name) && name.is_there()) {
        found_[RiverQuantity::name].push_back({std::move(name)});
    }
    std::vector<Found>& sizes = found_[RiverQuantity::size];
    for (DataSet const* const set : data_sets_of(layer)) {
        FileColumn const area(layer, {std::string(set->area)}, false);
        if (!set->area.empty() && area.is_number()) {
            found_[RiverQuantity::area].push_back({area, set->area_unit});
            bool const is_known = std::ranges::any_of(sizes, [&](Found const& f) { return f.column.is(area); });
            sizes.insert(sizes.end(), is_known ? 0 : 1, {area});
        }
        if (FileColumn main(layer, {std::string(set->main)}, false); !set->main.empty() && main.is_there()) {
            found_[RiverQuantity::main].push_back({std::move(main)});
        }
    }
}

std::string RiverFields::text(OGRFeature const& feature, RiverQuantity quantity) const {
    return has(quantity) ? found_[quantity].front().column.text(feature) : "";
}

double RiverFields::number(OGRFeature const& feature, RiverQuantity quantity) const {
    double const value = has(quantity) ? found_[quantity].front().column.real(feature) : 0.0;
    return std::isfinite(value) ? value : 0.0;
}

void RiverFields::read(OGRFeature const& feature, RiverLine& line) const {
    auto const positive = [&](Found const& found) {
        double const value = found.column.real(feature);
        return value > 0.0 && std::isfinite(value) ? value : 0.0;
    };
    line.size.clear();
    for (Found const& found : found_[RiverQuantity::size]) {
        line.size.push_back(positive(found));
    }
    for (Found const& found : found_[RiverQuantity::river_class]) {
        double const value = positive(found);
        line.size.push_back(value >= 1.0 ? 1.0 / value : 0.0);
    }
    if (has(RiverQuantity::area)) {
        Found const& found = found_[RiverQuantity::area].front();
        line.area_m2 = positive(found) * found.unit;
    }
    line.name = text(feature, RiverQuantity::name);
    double const divergence = number(feature, RiverQuantity::divergence);
    bool const minor_path = has(RiverQuantity::calculated_order) &&
                            !found_[RiverQuantity::calculated_order].front().column.is_null(feature) &&
                            number(feature, RiverQuantity::calculated_order) == 0.0 &&
                            number(feature, RiverQuantity::order) > 0.0;
    std::string const main = lower_case(text(feature, RiverQuantity::main));
    if (divergence == 1.0 || main == "1" || main == "true") {
        line.channel = Channel::main;
    } else if (divergence == 2.0 || minor_path) {
        line.channel = Channel::minor;
    }
}

// Lines.

void OtherShapes::add(OGRGeometry const& shape, std::int64_t feature) {
    std::string const type = OGRGeometryTypeToName(wkbFlatten(shape.getGeometryType()));
    Finding& first = types_.try_emplace(type, Finding{"not_a_line"}).first->second;
    if (first.amount == 0.0) {
        OGREnvelope box;
        shape.getEnvelope(&box);
        first.feature = feature;
        first.where = box.IsInit() != 0 ? Vec2{box.MinX, box.MinY} : nowhere;
    }
    first.amount += 1.0;
    ++count_;
}

std::vector<Finding> OtherShapes::findings() const {
    std::vector<Finding> findings;
    for (auto const& [type, first] : types_) {
        std::string const text =
            first.amount == 1.0
                ? fmt::format("1 shape of type {} is not a line and is skipped; it is in feature {}", type,
                              first.feature)
                : fmt::format("{} shapes of type {} are not lines and are skipped; the first is in feature {}",
                              first.amount, type, first.feature);
        findings.push_back({"not_a_line", 0, first.where, first.amount, text});
    }
    return findings;
}

std::vector<std::vector<Vec3>> parts_of(OGRGeometry const& shape, std::int64_t feature, OtherShapes& others) {
    Parts parts;
    std::unique_ptr<OGRGeometry> const straight(shape.getLinearGeometry());
    add_parts(*straight, feature, parts, others);
    return parts;
}

DrawnLine drawn_line(OGRGeometry const* shape, std::int64_t feature, OtherShapes& others) {
    std::int64_t const before = others.count();
    DrawnLine line{shape == nullptr ? Parts() : parts_of(*shape, feature, others)};
    line.is_line = !line.parts.empty() || others.count() == before;
    line.drawn_parts = static_cast<int>(line.parts.size());
    if (line.parts.empty()) {
        line.parts.emplace_back();
    }
    if (line.parts.size() > 1) {
        join(line.parts);
    }
    return line;
}

} // namespace thalweg::io
