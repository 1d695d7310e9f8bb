// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The lakes of a river file.
#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {
namespace {

// OpenStreetMap's values of `water` that are no lakes: rivers run in them as lines.
constexpr std::array running_water{"river", "canal",  "stream",     "ditch",    "drain",    "moat",
                                   "lock",  "rapids", "wastewater", "fountain", "fish_pass"};
// NHD's FTYPE: lakes, reservoirs, playas, swamps, and areas of rivers.
constexpr std::array types_of_nhd{"390",      "436",       "361",   "466",        "460",
                                  "lakepond", "reservoir", "playa", "swampmarsh", "streamriver"};
// What other schemas call lakes, as simple_name() makes it; columns as the filter of lines has them.
constexpr std::array lake_words{"lake",     "lakes",     "lakepond", "reservoir",  "pond",          "lagoon",
                                "lac",      "plandeau",  "retenue",  "lacmare",    "see",           "stehendesgewsser",
                                "meerplas", "meer",      "plas",     "innsj",      "innsjregulert", "sj",
                                "lago",     "laguna",    "embalse",  "represa",    "lagoalagoa",    "lagoa",
                                "44006",    "waterbody", "aude",     "massadagua", "water",         "inlandwater"};
// Parts of names of layers, as simple_name() makes them.
constexpr std::array lake_names{"lake",
                                "waterbod",
                                "reservoir",
                                "pond",
                                "plandeau",
                                "lagos",
                                "laghi",
                                "lagoa",
                                "laguna",
                                "embalse",
                                "massadagua",
                                "innsj",
                                "jarvi",
                                "waterarea",
                                "stehgew",
                                "stehende",
                                "waterdeelvlak",
                                "sjoar",
                                "stehendesgewsser",
                                "standingwater",
                                "surfacewater",
                                "hydroarea",
                                "hydropoly",
                                "jezior",
                                "jezer",
                                "nadrz",
                                "nhdarea"};
constexpr std::array whole_lake_names{"see", "seen", "lac", "lacs", "water", "sjo", "sj", "sjar", "meren", "plassen"};
// Layers of land around lakes are named for these as well.
constexpr std::array land_names{"catchment", "watershed", "basin",  "bassin", "einzugsgebiet", "cuenca", "bacia",
                                "district",  "buffer",    "region", "park",   "landuse",       "county", "municipal"};
// Names and descriptions of land.
constexpr std::array land_words{"catchment",  "watershed",     "drainagebasin",
                                "riverbasin", "bassinversant", "einzugsgebiet"};
// Keys of OpenStreetMap whose values say that a polygon is something on land.
constexpr std::array land_keys{"boundary", "admin_level", "place",     "building", "leisure",
                               "amenity",  "highway",     "landcover", "man_made", "military",
                               "tourism",  "railway",     "power",     "aeroway",  "barrier",
                               "historic", "geological",  "office",    "shop",     "area:highway"};
// Columns of units of land, by their names or how these begin, as simple_name() makes them.
constexpr std::array land_columns{"isoa2",   "isoa3",   "adm0a3",  "admin",     "country",   "nutsid",    "hybasid",
                                  "mainbas", "basinid", "catchid", "catchment", "watershed", "sovereignt"};
constexpr std::array land_column_starts{"huc", "gid0", "gid1", "gid2"};

bool has_part(std::string_view text, auto const& parts) {
    return std::ranges::any_of(parts, [&](std::string_view part) { return text.find(part) != std::string::npos; });
}

bool is_one_of(std::string_view word, auto const& words) {
    return std::ranges::find(words, word) != words.end();
}

bool is_area(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbSurface) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiSurface) != 0;
}

bool is_named_for_lakes(OGRLayer& layer) {
    std::string const own = simple_name(layer.GetName());
    return (is_one_of(own, whole_lake_names) || has_part(own, lake_names)) && !has_part(own, land_names);
}

void add_areas(OGRGeometry const& shape, std::int64_t feature, std::vector<Polygon>& lakes) {
    auto const flat = wkbFlatten(shape.getGeometryType());
    if (OGR_GT_IsSubClassOf(flat, wkbGeometryCollection) != 0) {
        for (auto const* const part : *shape.toGeometryCollection()) {
            add_areas(*part, feature, lakes);
        }
        return;
    }
    if (flat != wkbPolygon && flat != wkbTriangle) {
        return;
    }
    Polygon lake{feature, {}};
    for (auto const* const drawn : *shape.toPolygon()) {
        std::vector<Vec2> ring;
        for (int i = 0; i + 1 < drawn->getNumPoints(); ++i) { // the last vertex equals the first
            ring.push_back({drawn->getX(i), drawn->getY(i)});
        }
        if (ring.size() > 2 && std::ranges::all_of(ring, [](Vec2 p) { return is_finite(p); })) {
            lake.rings.push_back(std::move(ring));
        } else if (lake.rings.empty()) {
            return;
        }
    }
    lakes.push_back(std::move(lake));
}

} // namespace

