// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which layers of a file hold its rivers.
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/network/internal/read_network.hpp>

namespace thalweg::io {

std::vector<OGRLayer*> layers_of(GDALDataset& data) {
    auto const layers = data.GetLayers();
    return {layers.begin(), layers.end()};
}

bool is_osm_file(GDALDataset& data) {
    return data.GetDriver() != nullptr && EQUAL(data.GetDriver()->GetDescription(), "OSM");
}

void read_osm_layer(GDALDataset& data, char const* layer) {
    data.ReleaseResultSet(data.ExecuteSQL(fmt::format("SET interest_layers = {}", layer).c_str(), nullptr, nullptr));
}

std::vector<std::string> layer_names(std::vector<OGRLayer*> const& layers) {
    std::vector<std::string> names;
    for (OGRLayer* const layer : layers) {
        names.emplace_back(layer->GetName());
    }
    return names;
}

namespace {

bool is_line(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbCurve) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiCurve) != 0;
}

enum class Holds : std::uint8_t { lines, other, nothing };

// A layer of any shapes holds lines when one of its first features is one: exports of OpenStreetMap begin with nodes.
Holds content_of(OGRLayer& layer, About const& about) {
    constexpr int most_features = 1000000;
    auto const type = wkbFlatten(layer.GetGeomType());
    if (!may_hold_lines(layer)) {
        return Holds::other;
    }
    Driver const driver;
    Holds holds = Holds::nothing;
    int looked_at = 0;
    for (auto const& feature : layer) {
        if (holds == Holds::lines || ++looked_at > most_features) {
            break;
        }
        OGRGeometry const* const shape = feature->GetGeometryRef();
        auto const drawn = shape == nullptr ? type : wkbFlatten(shape->getGeometryType());
        holds = is_line(drawn) || drawn == wkbGeometryCollection ? Holds::lines : Holds::other;
    }
    layer.ResetReading();
    driver.check(about.where, fmt::format("{}, layer {}", about.name, layer.GetName()));
    return holds;
}

/// How clearly a name says that a layer holds the rivers: 0 most; all that do not say so are equal.
std::size_t rank_of(std::string_view name) {
    // thalweg; NHD and NHDPlus HR; EU-Hydro; OpenStreetMap; OS Open Rivers; and common names.
    static constexpr std::array exact{"arcs",      "nhdflowline", "networknhdflowline", "nhdflowlinenetwork",
                                      "rivernetl", "waterways",   "watercourselink"};
    static constexpr std::array parts{"hydrorivers", "flowline", "waterway", "watercourse", "river", "stream"};
    std::string const own = simple_name(name);
    auto const has = [&](char const* part) { return own.find(part) != std::string::npos; };
    if (auto const* const same = std::ranges::find(exact, own); same != exact.end()) {
        return static_cast<std::size_t>(same - exact.begin());
    }
    bool const is_other = has("catchment") || has("nonnetwork");
    auto const* const part = is_other ? parts.end() : std::ranges::find_if(parts, has);
    return exact.size() + static_cast<std::size_t>(part - parts.begin());
}

/// Whether a layer is one of those that GDAL makes of OpenStreetMap, or a copy of one: `lines` holds the ways, and the
/// others relations of these ways.
bool is_osm(OGRLayer& layer, std::string_view name) {
    return layer.GetName() == name && layer.GetLayerDefn()->GetFieldIndex("osm_id") >= 0;
}

/// The ways of OpenStreetMap, if a file is one of it. GDAL reads past the layers that are of no interest only when told
/// so; otherwise it gives up after a hundred thousand points.
OGRLayer* ways_of(GDALDataset& data) {
    OGRLayer* const lines = data.GetLayerByName("lines");
    if (lines == nullptr || !is_osm(*lines, "lines")) {
        return nullptr;
    }
    if (is_osm_file(data)) {
        read_osm_layer(data, "lines");
    }
    return lines;
}

/// The layers with lines; where there is none, those without features that may get some.
std::vector<OGRLayer*> line_layers(GDALDataset& data, About const& about) {
    if (OGRLayer* const ways = ways_of(data)) {
        return {ways};
    }
    std::vector<OGRLayer*> lines;
    std::vector<OGRLayer*> empty;
    std::vector<OGRLayer*> const all = layers_of(data);
    for (OGRLayer* const layer : all) {
        Holds const holds = content_of(*layer, about);
        if (holds != Holds::other) {
            (holds == Holds::lines ? lines : empty).push_back(layer);
        }
    }
    refuse_if<BadInput>(lines.empty() && empty.empty(), about.where, "{} has no layer with lines ({})", about.name,
                        listed(layer_names(all)));
    return lines.empty() ? empty : lines;
}

/// Folders of KML and tracks and routes of GPX are parts of one drawing.
bool belong_together(GDALDataset& data) {
    static constexpr std::array formats{"KML", "LIBKML", "GPX"};
    return data.GetDriver() != nullptr && std::ranges::any_of(formats, [&](char const* format) {
               return EQUAL(data.GetDriver()->GetDescription(), format);
           });
}

