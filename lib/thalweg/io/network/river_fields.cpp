// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/river_fields.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>

namespace thalweg::io {

namespace {

using LinkFields = std::pair<std::string_view, std::string_view>;

// The fields of a line's own id and of the id downstream; the first pair that a layer has counts.
constexpr std::array<LinkFields, 9> known_links{{
    {"arc_id", "ds_arc"},        // thalweg, before the columns of a user
    {"hydroseq", "dnhydroseq"},  // NHDPlus
    {"comid", "tocomid"},        // nhdplusTools
    {"comid", "nextdownid"},     // MERIT-Basins
    {"hyriv_id", "next_down"},   // HydroRIVERS
    {"object_id", "nextdownid"}, // EU-Hydro
    {"linkno", "dslinkno"},      // TauDEM
    {"stream", "next_stream"},   // GRASS
    {"cat", "next_stream"},
}};

// How great a river is, the most telling first: what a minor channel carries, areas, discharge, orders. Where one is
// the same for two rivers, the next tells.
constexpr std::array<std::string_view, 16> river_sizes{
    "divdasqkm",  "upland_skm",  "uparea",   "dis_av_cms", "ds_area",   "dscontarea", "totdasqkm", "streamcalc",
    "streamorde", "streamorder", "ord_stra", "strahler",   "strmorder", "stream_ord", "strord",    "horton"};

// Drainage areas at the lower end of a line, and their unit [m2].
constexpr std::array<std::pair<std::string_view, double>, 5> river_areas{{
    {"totdasqkm", 1e6},  // NHDPlus
    {"upland_skm", 1e6}, // HydroRIVERS
    {"uparea", 1e6},     // MERIT-Basins
    {"dscontarea", 1.0}, // TauDEM
    {"ds_area", 1.0},    // thalweg
}};

// The same as classes, of which 1 is the greatest.
constexpr std::array<std::string_view, 5> river_classes{"streamleve", "streamlevel", "ord_clas", "ord_flow", "hack"};

constexpr std::array<std::string_view, 6> river_names{"name",       "gnis_name", "nametxtint",
                                                      "river_name", "rivername", "riv_name"};

// Whether water runs as a line is drawn: INSPIRE and NHN, OS Open Rivers (GeoPackage and shapefile), BD TOPAGE.
constexpr std::array<std::string_view, 4> river_directions{"flowdirection", "flow_direction", "flow", "sensecoul"};

// Values of OpenStreetMap's key waterway that are natural watercourses.
constexpr std::array<std::string_view, 8> natural_waterways{"river", "stream", "tidal_channel", "brook",
                                                            "creek", "wadi",   "rapids",        "waterfall"};

// Values that name artificial channels.
constexpr std::array<std::string_view, 5> artificial_waterways{"canal", "ditch", "drain", "pressurised", "pipeline"};

// What lines of OpenStreetMap are besides; its extracts hold them all in one layer.
constexpr std::array<std::string_view, 6> osm_ways{"highway", "railway", "aerialway", "barrier", "power", "route"};

template <std::size_t N> int first_of(OGRFeatureDefn& schema, std::array<std::string_view, N> const& wanted) {
    for (std::string_view const name : wanted) {
        if (int const field = schema.GetFieldIndex(std::string(name).c_str()); field >= 0) {
            return field;
        }
    }
    return -1;
}

bool is_number_field(OGRFeatureDefn& schema, int field) {
    auto const type = schema.GetFieldDefn(field)->GetType();
    return type == OFTInteger || type == OFTInteger64 || type == OFTReal;
}

template <std::size_t N>
std::vector<int> numbers_among(OGRFeatureDefn& schema, std::array<std::string_view, N> const& wanted) {
    std::vector<int> found;
    for (std::string_view const name : wanted) {
        int const field = schema.GetFieldIndex(std::string(name).c_str());
        if (field >= 0 && is_number_field(schema, field)) {
            found.push_back(field);
        }
    }
    return found;
}

std::string small_letters(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// NHD: 566xx coastline, 428xx pipeline, 336xx canal or ditch.
std::string kind_of_fcode(double code) {
    switch (static_cast<int>(code) / 100) {
    case 566: return "Coastline";
    case 428: return "Pipeline";
    case 336: return "CanalDitch";
    default: return "";
    }
}

} // namespace

void RiverFields::find_links(OGRFeatureDefn& schema) {
    for (auto const& [own, down] : known_links) {
        id_ = schema.GetFieldIndex(std::string(own).c_str());
        down_ = schema.GetFieldIndex(std::string(down).c_str());
        if (id_ >= 0 && down_ >= 0) {
            return;
        }
    }
    id_ = down_ = -1;
}

RiverFields::RiverFields(OGRLayer& layer, int id, int down) {
    OGRFeatureDefn& schema = *layer.GetLayerDefn();
    auto const find = [&](char const* name) { return schema.GetFieldIndex(name); };
    find_links(schema);
    if (id >= 0 && down >= 0) {
        id_ = id;
        down_ = down;
    }
    auto const numeric = [&](int field) { return field >= 0 && is_number_field(schema, field) ? field : -1; };
    divergence_ = numeric(find("divergence"));
    calculated_order_ = numeric(find("streamcalc"));
    order_ = numeric(find("streamorde") >= 0 ? find("streamorde") : find("streamorder"));
    sizes_ = numbers_among(schema, river_sizes);
    classes_ = numbers_among(schema, river_classes);
    for (auto const& [name, unit_m2] : river_areas) {
        if (area_ < 0) {
            area_ = numeric(find(std::string(name).c_str()));
            area_unit_m2_ = unit_m2;
        }
    }
    name_ = first_of(schema, river_names);
    direction_ = first_of(schema, river_directions);
    is_coded_ = direction_ >= 0 && small_letters(schema.GetFieldDefn(direction_)->GetNameRef()) == "flowdirection";
    waterway_ = find("waterway");
    tunnel_ = find("tunnel");
    man_made_ = find("man_made");
    natural_ = find("natural");
    for (std::string_view const way : osm_ways) {
        if (int const field = find(std::string(way).c_str()); waterway_ >= 0 && field >= 0) {
            ways_.push_back(field);
        }
    }
    ftype_ = find("ftype");
    fcode_ = numeric(find("fcode"));
}

std::string RiverFields::text(OGRFeature const& feature, int field) {
    return field >= 0 && feature.IsFieldSetAndNotNull(field) != 0 ? as_utf8(feature.GetFieldAsString(field)) : "";
}

double RiverFields::number(OGRFeature const& feature, int field) {
    double const value = field >= 0 && feature.IsFieldSetAndNotNull(field) != 0 ? feature.GetFieldAsDouble(field) : 0.0;
    return std::isfinite(value) ? value : 0.0;
}

// Without case and spaces, of an INSPIRE code list its last part.
int RiverFields::runs_of(OGRFeature const& feature) const {
    std::string value = small_letters(text(feature, direction_));
    std::erase_if(value, [](char c) { return c == ' ' || c == '_'; });
    value.erase(0, value.rfind('/') + 1);
    if (value == "indirection" || value == "sensdirect" || (is_coded_ && value == "1")) {
        return 1;
    }
    return value == "inoppositedirection" || value == "sensinverse" || (is_coded_ && value == "2") ? -1 : 0;
}

void RiverFields::read(OGRFeature const& feature, RiverLine& line) {
    line.size.clear();
    for (int const field : sizes_) {
        line.size.push_back(std::max(0.0, number(feature, field)));
    }
    for (int const field : classes_) {
        double const of = number(feature, field);
        line.size.push_back(of >= 1.0 ? 1.0 / of : 0.0);
    }
    line.area_m2 = std::max(0.0, number(feature, area_) * area_unit_m2_);
    line.name = text(feature, name_);
    line.runs = runs_of(feature);
    double const divergence = number(feature, divergence_);
    bool const minor_path = calculated_order_ >= 0 && feature.IsFieldSetAndNotNull(calculated_order_) != 0 &&
                            number(feature, calculated_order_) == 0.0 && number(feature, order_) > 0.0;
    if (divergence == 1.0) {
        line.channel = Channel::main;
    } else if (divergence == 2.0 || minor_path) {
        line.channel = Channel::minor;
    }
    if (std::string const own = text(feature, id_); !own.empty()) {
        feature_of_.try_emplace(own, line.feature);
        if (std::string const down = text(feature, down_); !down.empty() && down != own) {
            down_id_.emplace(line.feature, down);
        }
    }
}

RiverFields::Unnatural RiverFields::unnatural(OGRFeature const& feature) const {
    if (std::string const kind = small_letters(text(feature, waterway_));
        !kind.empty() && std::ranges::find(natural_waterways, kind) == natural_waterways.end()) {
        return {"waterway " + kind, std::ranges::find(artificial_waterways, kind) != artificial_waterways.end()};
    }
    if (text(feature, waterway_).empty()) {
        for (int const way : ways_) {
            if (std::string const kind = small_letters(text(feature, way)); !kind.empty()) {
                return {fmt::format("{} {}", small_letters(feature.GetFieldDefnRef(way)->GetNameRef()), kind)};
            }
        }
    }
    if (small_letters(text(feature, natural_)) == "coastline") {
        return {"natural coastline"};
    }
    if (std::string const tunnel = small_letters(text(feature, tunnel_)); tunnel == "flooded") {
        return {"tunnel " + tunnel, true};
    }
    if (std::string const made = small_letters(text(feature, man_made_)); made == "pipeline") {
        return {"man_made " + made, true};
    }
    // NHD gives its types in words, or by their numbers.
    std::string const type = text(feature, ftype_);
    std::string const kind = small_letters(type);
    if (kind == "coastline" || kind == "566") {
        return {"FTYPE " + type};
    }
    if (kind == "pipeline" || kind == "canalditch" || kind == "428" || kind == "336") {
        return {"FTYPE " + type, true};
    }
    if (std::string const of_code = kind_of_fcode(number(feature, fcode_)); !of_code.empty()) {
        return {fmt::format("FCODE {} {}", text(feature, fcode_), of_code), of_code != "Coastline"};
    }
    return {};
}

bool RiverFields::is_coast(OGRFeature const& feature) const {
    std::string const type = small_letters(text(feature, ftype_));
    return type == "coastline" || type == "566" || kind_of_fcode(number(feature, fcode_)) == "Coastline" ||
           small_letters(text(feature, natural_)) == "coastline";
}

std::int64_t RiverFields::down_of(std::int64_t feature) const {
    auto const down = down_id_.find(feature);
    auto const below = down == down_id_.end() ? feature_of_.end() : feature_of_.find(down->second);
    return below == feature_of_.end() || below->second == feature ? 0 : below->second;
}

void RiverFields::link(std::vector<RiverLine>& lines) const {
    for (RiverLine& line : lines) {
        line.down = down_of(line.feature);
    }
}

} // namespace thalweg::io
