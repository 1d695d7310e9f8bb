// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// The attributes of a file's features as a table.
struct AttributeTable {
    enum class Type : std::uint8_t { integer, integer64, real, text, date, time, datetime };
    /// std::monostate is NULL; dates and times are ISO 8601 text.
    using Value = std::variant<std::monostate, std::int64_t, double, std::string>;
    /// A column of a table.
    struct Column {
        std::string name;
        Type type = Type::text;
    };
    std::vector<Column> columns;
    std::vector<std::vector<Value>> rows; ///< [as the columns] record r, from 1, is row r - 1: a value for each
};

/// A part of an arc that came from one feature.
struct Stretch {
    std::int64_t feature = 0; ///< number in its layer's order, from 1
    double from_m = 0.0;      ///< [m] along the arc from its upstream end
    double to_m = 0.0;        ///< [m] along the arc from its upstream end
};

/// What a file states about a line at a bifurcation.
enum class Channel : std::uint8_t { unknown, main, minor };

/// A river line of a file, in the grid's coordinates.
struct RiverLine {
    std::int64_t feature = 0;   ///< number in its layer, from 1; 0: drawn by import_lines through a lake
    std::vector<Vec3> vertices; ///< [m], coordinates rounded to 1e-6 m; z is NaN where the file has none
    std::string type;           ///< river type (Rosgen) from the type field, or ""
    std::int64_t rank = 0;      ///< flow rank from the direction field, decreasing downstream; 0: none
    int lambda = 0;             ///< generator of the network that grows from a stroke; 0: none
    std::int64_t down = 0;      ///< feature of the line downstream, by the file's links; 0: none
    /// [as the fields] Areas, discharge, orders and classes, the most reliable first: larger for larger rivers,
    /// 0: unknown. All lines of a file have the same fields, which are compared one after another.
    std::vector<double> size = {};
    Channel channel = Channel::unknown;
    std::string name = {};       ///< the river's name, or ""
    std::string artificial = {}; ///< kind of artificial channel ("waterway canal"), or ""
    std::int64_t id_shift = 0;   ///< feature is the file's own number plus this, for networks whose ids begin at 0
    int runs = 0;                ///< from a direction column: 1: as drawn, -1: against it, 0: unknown
    double area_m2 = 0.0;        ///< drainage area at its lower end from the file; 0: unknown
    std::int64_t from_node = 0;  ///< number of the node from which water comes, by the file; 0: unknown
    std::int64_t to_node = 0;    ///< of the node to which it goes
    bool begins_at_edge = false; ///< cut there at the grid's edge: the first vertex is no end of a river
    bool ends_at_edge = false;   ///< likewise the last vertex

    /// The file's own number of the line.
    std::int64_t number() const { return feature - id_shift; }
};

/// Why a line is left out of the network.
enum class LeftOut : std::uint8_t {
    filter,     ///< not a natural watercourse according to its fields
    coast,      ///< a coastline according to its fields
    grid,       ///< beyond the grid
    duplicate,  ///< duplicate of another line
    too_short,  ///< shorter than the snapping distance
    divergence, ///< the water takes another branch
    pruned,     ///< shorter than the recipe's limit
    head        ///< above the river's head in the terrain
};

/// A line, or part of one, that is left out of the network.
struct SecondaryLine {
    std::int64_t feature = 0;
    std::vector<Vec3> vertices; ///< [m] as RiverLine
    std::string reason;         ///< "minor channel", "FTYPE Coastline", ...
    std::int64_t record = 0;    ///< of its attributes, from 1; 0: none
    LeftOut cause = LeftOut::divergence;
};

/// The river lines of a file.
struct RiverLines {
    std::vector<RiverLine> lines;
    std::string crs;                           ///< of the coordinates
    std::string name;                          ///< file (and layer), for messages
    bool has_z = false;                        ///< every vertex has a height
    std::vector<RiverLine> channels = {};      ///< artificial channels, see network::keep_connectors
    std::vector<SecondaryLine> secondary = {}; ///< other lines that are not natural watercourses
    std::vector<Finding> findings = {}; ///< left_out [vertices]: features without a line; not_a_line [shapes], by type
    AttributeTable attributes = {};     ///< of the features, record = feature
    std::string rank_field = {};        ///< name of the field of ranks, or ""
    std::vector<Polygon> lakes = {};    ///< through which rivers run on that end at their shores; none overlap
};

