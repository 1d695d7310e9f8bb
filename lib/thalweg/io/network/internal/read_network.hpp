// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <thalweg/core/by_enum.hpp>
#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/schema.hpp>

class OGRFeature;
class OGRGeometry;
class OGRLayer;
class OGRSpatialReference;

namespace thalweg::io {

class IntoMetres;
class Notes;

// Names.

/// The words of a text that are separated by single blanks, as the tables of names list them.
std::vector<std::string> words_of(std::string_view text);

/// All names of a field, its own first.
std::vector<std::string> names_of(SchemaField const& field);

/// With a to z for A to Z.
std::string lower_case(std::string text);

/// A word without case and blanks, of a code list's address the last part.
std::string plain_word(std::string word);

/// "a, b, c"; "none" for an empty list.
std::string listed(std::vector<std::string> const& names);

std::vector<std::string> field_names(OGRLayer& layer);

/// Whether GDAL reads OpenStreetMap's own files: one layer at a time, and past the others only when told so.
bool is_osm_file(GDALDataset& data);

/// Tells GDAL which layer of such a file is read.
void read_osm_layer(GDALDataset& data, char const* layer);

// Columns.

/// What a file does not say.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A column of numbers or texts, found by its name in any case of letters; the feature id of the format may be one too.
class FileColumn {
public:
    FileColumn() = default;
    /// Takes the first of the names that the layer has.
    FileColumn(OGRLayer& layer, std::vector<std::string> const& names, bool or_feature_id = true);

    /// The column that holds OpenStreetMap's keys without a column of their own: other_tags, all_tags or tags.
    static FileColumn with_tags(OGRLayer& layer);
    /// The values of one of these keys; nothing where the layer has a column of this name, or none with tags.
    static FileColumn of_tags(OGRLayer& layer, std::string const& key);

    bool is_there() const { return field_ != absent; }
    /// Whether both are the same column of a layer.
    bool is(FileColumn const& other) const { return field_ == other.field_ && tag_ == other.tag_; }
    /// Whether its type is one of numbers.
    bool is_number() const;
    bool is_null(OGRFeature const& feature) const;
    /// Nothing when it is not a whole number.
    std::optional<std::int64_t> whole(OGRFeature const& feature) const;
    /// NaN when it is not a number. A text counts when all of it is one.
    double real(OGRFeature const& feature) const;
    /// "" for NULL.
    std::string text(OGRFeature const& feature) const;
    /// The name as the file has it.
    std::string const& name() const { return name_; }
    /// \throws BadInput when it cannot hold numbers; a note when it holds them as text
    void require_numbers(About const& about, Notes& notes) const;

private:
    static constexpr int absent = -1;
    static constexpr int feature_id = -2;
    int field_ = absent;
    int type_ = -1; ///< OGRFieldType
    std::string name_;
    std::string tag_; ///< "": the values are those of the column
};

/// Nothing when a number is not whole, or so large that doubles skip whole numbers.
std::optional<std::int64_t> whole_in(double value);

/// The columns of a user's layer.
class AttributeReader {
public:
    /// Takes every field of the layer, except those of the native schema where the layer is in it.
    explicit AttributeReader(OGRLayer& layer);

    /// The values of the next feature.
    void read(OGRFeature const& feature);
    /// All rows so far.
    AttributeTable const& table() const { return table_; }
    /// All rows, in the order of reading.
    AttributeTable take() { return std::move(table_); }
    /// as_text (columns): fields of a type that AttributeTable does not have, kept as text. not_utf8 (values): texts
    /// read so far of which bytes are kept as \xNN.
    std::vector<Finding> findings() const;

private:
    std::vector<int> fields_; ///< by column
    AttributeTable table_;
    std::vector<Finding> findings_;
    std::int64_t escaped_ = 0;
};

/// The schemas of which a layer has all the fields that identify it.
std::vector<Schema> recognised(OGRLayer& layer);

/// Whether a layer is in the native schema.
bool is_in_network_schema(OGRLayer& layer);

/// The known data sets of which a layer can be.
std::vector<DataSet const*> data_sets_of(OGRLayer& layer);

/// The columns for the flow of river lines that a user names.
struct FlowColumns {
    FileColumn id = {};
    FileColumn down = {};
    FileColumn from_node = {};
    FileColumn to_node = {};
    FileColumn direction = {};
    FileColumn rank = {};
};

/// What the columns of a river file say of where water goes: those that a user names, else those of a known data set.
class FlowFields {
public:
    explicit FlowFields(OGRLayer& layer, FlowColumns named = {});

