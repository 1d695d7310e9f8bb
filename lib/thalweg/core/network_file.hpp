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

/// A network file as it was read, before anything is believed of it.
struct NetworkFile {
    static constexpr double untold = std::numeric_limits<double>::quiet_NaN();
    /// What the file says of a node that follows from the rest; NaN, or "", where it does not.
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
    /// A node as in a file.
    struct FileNode {
        std::int64_t id = 0;
        Vec3 at; ///< [m]
        NodeColumns columns = {};
    };
    /// What the file says of an arc that follows from the rest; NaN where it does not.
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
    /// An arc as in a file.
    struct FileArc {
        std::int64_t id = 0;
        std::int64_t from_node = 0;
        std::int64_t to_node = 0;
        std::int64_t ds_arc = 0; ///< id of the arc downstream; 0 at an outlet
        std::int64_t strahler = 0;
        std::int64_t shreve = 0;
        std::int64_t basin = 0;
        std::vector<Vec3> line = {};                                  ///< [m] as drawn, downstream under every schema
        double us_area_m2 = std::numeric_limits<double>::quiet_NaN(); ///< NaN where the file does not say
        double ds_area_m2 = std::numeric_limits<double>::quiet_NaN();
        double persistence = std::numeric_limits<double>::infinity(); ///< [cells]
        std::int64_t feature = 0;      ///< number in its layer's order, from 1; native: as the file says, 0 for none
        std::int64_t record = 0;       ///< of its attributes, from 1; 0 for none
        std::vector<double> size = {}; ///< as RiverLine
        Channel channel = Channel::unknown; ///< likewise
        std::int64_t rank = 0;              ///< likewise
        std::string name = {};              ///< likewise
        std::string unnatural = {};         ///< why it is not a natural watercourse, or ""
        std::vector<Stretch> sources = {};  ///< the features it is made of, where the file has them
        std::string type = {};
        bool braided = false;
        bool is_input = true; ///< as Arc
        ArcColumns columns = {};
    };
    /// What the file says. The rest was filled in by what reads it, or left alone, and is not to be checked.
    struct Says {
        bool nodes = true;      ///< has nodes of its own; else one was made for each end of an arc
        bool ends = true;       ///< arcs name their nodes; else nodes were told apart by their exact places in plan
        bool downstream = true; ///< ds_arc
        bool strahler = true;
        bool shreve = true;
        bool basin = true;
        bool heights = true; ///< z; else it is NaN
        bool areas = true;
    };
    std::vector<FileNode> nodes;
    std::vector<FileArc> arcs;
    AttributeTable attributes = {}; ///< of the layer of arcs
    Says says = {};
    std::string crs = {};          ///< of the coordinates, "" for none
    std::string schema = "native"; ///< how its fields were understood
    std::int64_t id_shift = 0;     ///< arc ids here are the file's and this: TauDEM's begin at 0, which is none here
    std::vector<Finding> findings = {}; ///< of reading: what had to be bent to be held here
};

} // namespace thalweg
