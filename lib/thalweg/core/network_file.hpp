// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <thalweg/core/attributes.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// A network file as read, before any check.
struct NetworkFile {
    static constexpr double untold = std::numeric_limits<double>::quiet_NaN();
    /// Optional columns of a node, which thalweg derives itself; NaN or "": not in the file.
    struct NodeColumns {
        std::string kind = {};
        double deg_in = untold;
        double deg_out = untold;
        double basin_id = untold;
        double strahler = untold;
        double z_m = untold;
        double dist_out_m = untold;
        double area_m2 = untold;
    };
    /// A node of a file.
    struct FileNode {
        std::int64_t id = 0;
        Vec3 at; ///< [m]
        NodeColumns columns = {};
    };
    /// Optional columns of an arc, which thalweg derives itself; NaN: not in the file.
    struct ArcColumns {
        double n_up = untold;
        double topo_ord = untold;
        double hack = untold;
        double length_m = untold;
        double length_3d_m = untold;
        double straight_m = untold;
        double z_up_m = untold;
        double z_down_m = untold;
        double dist_out_m = untold;
        double slope = untold;
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
        double us_area_m2 = std::numeric_limits<double>::quiet_NaN(); ///< NaN: not in the file
        double ds_area_m2 = std::numeric_limits<double>::quiet_NaN();
        double persistence = std::numeric_limits<double>::infinity(); ///< [cells]
        std::int64_t feature = 0;      ///< number in its layer, from 1; schema native: the file's value, 0 for none
        std::int64_t record = 0;       ///< of its attributes, from 1; 0 for none
        std::vector<double> size = {}; ///< as RiverLine
        Channel channel = Channel::unknown; ///< likewise
        std::int64_t rank = 0;              ///< likewise
        std::string name = {};              ///< likewise
        std::string unnatural = {};         ///< why it is not a natural watercourse, or ""
        bool is_channel = false;            ///< unnatural, but carries water: a canal, ditch, drain or pipe
        int runs = 0;                       ///< as RiverLine
        std::vector<Stretch> sources = {};  ///< the features it is made of, if the file names them
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