    /// Remembers what a feature says.
    /// \param feature its number, from 1
    void read(OGRFeature const& feature, std::int64_t number);
    // Once every feature has been read:
    /// Whether there are fields of links, of nodes or of directions.
    bool has_links() const { return !links_.empty(); }
    bool has_any() const { return has_links() || to_node_.is_there() || !directions_.empty(); }
    /// By feature: the one downstream by the file's links.
    std::map<std::int64_t, std::int64_t> downs() const;
    /// 1: a feature runs as it is drawn, -1: against it, 0: unknown.
    int runs_of(std::int64_t number) const;
    /// Sets down, runs, rank, from_node and to_node of all lines.
    void tell(std::vector<RiverLine>& lines) const;
    /// The name of the field of ranks, or "".
    std::string const& rank_name() const { return rank_.name(); }

    /// Sets the heights of a feature's only line from the columns of its ends, where it has none.
    /// \return false: there are no such columns, or the line has heights
    bool raise(OGRFeature const& feature, std::vector<Vec3>& line) const;
    /// "z_ini and z_fin"
    std::string names_of_heights() const { return z_first_.name() + " and " + z_last_.name(); }

private:
    struct Links {
        FileColumn id;
        FileColumn down;
        std::string_view nexus = {};
        std::string_view of_nexus = {};
        std::map<std::string, std::int64_t> feature_of = {}; ///< by own id: the first feature that has it
        std::map<std::int64_t, std::string> down_id = {};    ///< by feature: the ids downstream
        std::int64_t below(std::int64_t number) const;
        double share_found() const;
    };
    struct Direction {
        FileColumn column;
        std::vector<std::string> with;
        std::vector<std::string> against;
    };
    struct Said {
        int by_word = 0; ///< as runs
        int by_code = 0; ///< the same, in a column of numbers
        double rank = nan;
        std::int64_t from_node = 0;
        std::int64_t to_node = 0;
    };
    void find(OGRLayer& layer, DataSet const& set);
    void read_direction(OGRFeature const& feature, Said& said);
    Links const& links() const;
    Said said_of(std::int64_t number) const;

    std::vector<Links> links_;
    std::vector<Direction> directions_;
    FileColumn from_node_;
    FileColumn to_node_;
    FileColumn rank_;
    FileColumn z_first_;
    FileColumn z_last_;
    std::map<std::int64_t, Said> said_;                ///< by feature
    std::map<std::string, std::int64_t> node_numbers_; ///< by name, from 1
    bool are_codes_ = true;                            ///< no number in a column of directions is none of its codes
};

/// Columns that look like links, nodes or directions of lines, and are of no known data set: unused_fields.
/// \param lines in coordinates of the file, record of their attributes = feature
std::vector<Finding> unused_fields(std::vector<RiverLine> const& lines, AttributeTable const& attributes);

/// What a column of a river file says of a line. docs/river_files.md lists the names.
enum class RiverQuantity : std::uint8_t {
    size,        ///< larger for larger rivers
    river_class, ///< 1 for the largest rivers
    area,        ///< drainage area at the lower end
    main,        ///< 1 on the main one of several channels
    divergence,
    calculated_order, ///< 0 on minor paths
    order,
    name
};

/// What the known columns of a river file say of rivers, beside where they flow: NHDPlus, HydroRIVERS, EU-Hydro,
/// OpenStreetMap, network schemas.
class RiverFields {
public:
    explicit RiverFields(OGRLayer& layer);

    /// Sets size, area, name and channel.
    void read(OGRFeature const& feature, RiverLine& line) const;

private:
    struct Found {
        FileColumn column;
        double unit = 1.0;
    };
    bool has(RiverQuantity quantity) const { return !found_[quantity].empty(); }
    std::string text(OGRFeature const& feature, RiverQuantity quantity) const;
    double number(OGRFeature const& feature, RiverQuantity quantity) const;

    ByEnum<RiverQuantity, std::vector<Found>, static_cast<std::size_t>(RiverQuantity::name) + 1> found_;
};

// Natural watercourses.

/// Why a feature is not a natural watercourse.
struct Unnatural {
    std::string reason = {}; ///< "FTYPE Coastline"; "" where it is one, or no field says so
    bool is_channel = false; ///< it carries water: a canal, ditch, drain or pipe
    bool is_coast = false;   ///< by any field
};

/// The fields by which OpenStreetMap, NHD and others tell rivers from other lines: docs/river_files.md lists them.
class NaturalFilter {
public:
    explicit NaturalFilter(OGRLayer& layer);

    Unnatural of(OGRFeature const& feature) const;

private:
    /// The value of a key of OpenStreetMap, from its own column or from one that holds all other keys.
    std::string tag(OGRFeature const& feature, std::string_view key) const;
    Unnatural by_tags(OGRFeature const& feature) const;
    /// What a way of OpenStreetMap without waterway is.
    std::string other_way(OGRFeature const& feature) const;
    bool is_way(OGRFeature const& feature) const;
    Unnatural by_code(OGRFeature const& feature) const;

