// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/indexed.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/network/schema.hpp>

class OGRLayer;
class OGRFeature;

namespace thalweg::io {

// What reading a network has to say.

class Notes {
public:
    /// Strict notes throw what they are given as BadInput.
    explicit Notes(bool strict) : strict_(strict) {}

    /// source: the file and layer for the message of a strict note.
    void add(std::string const& source, Finding finding);
    /// The first thousand of each kind, and one more that counts the rest.
    std::vector<Finding> take();

private:
    bool strict_;
    std::vector<Finding> findings_;
    std::map<std::string, std::size_t> count_;
};

// Where the layers of a network are.

/// The files of a network: a GeoPackage is both; nodes is "" where there is no file for them.
struct NetworkPlace {
    std::string arcs;
    std::string nodes;
};

/// Takes: see read_network. whole: a shapefile must be NAME_arcs.shp or NAME_nodes.shp. Throws: BadInput, IoError.
NetworkPlace find_network(std::string const& path, bool whole);

/// A file or database, opened to be read only.
class NetworkSource {
public:
    /// Throws: BadInput, IoError like read_network.
    NetworkSource(std::string const& path, Driver const& driver);

    /// "io.read_network: PATH", without a password.
    std::string const& what() const { return what_; }
    /// Null when it has none of this name.
    OGRLayer* layer(std::string const& name) const;
    std::vector<OGRLayer*> layers() const;

private:
    std::string what_;
    Dataset dataset_;
};

// Which layers of a source are a network, and in whose words.

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

// Which column of a layer holds what.

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

/// The names of a layer's fields.
std::string fields_of(OGRLayer& layer);

// How the arcs of a network file hang together.

/// Sets ds_arc by keys. Takes: by arc its key and that of the arc downstream, 0 for none. A key that no arc has stands
/// in ds_arc as the negative of itself, for drop_links_out.
void link_by_keys(NetworkFile& file, std::vector<std::int64_t> const& keys, std::vector<std::int64_t> const& ds_keys);

/// Makes an outlet of each arc whose ds_arc the file does not hold: an extract ends there; its basins go by others.
void drop_links_out(NetworkFile& file, std::string const& what, Notes& notes);

/// Turns all lines when more linked arcs are drawn up than down; with as many of both, when drawn_upstream.
void turn_downstream(NetworkFile& file, bool drawn_upstream, std::string const& what, Notes& notes);

/// Makes a node for each place in plan where an arc begins or ends, from 1 in the order of the arcs, and sets from_node
/// and to_node; arcs without vertices have none (0).
void name_ends(NetworkFile& file);

/// Makes a node for each id in from_node and to_node but 0, where most ends of that id are.
void place_nodes(NetworkFile& file);

/// Sets ds_arc to the first arc that begins at the arc's end.
void link_by_nodes(NetworkFile& file);

// The features of a network's layers.

/// Reads the arcs as they are drawn and linked in the file, and what the file says. Throws: like read_network.
void read_arcs(NetworkFile& file, Layer const& arcs, std::optional<Schema> schema, Wish const& wish,
               Driver const& driver, Notes& notes, Run const& run);

/// Reads which features arcs were made of. What is no such table is passed over.
void read_sources(NetworkFile& file, Layer const& sources, Driver const& driver, Run const& run);

/// Reads the nodes. Takes: the field of their ids. Throws: like read_network.
void read_nodes(NetworkFile& file, Layer const& nodes, std::string const& node_id, Driver const& driver, Notes& notes,
                Run const& run);

} // namespace thalweg::io
