// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/rivers_layer.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/suggest.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {

namespace {

enum class Holds : std::uint8_t { lines, other, nothing };

bool is_line(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return OGR_GT_IsSubClassOf(flat, wkbCurve) != 0 || OGR_GT_IsSubClassOf(flat, wkbMultiCurve) != 0;
}

// A layer of any shapes holds lines when one of its first features is one: exports of OpenStreetMap begin with nodes.
Holds content_of(OGRLayer& layer, std::string const& what) {
    constexpr int most_features = 1000000;
    auto const type = wkbFlatten(layer.GetGeomType());
    if (type != wkbUnknown && !is_line(type)) {
        return type == wkbGeometryCollection ? Holds::lines : Holds::other;
    }
    Driver const driver;
    Holds holds = Holds::nothing;
    layer.ResetReading();
    for (int i = 0; i < most_features && holds != Holds::lines; ++i) {
        OGRFeatureUniquePtr const feature(layer.GetNextFeature());
        if (!feature) {
            break;
        }
        OGRGeometry const* const shape = feature->GetGeometryRef();
        auto const drawn = shape == nullptr ? type : wkbFlatten(shape->getGeometryType());
        holds = is_line(drawn) || drawn == wkbGeometryCollection ? Holds::lines : Holds::other;
    }
    layer.ResetReading();
    driver.check(fmt::format("{}, layer {}", what, layer.GetName()));
    return holds;
}

/// How clearly a name says that a layer holds the rivers: 0 most; anything else is more than any.
std::size_t rank_of(std::string_view name) {
    // thalweg; NHD and NHDPlus HR; EU-Hydro; OpenStreetMap; OS Open Rivers; and what people call them.
    static constexpr std::array exact{"arcs",      "nhdflowline", "networknhdflowline", "nhdflowlinenetwork",
                                      "rivernetl", "waterways",   "watercourselink"};
    static constexpr std::array parts{"hydrorivers", "flowline", "waterway", "watercourse", "river", "stream"};
    std::string const own = simple_name(name);
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (own == exact[i]) {
            return i;
        }
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (own.find(parts[i]) != std::string::npos && own.find("catchment") == std::string::npos &&
            own.find("nonnetwork") == std::string::npos) {
            return exact.size() + i;
        }
    }
    return exact.size() + parts.size();
}

std::vector<std::string> layer_names_of(std::vector<OGRLayer*> const& layers) {
    std::vector<std::string> names;
    for (OGRLayer* const layer : layers) {
        names.emplace_back(layer->GetName());
    }
    return names;
}

OGRLayer& named(std::vector<OGRLayer*> const& layers, std::string const& wanted, std::string const& what) {
    auto const at = std::ranges::find_if(layers, [&](OGRLayer* layer) { return layer->GetName() == wanted; });
    if (at == layers.end()) {
        auto const names = layer_names_of(layers);
        throw BadInput(fmt::format(
            "{} has no layer '{}'.{}", what, wanted,
            names.empty() ? "" : fmt::format("{} ({})", did_you_mean(wanted, names), fmt::join(names, ", "))));
    }
    auto const type = wkbFlatten((*at)->GetGeomType());
    if (type != wkbUnknown && type != wkbGeometryCollection && !is_line(type)) {
        throw BadInput(fmt::format("{}, layer {}: it holds {}, not lines", what, wanted, OGRGeometryTypeToName(type)));
    }
    return **at;
}

struct LineLayers {
    std::vector<OGRLayer*> lines;
    std::vector<OGRLayer*> empty; ///< that may get some
};

LineLayers line_layers(GDALDataset& data, std::string const& what) {
    LineLayers found;
    std::vector<OGRLayer*> all;
    for (OGRLayer* const layer : data.GetLayers()) {
        all.push_back(layer);
        Holds const holds = content_of(*layer, what);
        if (holds != Holds::other) {
            (holds == Holds::lines ? found.lines : found.empty).push_back(layer);
        }
    }
    if (found.lines.empty() && found.empty.empty()) {
        throw BadInput(fmt::format("{} has no layer with lines{}", what,
                                   all.empty() ? "" : fmt::format(" ({})", fmt::join(layer_names_of(all), ", "))));
    }
    return found;
}

} // namespace

void require_lines(GDALDataset& data, std::string const& name, std::string const& who) {
    line_layers(data, who + ": " + name);
}

OGRLayer& rivers_layer(GDALDataset& data, std::string const& wanted, std::string const& name, std::string const& who) {
    std::string const what = who + ": " + name;
    if (!wanted.empty()) {
        std::vector<OGRLayer*> layers;
        for (OGRLayer* const layer : data.GetLayers()) {
            layers.push_back(layer);
        }
        return named(layers, wanted, what);
    }
    LineLayers const found = line_layers(data, what);
    std::vector<OGRLayer*> const& lines = found.lines.empty() ? found.empty : found.lines;
    auto const less = [](OGRLayer* a, OGRLayer* b) { return rank_of(a->GetName()) < rank_of(b->GetName()); };
    OGRLayer* const best = *std::ranges::min_element(lines, less);
    if (std::ranges::count_if(lines, [&](OGRLayer* l) { return !less(best, l); }) > 1) {
        throw BadInput(fmt::format("{} has {} layers with lines ({}): name the one with the rivers, "
                                   "--set network.lines.layer=NAME",
                                   what, lines.size(), fmt::join(layer_names_of(lines), ", ")));
    }
    return *best;
}

} // namespace thalweg::io
