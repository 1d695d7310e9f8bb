// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <thalweg/io/tables/table.hpp>

namespace thalweg::io {

/// Whose field names and units a network has.
enum class Schema : std::uint8_t { native, taudem, nhdplus, hydrorivers, grass };

/// What a field says of an arc. An arc has an upper and a lower end; its outlet is where its water leaves the network.
enum class Quantity : std::uint8_t {
    // The columns of the native schema, in its order.
    arc_id,
    from_node,
    to_node,
    ds_arc,
    n_up,
    basin_id,
    topo_ord,
    strahler,
    shreve,
    hack,
    length,
    length_3d,
    straight,
    z_up,
    z_down,
    dist_out, ///< from its end down to the outlet
    slope,
    us_area,
    ds_area,
    persistence,
    feature,
    type,
    braided,
    given, ///< 1, or 0 for a side valley grown in the terrain
    // What other schemas have besides.
    us_arc_1, ///< the arcs upstream, in order of arc_id; none beyond the last
    us_arc_2,
    us_arc_3,
    us_arc_4,
    us_arc_5,
    outlet_arc,  ///< the arc at the outlet
    key,         ///< a second number of the arc, which falls downstream, and by which others name it in links
    ds_key,      ///< key of the arc downstream; 0 at an outlet
    us_key,      ///< key of the main arc upstream; 0 at a source
    path,        ///< key of the last arc downstream on the same main stem (of one hack order)
    ds_path,     ///< path of the arc downstream; 0 at an outlet
    us_path,     ///< path of the main arc upstream; 0 at a source
    outlet_path, ///< path at the outlet
    ds_hack,     ///< hack of the arc downstream; 0 at an outlet
    n_down,      ///< how many arcs leave its end
    is_source,   ///< 1 where nothing flows in
    is_outlet,   ///< 1 where it ends at the outlet
    horton,      ///< greatest strahler along the main stem (of one hack order)
    scheidegger, ///< 2 shreve
    drwal,       ///< floor(log2(shreve)) + 1
    drop,        ///< z_up - z_down
    sinuosity,   ///< length / straight
    dist_mid,    ///< from its middle to the outlet
    dist_up,     ///< from its end up to the outlet
    dist_source, ///< from its end down to the farthest source
    length_us,   ///< sum of the lengths of all arcs upstream, its own among them
    own_area,    ///< ds_area - us_area
    routed_area, ///< ds_area without what a minor branch of a divergence carries a second time
    stream_calc, ///< strahler of the water of main branches alone; 0 on minor branches up to their first tributary
    divergence,  ///< 1 on the main, 2 on a minor branch of a divergence, else 0
    ds_minor,    ///< key of the first minor branch that leaves its end
    returns,     ///< 1 where branches of a divergence meet again at its upper end
    constant,    ///< nothing: the field's value or text, always
};

/// \param quantity the quantity
/// \return the name by which a user names a quantity: of the columns of the native schema, their own.
std::string_view name_of(Quantity quantity);
/// \param name its name
/// \return nothing for an unknown name.
std::optional<Quantity> quantity_of(std::string_view name);

/// A field of a schema.
struct SchemaField {
    Quantity quantity = Quantity::constant;
    std::string_view name = {}; ///< as its owner writes it; found in any case of letters
    Column::Kind kind = Column::Kind::integer;
    int decimals = 0;                                          ///< of a real in a shapefile
    double unit = 1.0;                                         ///< of a number in the file, in m, m2 or m/m
    std::string_view also = {};                                ///< other names, separated by blanks
    double unknown = std::numeric_limits<double>::quiet_NaN(); ///< stands for no arc, or for an unknown value
    double value = 0.0;                                        ///< of a constant that is a number
    std::string_view text = {};                                ///< of a constant that is a text
    bool written = true;                                       ///< else it is only read
};

/// How somebody's files hold the arcs of a network.
struct SchemaTable {
    Schema schema = Schema::native;
    std::string_view name = {};                ///< "taudem"
    std::span<SchemaField const> fields;       ///< in the order in which they are written
    std::span<std::string_view const> told_by; ///< a file with all of these fields is of this schema; of names that a
                                               ///< blank separates one is enough
    std::string_view layer = "arcs";           ///< the layer of arcs, when written
    std::int64_t first_id = 1;   ///< the least arc id: in a file arc_id k is k - 1 + first_id, in every field of arcs
    int most_upstream = 0;       ///< how many arcs may flow into one; 0 for any number
    bool drawn_upstream = false; ///< vertex 0 is at the lower end
    bool segment_parts = false;  ///< every segment of a line is a part of its own
    bool divergences = false;    ///< several arcs may leave a node
};

/// The columns by which the river lines of a data set say where water goes. A column is "" where there is none; of
/// names that a blank separates the first that a layer has counts, in any case of letters.
struct DataSet {
    std::string_view name = {};
    std::string_view version = {}; ///< "": of any
    std::string_view source = {};  ///< who names the columns
    std::string_view told_by = {}; ///< its other columns count in layers that have one of these; "": in any
    // Links: both or none.
    std::string_view id = {};
    std::string_view down = {};      ///< ids downstream; a text may hold several
    std::string_view nexus = {};     ///< how ids of points between lines begin: "nex-7" is above line "wb-7"
    std::string_view of_nexus = {};  ///< "wb-"
    std::string_view from_node = {}; ///< nodes in the direction of flow: both or none
    std::string_view to_node = {};
    // The column that tells whether water runs as a line is drawn, and its words: in lower case, without blanks.
    std::string_view direction = {};
    std::string_view with = {};
    std::string_view against = {};
    std::string_view rank = {};    ///< number that falls downstream
    std::string_view main = {};    ///< 1 on the main one of several channels
    std::string_view area = {};    ///< drainage area at the lower end
    double area_unit = 1e6;        ///< [m2]
    std::string_view z_first = {}; ///< [m] height of the first vertex, and
    std::string_view z_last = {};  ///< of the last: both or none
};

/// All data sets whose columns are known; of two that a layer is of the first counts.
std::span<DataSet const> all_data_sets();

/// \internal
SchemaTable const& table_of(Schema schema);
/// \internal
std::span<SchemaTable const> all_schemas();
/// \param name its name
/// \return "native, taudem, ..." are the names.
/// \throws BadInput with a suggestion when it is none
Schema schema_named(std::string const& name);
/// \internal
/// \param table the table
/// \param quantity the quantity
/// \return the field of a quantity; null when the schema has none.
SchemaField const* field_of(SchemaTable const& table, Quantity quantity);

} // namespace thalweg::io