/// A network file as read, before any check.
struct NetworkFile {
    static constexpr double not_in_file = std::numeric_limits<double>::quiet_NaN();
    /// Optional columns of a node, which thalweg derives itself; NaN or "": not in the file.
    struct NodeColumns {
        std::string kind = {};
        double deg_in = not_in_file;
        double deg_out = not_in_file;
        double basin_id = not_in_file;
        double strahler = not_in_file;
        double z_m = not_in_file;
        double dist_out_m = not_in_file;
        double area_m2 = not_in_file;
    };
    /// A node of a file.
    struct FileNode {
        std::int64_t id = 0;
        Vec3 at; ///< [m]
        NodeColumns columns = {};
    };
    /// Optional columns of an arc, which thalweg derives itself; NaN: not in the file.
    struct ArcColumns {
        double n_up = not_in_file;
        double topo_ord = not_in_file;
        double hack = not_in_file;
        double length_m = not_in_file;
        double length_3d_m = not_in_file;
        double straight_m = not_in_file;
        double z_up_m = not_in_file;
        double z_down_m = not_in_file;
        double dist_out_m = not_in_file;
        double slope = not_in_file;
    };
    /// An arc of a file.
    struct FileArc {
        std::int64_t id = 0;
        std::int64_t from_node = 0;
        std::int64_t to_node = 0;
        std::int64_t ds_arc = 0; ///< id of the arc downstream; 0 at an outlet
        std::int64_t strahler = 0;
        std::int64_t shreve = 0;
        std::int64_t basin = 0;
        std::vector<Vec3> line = {};                                  ///< [m] directed downstream
        double us_area_m2 = std::numeric_limits<double>::quiet_NaN(); ///< NaN: unknown
        double ds_area_m2 = std::numeric_limits<double>::quiet_NaN();
        double own_area_m2 = std::numeric_limits<double>::quiet_NaN(); ///< of its own catchment
        double persistence = std::numeric_limits<double>::infinity();  ///< [cells]
        std::int64_t feature = 0;      ///< number in its layer, from 1; schema native: the file's value, 0 for none
        std::int64_t record = 0;       ///< of its attributes, from 1; 0 for none
        std::vector<double> size = {}; ///< as RiverLine
        Channel channel = Channel::unknown; ///< as RiverLine
        std::int64_t rank = 0;              ///< as RiverLine
        std::string name = {};              ///< as RiverLine
        std::int64_t path = 0;              ///< number of its level path; 0: unknown
        double level = 0.0;                 ///< class of its stem, greater for lesser ones; 0: unknown
        std::string unnatural = {};         ///< why it is not a natural watercourse, or ""
        bool is_channel = false;            ///< unnatural, but carries water: a canal, ditch, drain or pipe
        int runs = 0;                       ///< as RiverLine
        std::vector<Stretch> sources = {};  ///< the features it consists of, if the file names them
        std::string type = {};
        bool braided = false;
        bool is_input = true; ///< as Arc
        ArcColumns columns = {};
    };
    /// Which parts the file itself contains. The reader derives the others or leaves them empty; they are not checked.
    struct Says {
        bool nodes = true;      ///< nodes; otherwise derived from the ends of arcs
        bool ends = true;       ///< arcs name their nodes; otherwise joined by equal plan position
        bool downstream = true; ///< ds_arc
        bool strahler = true;
        bool shreve = true;
        bool basin = true;
        bool heights = true; ///< z; otherwise NaN
        bool areas = true;
    };
    std::vector<FileNode> nodes;
    std::vector<FileArc> arcs;
    AttributeTable attributes = {}; ///< of the layer of arcs
    Says says = {};
    std::string crs = {};               ///< of the coordinates, "" for none
    std::string schema = "native";      ///< naming scheme of its fields
    std::int64_t id_shift = 0;          ///< added to the file's arc ids: TauDEM's begin at 0, which means none here
    std::vector<Finding> findings = {}; ///< what the reader had to change
};

} // namespace thalweg
