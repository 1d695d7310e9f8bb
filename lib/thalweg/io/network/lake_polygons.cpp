// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The lakes of a river file.
#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {
namespace {

// OpenStreetMap's values of `water` that are no lakes: rivers run in them as lines.
constexpr std::array running_water{"river", "canal", "stream",     "ditch",   "drain",
                                   "moat",  "lock",  "wastewater", "fountain"};
// NHD's FTYPE: lakes, reservoirs, playas, swamps, and areas of rivers.
constexpr std::array types_of_nhd{"390",      "436",       "361",   "466",        "460",
                                  "lakepond", "reservoir", "playa", "swampmarsh", "streamriver"};
// What other schemas call lakes, as simple_name() makes it; columns as the filter of lines has them.
constexpr std::array lake_words{"lake",     "lakes",     "lakepond", "reservoir",  "pond",          "lagoon",
                                "lac",      "plandeau",  "retenue",  "lacmare",    "see",           "stehendesgewsser",
                                "meerplas", "meer",      "plas",     "innsj",      "innsjregulert", "sj",
                                "lago",     "laguna",    "embalse",  "represa",    "lagoalagoa",    "lagoa",
                                "44006",    "waterbody", "aude",     "massadagua", "water",         "inlandwater"};
constexpr std::array lake_names{
    "lake",      "waterbod",       "reservoir",     "pond",        "plan_d_eau",       "plandeau",      "lagos",
    "laghi",     "lagoa",          "laguna",        "embalse",     "massadagua",       "innsj",         "jarvi",
    "waterarea", "waterdeel_vlak", "waterdeelvlak", "stehgewsser", "stehendesgewsser", "standingwater", "surfacewater",
    "hydroarea", "hydropoly",      "jezior"};

bool is_area(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbSurface) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiSurface) != 0;
}

bool is_named_for_lakes(OGRLayer& layer) {
    std::string const own = simple_name(layer.GetName());
    return own == "see" || own == "seen" || own == "lac" || own == "lacs" || own == "water" ||
           std::ranges::any_of(lake_names, [&](std::string_view part) { return own.find(part) != std::string::npos; });
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
    : all_tags_(layer, {"other_tags", "all_tags", "tags"}, false), ftype_(layer, {"ftype"}, false),
      is_named_(is_named_for_lakes(layer)) {
    for (char const* key : {"natural", "water", "waterway", "landuse"}) {
        tags_.emplace_back(key, FileColumn(layer, {key}, false));
    }
    for (char const* name : {"featurecla", "fclass", "nature", "objart", "objektart", "objtype", "typewater", "type",
                             "waterdefinition", "class", "kind"}) {
        if (FileColumn column(layer, {name}, false); column.is_there()) {
            kinds_.push_back(std::move(column));
        }
    }
    is_tagged_ = all_tags_.is_there() || FileColumn(layer, {"osm_id", "osm_way_id", "@id"}, false).is_there();
}

std::string LakeFilter::tag(OGRFeature const& feature, std::string_view key) const {
    auto const column = std::ranges::find(tags_, key, &std::pair<std::string, FileColumn>::first);
    std::string const own = column == tags_.end() ? "" : column->second.text(feature);
    return lower_case(own.empty() && all_tags_.is_there() ? value_of_tag(all_tags_.text(feature), key) : own);
}

bool LakeFilter::is_lake(OGRFeature const& feature) const {
    if (is_tagged_) {
        std::string const water = tag(feature, "water");
        std::string const landuse = tag(feature, "landuse");
        bool const runs = std::ranges::find(running_water, water) != running_water.end();
        return (tag(feature, "natural") == "water" && !runs) || landuse == "reservoir";
    }
    auto const is_among = [](auto const& list, std::string const& word) {
        return std::ranges::find(list, word) != list.end();
    };
    if (std::string const type = simple_name(ftype_.text(feature)); !type.empty()) {
        return is_among(types_of_nhd, type);
    }
    for (FileColumn const& kind : kinds_) {
        if (is_among(lake_words, simple_name(kind.text(feature)))) {
            return true;
        }
    }
    return is_named_ || kinds_.empty();
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

std::vector<Polygon> lakes_of_layers(GDALDataset& data, std::vector<OGRLayer*> const& read, IntoMetres const& metres,
                                     OGRSpatialReference const& own, Run const& run) {
    std::vector<Polygon> lakes;
    for (OGRLayer* const layer : layers_of(data)) {
        bool const is_osm = EQUAL(layer->GetName(), "multipolygons");
        bool const may_hold = wkbFlatten(layer->GetGeomType()) == wkbUnknown || is_area(layer->GetGeomType());
        if (std::ranges::find(read, layer) != read.end() || !may_hold || !(is_osm || is_named_for_lakes(*layer))) {
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

std::vector<OGRLayer*> layers_of_areas(GDALDataset& data, std::string const& what) {
    std::vector<OGRLayer*> const all = layers_of(data);
    std::vector<OGRLayer*> areas = all;
    std::erase_if(areas, [](OGRLayer* layer) {
        return wkbFlatten(layer->GetGeomType()) != wkbUnknown && !is_area(layer->GetGeomType());
    });
    refuse_if<BadInput>(areas.size() != 1, "{} has {} layers of polygons ({}): extract the one you mean (ogr2ogr)",
                        what, areas.size(), listed(layer_names(all)));
    return areas;
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