    std::map<std::string, FileColumn, std::less<>> tags_; ///< columns of single keys
    FileColumn all_tags_;
    FileColumn osm_id_;
    FileColumn ftype_;
    FileColumn fcode_;
    struct Code {
        FileColumn column;
        std::size_t row;
    };
    std::vector<Code> codes_; ///< columns of other schemas
};

/// The value of a key among other tags: "power"=>"line" (hstore) or "power": "line" (JSON). "": it is not there.
std::string value_of_tag(std::string_view tags, std::string_view key);

// Lakes.

/// The fields by which OpenStreetMap, NHD and others tell lakes from other polygons.
class LakeFilter {
public:
    explicit LakeFilter(OGRLayer& layer);

    /// Takes a feature's polygons where it is a lake: it says so, the layer does, or nothing says what it is.
    /// \param number of the feature, from 1
    /// \return false: it is none
    bool take(OGRFeature const& feature, std::int64_t number, std::vector<Polygon>& lakes) const;

private:
    std::string tag(OGRFeature const& feature, std::string_view key) const;
    bool is_lake(OGRFeature const& feature) const;

    std::vector<std::pair<std::string, FileColumn>> tags_; ///< columns of single keys
    FileColumn all_tags_;
    FileColumn ftype_;
    std::vector<FileColumn> kinds_;
    std::vector<FileColumn> words_; ///< names and descriptions
    std::vector<FileColumn> units_; ///< numbers of countries, catchments and the like
    bool is_named_ = false;         ///< the layer is, for lakes
    bool is_of_land_ = false;       ///< the layer is named for land
    bool is_tagged_ = false;
};

/// Whether a layer of polygons is named for lakes.
bool may_hold_lakes(OGRLayer& layer);

/// The lakes of layers that are named for them, in the CRS of the rivers.
/// \param read layers of rivers, which are passed over
/// \param own CRS of the file's rivers; layers in another are passed over
std::vector<Polygon> lakes_of_layers(GDALDataset& data, std::vector<OGRLayer*> const& read, IntoMetres const& metres,
                                     OGRSpatialReference const& own, Run const& run);

/// The only layer that may hold polygons.
/// \param about whose errors they are
/// \throws BadInput that lists the layers when there are several or none
std::vector<OGRLayer*> layers_of_areas(GDALDataset& data, About const& about);

/// Drops polygons in which more than half of the lines' vertices lie, with a finding each: countries, catchments.
void drop_surroundings(std::vector<Polygon>& lakes, std::vector<RiverLine> const& lines,
                       std::vector<Finding>& findings);

/// Without those of which a vertex cannot be reprojected.
std::vector<Polygon> into_metres(std::vector<Polygon> lakes, IntoMetres const& metres);

// Lines.

/// Counts the shapes of a layer that are not lines.
class OtherShapes {
public:
    void add(OGRGeometry const& shape, std::int64_t feature);
    std::int64_t count() const { return count_; }
    /// One for each type of shape: not_a_line [shapes], at the first of them.
    std::vector<Finding> findings() const;

private:
    std::map<std::string, Finding> types_; ///< the first of each, and how many
    std::int64_t count_ = 0;
};

/// The parts of a geometry that are lines, curves as OGR linearises them; z is NaN without heights. Other shapes go to
/// others.
std::vector<std::vector<Vec3>> parts_of(OGRGeometry const& shape, std::int64_t feature, OtherShapes& others);

struct DrawnLine {
    std::vector<std::vector<Vec3>> parts; ///< one when they join end to end
    bool is_line = true;                  ///< else there are only other shapes
    int drawn_parts = 0;                  ///< as they stand in the file
};

/// A geometry as an arc. None (nullptr) is a line without vertices.
DrawnLine drawn_line(OGRGeometry const* shape, std::int64_t feature, OtherShapes& others);

// Layers.

/// A file or database, opened read-only.
struct NetworkSource {
    About about; ///< the path, without a password
    Dataset dataset;
};

/// A layer, and how messages name it.
struct Layer {
    OGRLayer* layer = nullptr;
    About about = {};
    std::shared_ptr<void const> holds = {}; ///< several layers as one
    std::vector<OGRLayer*> read_from = {};  ///< the layers of the file