/// Whether the name of a KML folder says that its lines are no rivers, by its last word.
bool names_other_lines(OGRLayer* layer) {
    static constexpr std::array ends{"road",     "roads",      "streets",  "paths",        "trail",
                                     "trails",   "railway",    "railways", "border",       "borders",
                                     "boundary", "boundaries", "contours", "contourlines", "fences",
                                     "canal",    "canals",     "ditches",  "powerlines"};
    std::string const own = simple_name(layer->GetName());
    return std::ranges::any_of(ends, [&](char const* end) { return own.ends_with(end); });
}

std::string without_blanks(std::string_view text) {
    auto const first = std::min(text.find_first_not_of(" \t"), text.size());
    return std::string(text.substr(first, text.find_last_not_of(" \t") + 1 - first));
}

/// A layer by its name, or several whose names are separated by commas.
std::vector<OGRLayer*> named_layers(GDALDataset& data, std::string const& wanted, About const& about) {
    std::vector<OGRLayer*> const all = layers_of(data);
    auto const find = [&](std::string const& name) {
        return std::ranges::find(all, name, [](OGRLayer* layer) { return layer->GetName(); });
    };
    std::vector<std::string> parts{wanted};
    if (find(wanted) == all.end() && wanted.find(',') != std::string::npos) {
        parts.clear();
        for (std::size_t at = 0; at <= wanted.size();) {
            std::size_t const end = std::min(wanted.find(',', at), wanted.size());
            parts.push_back(without_blanks(std::string_view(wanted).substr(at, end - at)));
            at = end + 1;
        }
    }
    std::vector<OGRLayer*> found;
    for (std::string const& name : parts) {
        auto const at = find(name);
        if (at == all.end()) {
            auto const names = layer_names(all);
            throw BadInput(about.where, fmt::format("{} has no layer '{}'.{} ({})", about.name, name,
                                                    did_you_mean(name, names), listed(names)));
        }
        refuse_if<BadInput>(!may_hold_lines(**at), about.where, "{}, layer {}: it holds {}, not lines", about.name,
                            name, OGRGeometryTypeToName(wkbFlatten((*at)->GetGeomType())));
        if (std::ranges::find(found, *at) == found.end()) {
            found.push_back(*at);
        }
    }
    ways_of(data);
    return found;
}

constexpr char const* own_column = "layer";

/// A column for each field of any of the layers; fields of one name but different types become text.
void add_fields(OGRLayer& into, std::vector<OGRLayer*> const& layers) {
    OGRFeatureDefn fields;
    fields.Reference();
    OGRFieldDefn const own(own_column, OFTString);
    fields.AddFieldDefn(&own);
    for (OGRLayer* const layer : layers) {
        for (int i = 0; i < layer->GetLayerDefn()->GetFieldCount(); ++i) {
            OGRFieldDefn const& field = *layer->GetLayerDefn()->GetFieldDefn(i);
            int const known = fields.GetFieldIndex(field.GetNameRef());
            if (known < 0) {
                fields.AddFieldDefn(&field);
            } else if (fields.GetFieldDefn(known)->GetType() != field.GetType()) {
                fields.GetFieldDefn(known)->SetType(OFTString);
            }
        }
    }
    for (int i = 0; i < fields.GetFieldCount(); ++i) {
        into.CreateField(fields.GetFieldDefn(i));
    }
}

void copy_features(OGRLayer& into, OGRLayer& from, About const& about) {
    std::vector<int> column; // by field
    for (int i = 0; i < from.GetLayerDefn()->GetFieldCount(); ++i) {
        column.push_back(into.GetLayerDefn()->GetFieldIndex(from.GetLayerDefn()->GetFieldDefn(i)->GetNameRef()));
    }
    bool const has_own = from.GetLayerDefn()->GetFieldIndex(own_column) >= 0;
    for (auto const& feature : from) {
        OGRFeature copy(into.GetLayerDefn());
        copy.SetFrom(feature.get(), column.data(), TRUE);
        copy.SetFID(OGRNullFID);
        if (!has_own) {
            copy.SetField(own_column, from.GetName());
        }
        refuse_if<IoError>(into.CreateFeature(&copy) != OGRERR_NONE, about.where, "{}: no memory for layer {}",
                           about.name, from.GetName());
    }
}

/// [m] Length of the lines of a layer, in a CRS in metres.
double length_of(OGRLayer& layer, OGRSpatialReference const& own, std::string const& crs, std::string const& name) {
    IntoMetres const metres(own, crs, FilePlaces().box(), name);
    OtherShapes others;
    double length_m = 0.0;
    for (auto const& feature : layer) {
        if (OGRGeometry const* const shape = feature->GetGeometryRef()) {
            for (std::vector<Vec3>& part : parts_of(*shape, 0, others)) {
                bool const is_placed = std::ranges::count(metres.apply(part), 0) == 0;
                length_m += is_placed ? length_in_plan(part) : 0.0;
            }
        }
    }
    layer.ResetReading();
    return length_m;
}

