// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/network/internal/read_network_source.hpp>
#include <thalweg/io/network/schema.hpp>

class OGRFeature;
class OGRLayer;

/// Which layers of a source are a network, and in whose words. Private to this module.
namespace thalweg::io {

/// What a user asks for, understood: see ReadNetworkParams.
struct Wish {
    std::optional<Schema> schema = {};
    std::map<Quantity, std::string> fields = {};
    std::string node_id = "node_id";
    std::string arcs_layer = {};
    std::string nodes_layer = {};
    std::string crs = {};
    std::string source_crs = {};
    bool any_lines = false;
    bool bridge = false;
    bool whole = false; ///< every layer, field and value of the native schema, or an error
};

/// Whether lines without a known schema are arcs as they are.
bool takes_any_lines(Wish const& wish);

/// A layer, and how it is called in messages.
struct Layer {
    OGRLayer* layer = nullptr;
    std::string what = {};

    /// Calls body for each feature, as many as the file announces. Throws: IoError.
    void each(Driver const& driver, Run const& run, std::function<void(OGRFeature const&)> const& body) const;
};

/// Throws: BadInput like read_network.
Layer choose_arcs(NetworkSource const& source, Wish const& wish);

/// The layer of nodes that belongs to the arcs, if there is one. Takes: the source of nodes, which may be that of the
/// arcs, or null. Throws: BadInput when there is none of the name that is wanted.
std::optional<Layer> choose_nodes(NetworkSource const* source, NetworkSource const& arcs_source, Layer const& arcs,
                                  std::optional<Schema> schema, Wish const& wish);

/// Nothing when the fields that the user names are enough, or any lines are taken. Throws: BadInput like read_network.
std::optional<Schema> choose_schema(Layer const& arcs, Wish const& wish);

} // namespace thalweg::io
