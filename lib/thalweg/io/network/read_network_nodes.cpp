// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network_arcs.hpp>

#include <cstddef>
#include <map>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/internal/feature_numbers.hpp>
#include <thalweg/io/network/internal/read_network_columns.hpp>

namespace thalweg::io {

namespace {

/// The columns of a node that follow from the rest.
class NodeReader {
public:
    explicit NodeReader(OGRLayer& layer)
        : kind_(layer, "kind"), deg_in_(layer, "deg_in"), deg_out_(layer, "deg_out"), basin_(layer, "basin_id"),
          strahler_(layer, "strahler"), z_(layer, "z"), dist_out_(layer, "dist_out"), area_(layer, "area") {}

    NetworkFile::NodeColumns read(OGRFeature const& feature) const {
        return {.kind = kind_.is_there() ? kind_.text(feature) : "",
                .deg_in = told(deg_in_, feature),
                .deg_out = told(deg_out_, feature),
                .basin_id = told(basin_, feature),
                .strahler = told(strahler_, feature),
                .z_m = told(z_, feature),
                .dist_out_m = told(dist_out_, feature),
                .area_m2 = told(area_, feature)};
    }

private:
    static double told(FileColumn const& column, OGRFeature const& feature) {
        return column.is_there() ? column.real(feature) : nan;
    }
    FileColumn kind_;
    FileColumn deg_in_;
    FileColumn deg_out_;
    FileColumn basin_;
    FileColumn strahler_;
    FileColumn z_;
    FileColumn dist_out_;
    FileColumn area_;
};

} // namespace

void read_sources(NetworkFile& file, Layer const& sources, Driver const& driver, Run const& run) {
    OGRFeatureDefn& schema = *sources.layer->GetLayerDefn();
    int const arc_id = schema.GetFieldIndex("arc_id");
    int const feature_id = schema.GetFieldIndex("feature");
    int const from = schema.GetFieldIndex("from_m");
    int const to = schema.GetFieldIndex("to_m");
    if (arc_id < 0 || feature_id < 0 || from < 0 || to < 0) {
        return;
    }
    std::map<std::int64_t, std::size_t> arc_of;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        arc_of.try_emplace(file.arcs[a].id, a);
    }
    sources.each(driver, run, [&](OGRFeature const& row) {
        auto const arc = arc_of.find(row.GetFieldAsInteger64(arc_id));
        Stretch const stretch{row.GetFieldAsInteger64(feature_id), row.GetFieldAsDouble(from),
                              row.GetFieldAsDouble(to)};
        if (arc != arc_of.end() && stretch.from_m >= 0.0 && stretch.to_m > stretch.from_m) {
            file.arcs[arc->second].sources.push_back(stretch);
        }
    });
}

void read_nodes(NetworkFile& file, Layer const& nodes, std::string const& node_id, Driver const& driver, Notes& notes,
                Run const& run) {
    FileColumn const id(*nodes.layer, node_id);
    if (!id.is_there()) {
        throw BadInput(fmt::format("{}: no field {} (there are {})", nodes.what, node_id, fields_of(*nodes.layer)));
    }
    id.require_numbers(*nodes.layer, nodes.what, notes);
    NodeReader const columns(*nodes.layer);
    std::int64_t number = 0;
    nodes.each(driver, run, [&](OGRFeature const& feature) {
        ++number;
        auto const* const shape = feature.GetGeometryRef();
        if (shape == nullptr || wkbFlatten(shape->getGeometryType()) != wkbPoint || shape->IsEmpty()) {
            throw BadInput(fmt::format("{}: feature {} is not a point", nodes.what, number));
        }
        OGRPoint const& p = *shape->toPoint();
        if (p.Is3D() == FALSE && file.says.heights) {
            notes.add(nodes.what, {"no_heights", 0, {}, 1.0, fmt::format("feature {} has no heights (Z)", number)});
        }
        file.nodes.push_back({FeatureNumbers(feature, number, nodes.what, notes).whole(id, 0, false),
                              {p.getX(), p.getY(), p.Is3D() == FALSE ? nan : p.getZ()},
                              columns.read(feature)});
    });
    file.says.nodes = true;
}

} // namespace thalweg::io