/// 0 where a layer has no CRS, or cannot be measured otherwise.
double length_or_none(OGRLayer& layer, std::string const& crs, std::string const& source_crs, std::string const& name) {
    Driver const driver;
    try {
        OGRSpatialReference const own = crs_of_layer(layer.GetSpatialRef(), source_crs);
        return own.IsEmpty() != 0 || crs.empty() ? 0.0 : length_of(layer, own, crs, name);
    } catch (BadInput const&) {
        return 0.0;
    }
}

} // namespace

bool may_hold_lines(OGRLayer& layer) {
    auto const type = wkbFlatten(layer.GetGeomType());
    return type == wkbUnknown || type == wkbGeometryCollection || is_line(type);
}

void require_lines(GDALDataset& data, About const& about) {
    line_layers(data, about);
}

std::vector<OGRLayer*> rivers_layers(GDALDataset& data, std::string const& wanted, About const& about) {
    if (!wanted.empty()) {
        return named_layers(data, wanted, about);
    }
    std::vector<OGRLayer*> lines = line_layers(data, about);
    if (lines.size() > 1 && belong_together(data)) {
        std::vector<OGRLayer*> rivers = lines;
        std::erase_if(rivers, names_other_lines);
        return rivers.empty() ? lines : rivers;
    }
    auto const rank = [](OGRLayer* layer) { return rank_of(layer->GetName()); };
    OGRLayer* const best = *std::ranges::min_element(lines, {}, rank);
    if (std::ranges::count(lines, rank(best), rank) > 1) {
        throw BadInput(
            about.where,
            fmt::format("{} has {} layers with lines ({}): name the one with the rivers, --set "
                        "network.lines.layer=NAME (check and convert: --layer NAME), or several, separated by commas",
                        about.name, lines.size(), listed(layer_names(lines))));
    }
    return {best};
}

// Several layers as one.

ChosenLayer as_one(std::vector<OGRLayer*> const& layers, About const& about) {
    ChosenLayer chosen{layers.front(), listed(layer_names(layers))};
    if (layers.size() == 1) {
        return chosen;
    }
    OGRSpatialReference const crs = crs_of_layer(layers.front()->GetSpatialRef(), "");
    for (OGRLayer* const layer : layers) {
        OGRSpatialReference const own = crs_of_layer(layer->GetSpatialRef(), "");
        refuse_if<BadInput>(crs.IsEmpty() != own.IsEmpty() ||
                                (own.IsEmpty() == 0 && own.IsSame(&crs) == 0 && name_of(own) != name_of(crs)),
                            about.where,
                            "{}: layers {} and {} have different coordinate systems, and one drawing has one: "
                            "reproject one of them (ogr2ogr -t_srs)",
                            about.name, layers.front()->GetName(), layer->GetName());
    }
    Dataset memory(GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    refuse_if<IoError>(memory == nullptr, about.where, "{}: no memory for {}", about.name, chosen.name);
    chosen.layer = memory->CreateLayer(chosen.name.c_str(), layers.front()->GetSpatialRef(), wkbUnknown, nullptr);
    add_fields(*chosen.layer, layers);
    for (OGRLayer* const layer : layers) {
        copy_features(*chosen.layer, *layer, about);
    }
    chosen.holds = std::move(memory);
    return chosen;
}

// Layers that are not read.

std::vector<Finding> layers_not_read(GDALDataset& data, std::vector<OGRLayer*> const& read, std::string const& crs,
                                     std::string const& source_crs, About const& about) {
    if (is_in_network_schema(*read.front()) || is_osm(*read.front(), "lines")) {
        return {}; // whose other layers hold the same lines, or what the network left out
    }
    std::vector<OGRLayer*> others = layers_of(data);
    std::erase_if(others, [&](OGRLayer* layer) {
        return std::ranges::find(read, layer) != read.end() || content_of(*layer, about) != Holds::lines;
    });
    if (others.empty()) {
        return {};
    }
    double all_m = 0.0;
    std::vector<std::string> words;
    for (OGRLayer* const layer : others) {
        double const length_m = length_or_none(*layer, crs, source_crs, about.name);
        all_m += length_m;
        words.push_back(length_m > 0.0 ? fmt::format("{} ({:.1f} km)", layer->GetName(), length_m / 1000.0)
                                       : layer->GetName());
    }
    std::vector<std::string> all = layer_names(read);
    all.emplace_back(others.front()->GetName());
    return {{.kind = "layers_not_read",
             .amount = all_m,
             .text = fmt::format("{}: lines of other layers are not read: {}; rivers are those of {}", about.name,
                                 fmt::join(words, ", "), listed(layer_names(read))),
             .remedy = fmt::format("Take several by their names: network.lines.layer = \"{}\"", fmt::join(all, ",")),
             .key = "network.lines.layer",
             .layer = about.name}};
}

} // namespace thalweg::io
