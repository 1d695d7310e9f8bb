// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <thalweg/core/attributes.hpp>
#include <thalweg/core/finding.hpp>

class OGRFeature;
class OGRLayer;

/// The columns of a user's layer. Private to this module.
namespace thalweg::io {

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
