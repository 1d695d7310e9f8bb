// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/vec.hpp>

class GDALDataset;
class OGRLayer;
class OGRGeometry;
class OGRFeature;

namespace thalweg::io {

/// Throws: BadInput that lists the layers when none has lines; IoError when features cannot be read.
void require_lines(GDALDataset& data, std::string const& name, std::string const& who);

/// The layer of a source that holds its rivers.
/// Takes: a layer's name, or "" for the only layer with lines that is not empty; where there are several, the one whose
/// name says that it holds rivers (arcs, NHDFlowline, waterways, rivers, ...), if only one does. name: of the source,
/// for messages; who: begins them. Throws: BadInput that lists the layers: no such layer, none with lines, several of
/// which none is clearly meant; IoError when features cannot be read.
OGRLayer& rivers_layer(GDALDataset& data, std::string const& wanted, std::string const& name, std::string const& who);

// What is drawn as an arc.

/// Counts the shapes of a layer that are not lines.
class OtherShapes {
public:
    void add(OGRGeometry const& shape, std::int64_t feature);
    /// How many there are.
    std::int64_t count() const;
    /// One for each type of shape: not_a_line [shapes], at the first of them.
    std::vector<Finding> findings() const;

private:
    struct Type {
        std::int64_t count = 0;
        std::int64_t first = 0; ///< feature
        Vec2 where;
    };
    std::map<std::string, Type> types_;
};

struct DrawnLine {
    bool is_line = true;                  ///< else the rest is empty
    std::vector<std::vector<Vec3>> parts; ///< one when they join end to end; z is NaN without heights
    int drawn_parts = 0;                  ///< as they stand in the file
    bool has_z = false;
    bool has_m = false;
    bool curved = false;
};

/// Takes: any geometry, or none (nullptr), which is a line without vertices. Shapes in it that are not lines go to
/// others; is_line is false where there is nothing else.
DrawnLine drawn_line(OGRGeometry const* shape, std::int64_t feature, OtherShapes& others);

// The columns of a user's layer.

class AttributeReader {
public:
    /// Takes every field of the layer; of one in the network schema those that are not the schema's.
    explicit AttributeReader(OGRLayer& layer);

    /// The values of the next feature.
    void read(OGRFeature const& feature);
    /// All rows, in the order of reading.
    AttributeTable take() { return std::move(table_); }
    /// as_text (columns): fields of a type that no table here has, kept as texts. not_utf8 (values): texts read so far
    /// of which bytes are kept as \xNN.
    std::vector<Finding> findings() const;

private:
    std::vector<int> fields_; ///< by column
    AttributeTable table_;
    std::vector<Finding> findings_;
    std::int64_t escaped_ = 0;
};

/// Whether a layer has the fields of the network schema.
bool is_in_network_schema(OGRLayer& layer);

} // namespace thalweg::io
