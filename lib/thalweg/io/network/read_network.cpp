// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_network.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/suggest.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/network/internal/read_network_arcs.hpp>
#include <thalweg/io/network/internal/read_network_columns.hpp>
#include <thalweg/io/network/internal/read_network_layers.hpp>
#include <thalweg/io/network/internal/read_network_links.hpp>
#include <thalweg/io/network/internal/read_network_notes.hpp>
#include <thalweg/io/network/internal/read_network_source.hpp>

namespace thalweg::io {

namespace {

using FileArc = NetworkFile::FileArc;

Wish wish_of(ReadNetworkParams const& params) {
    Wish wish{.schema = params.schema,
              .arcs_layer = params.arcs_layer,
              .nodes_layer = params.nodes_layer,
              .crs = params.crs,
              .source_crs = params.source_crs,
              .any_lines = params.any_lines,
              .bridge = params.bridge};
    for (auto const& [quantity, field] : params.fields) {
        if (quantity == "node_id") {
            wish.node_id = field;
            continue;
        }
        auto const known = quantity_of(quantity);
        if (!known) {
            std::vector<std::string> names{"node_id"};
            for (std::size_t q = 0; q < static_cast<std::size_t>(Quantity::constant); ++q) {
                names.emplace_back(name_of(static_cast<Quantity>(q)));
            }
            throw BadInput(fmt::format("io.read_network: '{}' is not a quantity of the network schema.{} ({})",
                                       quantity, did_you_mean(quantity, names), fmt::join(names, ", ")));
        }
        wish.fields[*known] = field;
    }
    return wish;
}

FilePlaces places_of(NetworkFile const& file) {
    FilePlaces places;
    for (FileArc const& arc : file.arcs) {
        for (Vec3 const& p : arc.line) {
            if (std::isfinite(p.x) && std::isfinite(p.y)) {
                places.add(p.x, p.y);
            }
        }
    }
    return places;
}

/// Brings heights into metres, from the unit that the layer of arcs says.
void convert_heights(NetworkFile& file, Layer const& arcs, Wish const& wish, Notes& notes) {
    double const unit = height_unit_of(*arcs.layer, wish.source_crs);
    if (unit == 1.0) {
        return;
    }
    for (FileArc& arc : file.arcs) {
        for (Vec3& p : arc.line) {
            p.z *= unit;
        }
        arc.columns.z_up_m *= unit;
        arc.columns.z_down_m *= unit;
    }
    for (NetworkFile::FileNode& node : file.nodes) {
        node.at.z *= unit;
        node.columns.z_m *= unit;
    }
    if (!wish.whole) {
        notes.add(arcs.what, {"heights_converted",
                              0,
                              {},
                              unit,
                              fmt::format("its heights, in {}, were converted into metres", words_for_unit(unit))});
    }
}

void bring_into_metres(NetworkFile& file, Layer const& arcs, Layer const* nodes, Wish const& wish, Notes& notes,
                       Run const& run) {
    OGRSpatialReference const own = crs_of_layer(arcs.layer->GetSpatialRef(), wish.source_crs);
    bool const has_none = own.IsEmpty() != 0;
    if (nodes != nullptr) {
        OGRSpatialReference const other = crs_of_layer(nodes->layer->GetSpatialRef(), wish.source_crs);
        if (!has_none && other.IsEmpty() == 0 && own.IsSame(&other) == FALSE && name_of(own) != name_of(other)) {
            throw BadInput(fmt::format("{} is in {} and {} in {}: reproject both to one CRS", arcs.what, own.GetName(),
                                       nodes->what, other.GetName()));
        }
    }
    if (has_none) {
        if (file.schema != "native") {
            notes.add(arcs.what, {"no_crs", 0, {}, 0.0, "no CRS: its coordinates are treated as metres"});
        }
        return;
    }
    FilePlaces const places = places_of(file);
    if (!places.any()) {
        file.crs = name_of(own);
        return;
    }
    // A network in the native schema has the CRS that its maker chose.
    OwnMetres const own_metres = file.schema == "native" ? OwnMetres::kept : OwnMetres::judged;
    IntoMetres const metres(own, wish.crs, places.box(), arcs.what, own_metres);
    file.crs = metres.crs();
    auto const move = [&](std::span<Vec3> points) {
        auto const done = metres.apply(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (done[i] == 0) {
                points[i].x = nan; // for the check to find
                points[i].y = nan;
            }
        }
    };
    if (!metres.moves()) {
        return;
    }
    for (FileArc& arc : file.arcs) {
        run.check();
        move(arc.line);
        for (double* const length : {&arc.columns.length_m, &arc.columns.length_3d_m, &arc.columns.straight_m,
                                     &arc.columns.dist_out_m, &arc.columns.slope}) {
            *length = nan; // of another projection
        }
    }
    for (NetworkFile::FileNode& node : file.nodes) {
        move({&node.at, 1});
        node.columns.dist_out_m = nan;
    }
    notes.add(arcs.what,
              {"reprojected",
               0,
               {},
               0.0,
               fmt::format("its coordinates were reprojected from {} to {}", own.GetName(), in_message(file.crs))});
}

void take_nodes(NetworkFile& file, std::optional<Layer> const& nodes, Layer const& arcs, std::string const& source_name,
                Wish const& wish, Driver const& driver, Notes& notes, Run const& run) {
    if (nodes) {
        read_nodes(file, *nodes, wish.node_id, driver, notes, run);
    } else if (file.schema == "native") {
        notes.add(source_name, {"missing_nodes", 0, {}, 0.0, "has no layer nodes"});
    }
    convert_heights(file, arcs, wish, notes);
    bring_into_metres(file, arcs, nodes ? &*nodes : nullptr, wish, notes, run);
}

NetworkFile read(std::string const& path, Wish const& wish, Run const& run) {
    Driver const driver;
    NetworkPlace const place = find_network(path, wish.whole);
    Notes notes(wish.whole);
    NetworkSource const arcs_source(place.arcs, driver);
    std::unique_ptr<NetworkSource> const own_nodes = place.nodes.empty() || place.nodes == place.arcs
                                                         ? nullptr
                                                         : std::make_unique<NetworkSource>(place.nodes, driver);
    NetworkSource const* const nodes_source = place.nodes.empty() ? nullptr
                                              : own_nodes         ? own_nodes.get()
                                                                  : &arcs_source;

    Layer const arcs = choose_arcs(arcs_source, wish);
    auto const schema = choose_schema(arcs, wish);
    auto const nodes = choose_nodes(nodes_source, arcs_source, arcs, schema, wish);
    NetworkFile file;
    read_arcs(file, arcs, schema, wish, driver, notes, run);
    if (OGRLayer* const sources = arcs_source.layer("sources"); sources != nullptr && schema == Schema::native) {
        read_sources(file, {sources, arcs_source.what() + ", layer sources"}, driver, run);
    }
    take_nodes(file, nodes, arcs, arcs_source.what(), wish, driver, notes, run);
    SchemaTable const& table = table_of(schema.value_or(Schema::native));
    if (schema != Schema::native) {
        if (file.says.downstream) {
            drop_links_out(file, arcs.what, notes);
            if (wish.bridge && !file.says.ends) {
                bridge_points(file, arcs.what, notes);
            }
        }
        turn_downstream(file, table.drawn_upstream, arcs.what, notes);
    }
    if (!file.says.ends) {
        name_ends(file);
        file.says.nodes = false;
    }
    if (!file.says.nodes) {
        place_nodes(file);
    }
    if (!file.says.downstream) {
        link_by_nodes(file);
    }
    file.findings = notes.take();
    place_findings(file);
    return file;
}

} // namespace

NetworkFile read_network(std::string const& path, ReadNetworkParams const& params, Run const& run) {
    return read(path, wish_of(params), run);
}

NetworkFile read_network(std::string const& path, Run const& run) {
    return read(path, {.schema = Schema::native, .whole = true}, run);
}

} // namespace thalweg::io