LakeFilter::LakeFilter(OGRLayer& layer)
    : all_tags_(FileColumn::with_tags(layer)), ftype_(layer, {"ftype"}, false), is_named_(is_named_for_lakes(layer)),
      is_of_land_(has_part(simple_name(layer.GetName()), land_names)) {
    for (char const* key : {"natural", "water", "waterway", "landuse"}) {
        tags_.emplace_back(key, FileColumn(layer, {key}, false));
    }
    for (char const* key : land_keys) {
        tags_.emplace_back(key, FileColumn(layer, {key}, false));
    }
    for (char const* name : {"featurecla", "fclass", "nature", "objart", "objektart", "objtype", "typewater", "type",
                             "waterdefinition", "class", "kind", "featuretype", "category"}) {
        if (FileColumn column(layer, {name}, false); column.is_there()) {
            kinds_.push_back(std::move(column));
        }
    }
    for (char const* name : {"description", "name", "title", "label"}) {
        if (FileColumn column(layer, {name}, false); column.is_there()) {
            words_.push_back(std::move(column));
        }
    }
    for (std::string const& name : field_names(layer)) {
        std::string const own = simple_name(name);
        if (is_one_of(own, land_columns) ||
            std::ranges::any_of(land_column_starts, [&](std::string_view start) { return own.starts_with(start); })) {
            units_.emplace_back(layer, std::vector<std::string>{name}, false);
        }
    }
    is_tagged_ = all_tags_.is_there() || FileColumn(layer, {"osm_id", "osm_way_id", "@id"}, false).is_there();
}

std::string LakeFilter::tag(OGRFeature const& feature, std::string_view key) const {
    auto const column = std::ranges::find(tags_, key, &std::pair<std::string, FileColumn>::first);
    std::string const own = column == tags_.end() ? "" : column->second.text(feature);
    return lower_case(own.empty() && all_tags_.is_there() ? value_of_tag(all_tags_.text(feature), key) : own);
}

// What is said of a polygon comes first; one of which nothing is said is a lake.
bool LakeFilter::is_lake(OGRFeature const& feature) const {
    if (std::string const type = simple_name(ftype_.text(feature)); !type.empty() && !is_tagged_) {
        return is_one_of(type, types_of_nhd);
    }
    std::string const natural = tag(feature, "natural");
    std::string const water = tag(feature, "water");
    std::string const landuse = tag(feature, "landuse");
    bool const runs = is_one_of(water, running_water) || !tag(feature, "waterway").empty();
    bool const is_water = natural == "water" || (natural.empty() && !water.empty() && water != "no");
    if (landuse == "reservoir" || (is_water && !runs)) {
        return true;
    }
    auto const is_land = [&] {
        return std::ranges::any_of(land_keys, [&](char const* key) { return !tag(feature, key).empty(); });
    };
    if (is_tagged_ || runs || !natural.empty() || !landuse.empty() || is_land()) {
        return false;
    }
    bool says_other = false;
    for (FileColumn const& kind : kinds_) {
        std::string const word = simple_name(kind.text(feature));
        if (is_one_of(word, lake_words)) {
            return true;
        }
        says_other = says_other || !kind.text(feature).empty();
    }
    if (is_named_) {
        return true;
    }
    auto const is_unit = [&](FileColumn const& unit) { return !unit.text(feature).empty(); };
    auto const speaks_of_land = [&](FileColumn const& words) {
        return has_part(simple_name(words.text(feature)), land_words);
    };
    return !says_other && !is_of_land_ && std::ranges::none_of(units_, is_unit) &&
           std::ranges::none_of(words_, speaks_of_land);
}

bool LakeFilter::take(OGRFeature const& feature, std::int64_t number, std::vector<Polygon>& lakes) const {
    OGRGeometry const* const shape = feature.GetGeometryRef();
    if (shape == nullptr || !is_area(shape->getGeometryType()) || !is_lake(feature)) {
        return false;
    }
    std::unique_ptr<OGRGeometry> const straight(shape->getLinearGeometry());
    add_areas(*straight, number, lakes);
    return true;
}

