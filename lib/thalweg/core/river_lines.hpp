// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/attributes.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// What a file says of a line that leaves a place where water could go more than one way.
enum class Channel : std::uint8_t { unknown, main, minor };

/// One line somebody drew, as its file gives it, in the coordinates of the grid.
struct RiverLine {
    std::int64_t feature = 0;   ///< number in its layer's order, from 1
    std::vector<Vec3> vertices; ///< [m], coordinates rounded to 1e-6 m; z is NaN where the file has none
    std::string type;           ///< river type (Rosgen) from the type field, or ""
    std::int64_t rank = 0;      ///< flow rank from the direction field: falls downstream; 0 where there is none
    int lambda = 0;             ///< generator of the network a stroke grows; 0 where the file has none
    std::int64_t down = 0;      ///< feature of the line downstream, by the file's links; 0 where it names none
    /// Areas, discharge, orders, classes by the fields of the file, the most telling first: each greater for greater
    /// rivers, 0 where it is not known. All lines of a file have the same, and are compared one after another.
    std::vector<double> size = {};
    Channel channel = Channel::unknown;
    std::string name = {}; ///< the river's name, or ""
};

/// A line, or a part of one, that is not in the network, and why.
struct SecondaryLine {
    std::int64_t feature = 0;
    std::vector<Vec3> vertices; ///< [m] as RiverLine
    std::string reason;         ///< a few words: "minor channel", "FTYPE Coastline"
    std::int64_t record = 0;    ///< of its attributes, from 1; 0 for none
    bool is_coast = false;      ///< a coastline, as its fields say
};

/// Drawn lines and what their file says of them.
struct RiverLines {
    std::vector<RiverLine> lines;
    std::string crs;                           ///< of the coordinates
    std::string name;                          ///< file (and layer), for messages
    bool has_z = false;                        ///< every vertex has a height
    std::vector<SecondaryLine> secondary = {}; ///< lines of the file that are no natural watercourse
    std::vector<Finding> findings = {};        ///< left_out [vertices]: features that hold no line
    AttributeTable attributes = {};            ///< of the features, record = feature
};

} // namespace thalweg
