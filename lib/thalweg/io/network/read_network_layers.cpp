// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network_layers.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/internal/read_network_columns.hpp>

namespace thalweg::io {

namespace {

std::string names_of(std::vector<OGRLayer*> const& layers) {
    std::vector<std::string> names;
    for (OGRLayer* const layer : layers) {
        names.emplace_back(layer->GetName());
    }
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

Layer named(OGRLayer& layer, std::string const& what, std::string const& name) {
    return {&layer, fmt::format("{}, layer {}", what, name)};
}

} // namespace

void Layer::each(Driver const& driver, Run const& run, std::function<void(OGRFeature const&)> const& body) const {
    GIntBig const announced = layer->GetFeatureCount();
    GIntBig read = 0;
    for (auto const& feature : *layer) {
        run.check();
        body(*feature);
        ++read;
    }
    driver.check(what);
    if (announced >= 0 && read != announced) {
        throw IoError(fmt::format("{}: {} of {} features could be read: the file is damaged", what, read, announced));
    }
}

bool takes_any_lines(Wish const& wish) {
    return wish.any_lines && wish.fields.empty();
}

Layer choose_arcs(NetworkSource const& source, Wish const& wish) {
    std::string const& what = source.what();
    if (!wish.arcs_layer.empty()) {
        if (OGRLayer* const layer = source.layer(wish.arcs_layer)) {
            return named(*layer, what, wish.arcs_layer);
        }
        throw BadInput(
            fmt::format("{} has no layer {} (there are {})", what, wish.arcs_layer, names_of(source.layers())));
    }
    if (OGRLayer* const layer = source.layer("arcs")) {
        return named(*layer, what, "arcs");
    }
    std::vector<OGRLayer*> lines = source.layers();
    if (wish.whole && (lines.size() != 1 || !may_hold_lines(*lines.front()))) {
        throw BadInput(what + " has no layer arcs");
    }
    std::erase_if(lines, [](OGRLayer* layer) { return !may_hold_lines(*layer); });
    if (lines.size() > 1) {
        std::vector<OGRLayer*> understood = lines;
        std::erase_if(understood, [](OGRLayer* layer) { return recognised(*layer).empty(); });
        lines = understood.size() == 1 ? understood : lines;
    }
    if (lines.size() != 1) {
        throw BadInput(
            lines.empty()
                ? fmt::format("{} has no layer of lines (there are {})", what, names_of(source.layers()))
                : fmt::format("{} has {} layers of lines; name one of them ({})", what, lines.size(), names_of(lines)));
    }
    return named(*lines.front(), what, wish.whole ? "arcs" : lines.front()->GetName());
}

std::optional<Schema> choose_schema(Layer const& arcs, Wish const& wish) {
    if (wish.schema) {
        return wish.schema;
    }
    auto const found = recognised(*arcs.layer);
    // Thalweg's own files hold the columns of the user's beside theirs.
    if (std::ranges::find(found, Schema::native) != found.end()) {
        return Schema::native;
    }
    if (found.size() == 1) {
        return found.front();
    }
    if (is_enough(wish.fields) || (found.empty() && takes_any_lines(wish))) {
        return std::nullopt;
    }
    std::vector<std::string_view> names;
    for (Schema const schema : found) {
        names.push_back(table_of(schema).name);
    }
    if (found.empty()) {
        throw BadInput(fmt::format(
            "{}: its fields ({}) match no schema ({}); name the schema, or the fields "
            "that hold arc_id and ds_arc, or arc_id, from_node and to_node{}",
            arcs.what, fields_of(*arcs.layer), what_tells(),
            arcs.layer->GetLayerDefn()->GetFieldCount() == 0 ? "; a shapefile without fields has lost its .dbf" : ""));
    }
    throw BadInput(
        fmt::format("{}: its fields match several schemas ({}); name one of them", arcs.what, fmt::join(names, ", ")));
}

std::optional<Layer> choose_nodes(NetworkSource const* source, NetworkSource const& arcs_source, Layer const& arcs,
                                  std::optional<Schema> schema, Wish const& wish) {
    if (!wish.nodes_layer.empty()) {
        for (NetworkSource const* const place : {source, &arcs_source}) {
            if (OGRLayer* const layer = place == nullptr ? nullptr : place->layer(wish.nodes_layer)) {
                return named(*layer, place->what(), wish.nodes_layer);
            }
        }
        throw BadInput(fmt::format("{} has no layer {} (there are {})", arcs_source.what(), wish.nodes_layer,
                                   names_of(arcs_source.layers())));
    }
    if (source == nullptr || (schema ? schema != Schema::native : takes_any_lines(wish))) {
        return std::nullopt;
    }
    if (OGRLayer* const layer = source->layer("nodes")) {
        return named(*layer, source->what(), "nodes");
    }
    auto const layers = source->layers();
    bool const own_file = layers.size() == 1 && layers.front() != arcs.layer;
    return own_file ? std::optional(named(*layers.front(), source->what(), "nodes")) : std::nullopt;
}

} // namespace thalweg::io
