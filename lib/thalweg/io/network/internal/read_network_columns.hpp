// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include <thalweg/core/by_enum.hpp>
#include <thalweg/io/network/internal/read_network_notes.hpp>
#include <thalweg/io/network/schema.hpp>

class OGRFeature;
class OGRLayer;

/// Which column of a layer holds what. Private to this module.
namespace thalweg::io {

/// What a file does not say.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A column of numbers or texts, found by its name in any case of letters; the feature id of the format is one too.
class FileColumn {
public:
    FileColumn() = default;
    /// Takes: the first of the names (a blank between them) that the layer has.
    FileColumn(OGRLayer& layer, std::string const& names);

    bool is_there() const { return field_ != absent; }
    bool is_null(OGRFeature const& feature) const;
    /// Nothing when it is not a whole number.
    std::optional<std::int64_t> whole(OGRFeature const& feature) const;
    /// NaN when it is no number.
    double real(OGRFeature const& feature) const;
    std::string text(OGRFeature const& feature) const;
    /// The name as the file has it.
    std::string const& name() const { return name_; }
    /// Throws: BadInput when it can hold no numbers; a note when it holds them as text.
    void require_numbers(OGRLayer& layer, std::string const& what, Notes& notes) const;

private:
    static constexpr int absent = -1;
    static constexpr int feature_id = -2;
    int field_ = absent;
    bool is_text_ = false;
    std::string name_;
};

/// The columns of the layer of arcs by what they tell.
class ArcColumns {
public:
    /// mapped: by quantity the field that the user names. Without a schema the arcs are understood by these alone, in
    /// the units of the native schema. Throws: BadInput when a field that is named, or that of arc ids, is missing, or
    /// one holds no numbers.
    ArcColumns(OGRLayer& layer, std::optional<Schema> schema, std::map<Quantity, std::string> const& mapped,
               std::string const& what, Notes& notes);

    bool has(Quantity quantity) const { return column(quantity).is_there(); }
    FileColumn const& column(Quantity quantity) const { return columns_[quantity].column; }
    /// In SI units; NaN where there is no such column, or no value that is known.
    double real(OGRFeature const& feature, Quantity quantity) const;
    /// What stands for no arc in a column of links.
    std::optional<std::int64_t> none(Quantity quantity) const;

private:
    struct Told {
        FileColumn column;
        SchemaField const* field = nullptr;
    };
    ByEnum<Quantity, Told, static_cast<std::size_t>(Quantity::constant)> columns_;
};

/// The schemas of which a layer has all the fields that tell it.
std::vector<Schema> recognised(OGRLayer& layer);
/// "native: arc_id, ...; taudem: ...", for a message: what recognised() looks for.
std::string what_tells();
/// The names of a layer's fields.
std::string fields_of(OGRLayer& layer);

/// Whether fields that a user names make a schema needless.
bool is_enough(std::map<Quantity, std::string> const& mapped);

} // namespace thalweg::io