    /// Calls body for each feature.
    /// \throws IoError when there are fewer than the file announces
    void each(Driver const& driver, Run const& run, std::function<void(OGRFeature const&)> const& body) const;
};

/// \throws BadInput that lists the layers when none has lines; IoError when features cannot be read
void require_lines(GDALDataset& data, About const& about);

/// The layers of a source.
std::vector<OGRLayer*> layers_of(GDALDataset& data);

std::vector<std::string> layer_names(std::vector<OGRLayer*> const& layers);

/// Whether the type of a layer admits lines.
bool may_hold_lines(OGRLayer& layer);

/// The layers of a source that hold its rivers.
/// \param wanted a layer's name, or several separated by commas; or "" for the only layer with lines that is not empty;
/// of several the one whose name says that it holds rivers (arcs, NHDFlowline, waterways, rivers, ...), if only one
/// does. All folders of KML but those of roads and the like, all tracks and routes of GPX; of OpenStreetMap the ways.
/// \param about whose errors they are
/// \throws BadInput that lists the layers: no such layer, none with lines, several of which none is clearly meant;
/// IoError when features cannot be read
std::vector<OGRLayer*> rivers_layers(GDALDataset& data, std::string const& wanted, About const& about);

/// Layers to be read as one.
struct ChosenLayer {
    OGRLayer* layer = nullptr;
    std::string name;   ///< of the layer, or of all
    Dataset holds = {}; ///< of several: a copy in memory, with a column "layer"
};

/// \param layers one or more
/// \param about whose errors they are
/// \throws BadInput when they are in different coordinate systems
ChosenLayer as_one(std::vector<OGRLayer*> const& layers, About const& about);

/// Names the layers with lines that are not read.
/// \param data the source
/// \param read those that are
/// \param crs in metres, for lengths; "": there are none
/// \param source_crs of layers that have none; "": none
/// \param about the file
/// \return layers_not_read [m], or nothing
std::vector<Finding> layers_not_read(GDALDataset& data, std::vector<OGRLayer*> const& read, std::string const& crs,
                                     std::string const& source_crs, About const& about);

/// The files of a network: a GeoPackage is both; nodes is "" where there is no file for them.
struct NetworkPlace {
    std::string arcs;
    std::string nodes;
};

/// \param path as read_network
/// \param whole a shapefile must be NAME_arcs.shp or NAME_nodes.shp
/// \throws BadInput, IoError as read_network
NetworkPlace find_network(std::string const& path, bool whole);

/// \throws BadInput, IoError like read_network
NetworkSource open_network(std::string const& path, Driver const& driver);

/// What a user asks for, understood.
struct Wish : ReadNetworkParams {
    std::map<Quantity, std::string> columns = {}; ///< fields by quantity
    std::string node_id = "node_id";
    bool whole = false; ///< every layer, field and value of the native schema, or an error
};

/// Whether lines without a known schema are arcs as they are.
inline bool takes_any_lines(Wish const& wish) {
    return wish.any_lines && wish.columns.empty();
}

/// \throws BadInput like read_network
Layer choose_arcs(NetworkSource const& source, Wish const& wish);

/// The layer of nodes that belongs to the arcs, if there is one.
/// \param source of nodes, which may be that of the arcs, or null
/// \throws BadInput when a layer is named that is not there
std::optional<Layer> choose_nodes(NetworkSource const* source, NetworkSource const& arcs_source, Layer const& arcs,
                                  std::optional<Schema> schema, Wish const& wish);

/// Nothing when the fields that the user names are enough, or any lines are taken.
/// \throws BadInput like read_network
std::optional<Schema> choose_schema(Layer const& arcs, Wish const& wish);

// The features of a network's layers.

/// What reading a network has to say.
class Notes {
public:
    /// Strict notes throw what they are given as BadInput.
    explicit Notes(bool strict) : strict_(strict) {}

    /// about: the file and layer for the message of a strict note.
    void add(About const& about, Finding finding);
    void add(About const& about, FindingKind kind, std::int64_t feature, double amount, std::string text) {
        add(about, {kind, feature, nowhere, amount, std::move(text)});
    }
    /// The first thousand of each kind, and one more that counts the rest.
    std::vector<Finding> take();

private:
    bool strict_;
    std::vector<Finding> findings_;
    std::map<FindingKind, std::size_t> count_;
};

/// Reads the arcs as they are drawn and linked in the file, and what the file says.
/// \throws Error as read_network
void read_arcs(NetworkFile& file, Layer const& arcs, std::optional<Schema> schema, Wish const& wish,
               Driver const& driver, Notes& notes, Run const& run);

/// Reads which features arcs were made of. A table without the columns for it is skipped.
void read_sources(NetworkFile& file, Layer const& sources, Driver const& driver, Run const& run);

/// Reads the nodes.
/// \param node_id field of their ids
/// \throws Error as read_network
void read_nodes(NetworkFile& file, Layer const& nodes, std::string const& node_id, Driver const& driver, Notes& notes,
                Run const& run);

// How the arcs of a network file are linked.

/// Sets ds_arc by keys. A key that no arc has stands in ds_arc as the negative of itself, for drop_links_out.
/// \param keys by arc
/// \param ds_keys by arc: key of the arc downstream; 0: none
void link_by_keys(NetworkFile& file, std::vector<std::int64_t> const& keys, std::vector<std::int64_t> const& ds_keys);

} // namespace thalweg::io