bool may_hold_lakes(OGRLayer& layer) {
    return (wkbFlatten(layer.GetGeomType()) == wkbUnknown || is_area(layer.GetGeomType())) && is_named_for_lakes(layer);
}

std::vector<Polygon> lakes_of_layers(GDALDataset& data, std::vector<OGRLayer*> const& read, IntoMetres const& metres,
                                     OGRSpatialReference const& own, Run const& run) {
    std::vector<Polygon> lakes;
    for (OGRLayer* const layer : layers_of(data)) {
        bool const is_osm = EQUAL(layer->GetName(), "multipolygons");
        if (std::ranges::find(read, layer) != read.end() || !(is_osm || may_hold_lakes(*layer))) {
            continue;
        }
        OGRSpatialReference const crs = crs_of_layer(layer->GetSpatialRef(), "");
        if (crs.IsEmpty() == 0 && crs.IsSame(&own) == 0 && name_of(crs) != name_of(own)) {
            continue;
        }
        LakeFilter const filter(*layer);
        std::int64_t number = 0;
        for (auto const& feature : *layer) {
            run.check();
            filter.take(*feature, ++number, lakes);
        }
        layer->ResetReading();
    }
    return into_metres(std::move(lakes), metres);
}

std::vector<OGRLayer*> layers_of_areas(GDALDataset& data, About const& about) {
    std::vector<OGRLayer*> const all = layers_of(data);
    std::vector<OGRLayer*> areas = all;
    std::erase_if(areas, [](OGRLayer* layer) {
        return wkbFlatten(layer->GetGeomType()) != wkbUnknown && !is_area(layer->GetGeomType());
    });
    refuse_if<BadInput>(areas.size() != 1, about.where,
                        "{} has {} layers of polygons ({}): extract the one you mean (ogr2ogr)", about.name,
                        areas.size(), listed(layer_names(all)));
    return areas;
}

void drop_surroundings(std::vector<Polygon>& lakes, std::vector<RiverLine> const& lines,
                       std::vector<Finding>& findings) {
    if (lakes.empty()) {
        return;
    }
    std::vector<Vec2> places;
    std::vector<double> x;
    std::vector<double> y;
    for (RiverLine const& line : lines) {
        for (Vec3 const& v : line.vertices) {
            places.push_back(in_plan(v));
            x.push_back(v.x);
            y.push_back(v.y);
        }
    }
    // What holds more than half of the places has the two middle ones of each axis between its limits.
    std::size_t const half = places.size() / 2;
    std::ranges::nth_element(x, x.begin() + static_cast<std::ptrdiff_t>(half));
    std::ranges::nth_element(y, y.begin() + static_cast<std::ptrdiff_t>(half));
    std::erase_if(lakes, [&](Polygon const& lake) {
        std::vector<Vec2> const& shore = lake.rings.front();
        auto const [west, east] = std::ranges::minmax_element(shore, {}, &Vec2::x);
        auto const [south, north] = std::ranges::minmax_element(shore, {}, &Vec2::y);
        if (x[half] < west->x || x[half] > east->x || y[half] < south->y || y[half] > north->y) {
            return false;
        }
        auto const in = std::ranges::count_if(places, [&](Vec2 p) { return geometry::contains(shore, p); });
        bool const is_around = 2 * static_cast<std::size_t>(in) > places.size();
        if (is_around) {
            findings.push_back({"lake_left_out", lake.feature, shore.front(), 0.0,
                                fmt::format("polygon {} is no lake: most of the rivers lie in it", lake.feature)});
        }
        return is_around;
    });
}

std::vector<Polygon> into_metres(std::vector<Polygon> lakes, IntoMetres const& metres) {
    std::erase_if(lakes, [&](Polygon& lake) {
        bool is_placed = true;
        for (std::vector<Vec2>& ring : lake.rings) {
            std::vector<Vec3> points;
            for (Vec2 const p : ring) {
                points.push_back({p.x, p.y, 0.0});
            }
            is_placed = std::ranges::count(metres.apply(points), 0) == 0 && is_placed;
            for (std::size_t i = 0; i < ring.size(); ++i) {
                ring[i] = rounded(in_plan(points[i]));
            }
        }
        return !is_placed;
    });
    return lakes;
}

} // namespace thalweg::io
