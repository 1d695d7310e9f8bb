// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network_columns.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/printable.hpp>
#include <thalweg/core/run/suggest.hpp>

namespace thalweg::io {

namespace {

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

std::string fields_of(OGRLayer& layer) {
    std::vector<std::string> const names = field_names(layer);
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

bool is_enough(std::map<Quantity, std::string> const& mapped) {
    return mapped.contains(Quantity::arc_id) &&
           (mapped.contains(Quantity::ds_arc) ||
            (mapped.contains(Quantity::from_node) && mapped.contains(Quantity::to_node)));
}

} // namespace thalweg::io
