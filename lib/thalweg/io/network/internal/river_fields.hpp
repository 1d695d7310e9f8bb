// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <thalweg/core/river_files.hpp>

class OGRFeature;
class OGRFeatureDefn;
class OGRLayer;

/// What the fields of river files say: NHDPlus, HydroRIVERS, EU-Hydro, OpenStreetMap, and the schemas of networks.
/// docs/river_files.md lists them.
namespace thalweg::io {

class RiverFields {
public:
    /// Finds the known fields in any case of letters. id, down: indices of the fields with a line's own id and that of
    /// the line downstream, where a user names both; else -1.
    explicit RiverFields(OGRLayer& layer, int id = -1, int down = -1);

    /// Sets channel, size, area, name and runs, and remembers the links of the feature.
    void read(OGRFeature const& feature, RiverLine& line);
    /// Why a feature is not a natural watercourse.
    struct Unnatural {
        std::string reason = {}; ///< "FTYPE Coastline"; "" where it is one, or no field says so
        bool is_channel = false; ///< it carries water: a canal, ditch, drain or pipe
    };
    Unnatural unnatural(OGRFeature const& feature) const;
    /// Whether it is a coastline.
    bool is_coast(OGRFeature const& feature) const;
    /// Whether there are fields of links.
    bool has_links() const { return down_ >= 0; }
    /// The feature downstream by the file's links, once every feature has been read; 0 where it names none.
    std::int64_t down_of(std::int64_t feature) const;
    /// Sets `down` of all lines, once every feature has been read.
    void link(std::vector<RiverLine>& lines) const;

private:
    void find_links(OGRFeatureDefn& schema);
    int runs_of(OGRFeature const& feature) const;
    static std::string text(OGRFeature const& feature, int field);
    static double number(OGRFeature const& feature, int field);

    int id_ = -1;
    int down_ = -1;
    int divergence_ = -1;
    int calculated_order_ = -1; ///< StreamCalc of NHDPlus: 0 on minor paths
    int order_ = -1;
    std::vector<int> sizes_;   ///< greater for greater rivers
    std::vector<int> classes_; ///< 1 for the greatest rivers
    int area_ = -1;
    double area_unit_m2_ = 1.0;
    int name_ = -1;
    int direction_ = -1;
    bool is_coded_ = false; ///< directions are 1 and 2
    int waterway_ = -1;
    int tunnel_ = -1;
    int man_made_ = -1;
    int natural_ = -1;
    std::vector<int> ways_; ///< roads, railways and the like in OpenStreetMap
    int ftype_ = -1;
    int fcode_ = -1;
    std::map<std::string, std::int64_t> feature_of_; ///< by own id: the first feature that has it
    std::map<std::int64_t, std::string> down_id_;    ///< by feature: the id downstream
};

} // namespace thalweg::io
