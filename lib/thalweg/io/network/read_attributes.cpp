// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_attributes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <cpl_port.h>
#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/printable.hpp>
#include <thalweg/io/network/schema.hpp>

namespace thalweg::io {

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
