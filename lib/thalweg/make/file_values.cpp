// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/file_values.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::make {
namespace {

template <class T> Raster<double> in_m2(Raster<T> const& cells) {
    Grid const& grid = cells.grid();
    double const cell_m2 = grid.cell_m * grid.cell_m;
    Raster<double> m2(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        m2[i] = cells[i] > 0 ? static_cast<double>(cells[i]) * cell_m2 : std::numeric_limits<double>::quiet_NaN();
    }
    return m2;
}

} // namespace

Raster<float> in_unit(Raster<float> const& dem, HeightUnit unit) {
    if (unit == HeightUnit::metre) {
        return dem;
    }
    std::vector<float> heights;
    heights.reserve(static_cast<std::size_t>(dem.cells()));
    std::ranges::copy_if(dem.values(), std::back_inserter(heights), [](float z) { return !std::isnan(z); });
    std::ranges::sort(heights);
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());

    std::vector<float> converted;
    converted.reserve(heights.size());
    for (float const z : heights) {
        auto const near = static_cast<float>(static_cast<double>(z) / metres_in(unit));
        float const above =
            converted.empty() ? near : std::nextafterf(converted.back(), std::numeric_limits<float>::infinity());
        converted.push_back(std::max(near, above));
    }
    Raster<float> out(dem.grid(), std::numeric_limits<float>::quiet_NaN());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (!std::isnan(dem[i])) {
            auto const at = std::ranges::lower_bound(heights, dem[i]) - heights.begin();
            out[i] = converted[static_cast<std::size_t>(at)];
        }
    }
    return out;
}

Tin in_unit(Tin tin, HeightUnit unit) {
    for (Vec3& p : tin.vertices) {
        p.z /= metres_in(unit);
    }
    return tin;
}

std::optional<io::UserData> user_data(MakeResult const& t, StreamNetwork const& plan) {
    if (!t.planform.file.sources.knows_any()) {
        return std::nullopt;
    }
    io::UserData user{t.planform.file.attributes, {}, t.planform.file.sources.of(plan)};
    for (Arc const& arc : plan.arcs()) {
        user.record.push_back(arc.feature);
    }
    return user;
}

std::vector<io::ShortenedName> shortened_names(MakeResult const& t) {
    auto const user = user_data(t, t.terrain.rivers.network.planform);
    if (!user) {
        return {};
    }
    io::NetworkTables tables{t.terrain.rivers.network,
                             t.terrain.rivers.orders,
                             t.terrain.water.areas.us_area_m2,
                             t.terrain.water.areas.ds_area_m2,
                             t.terrain.water.areas.node_m2,
                             t.terrain.grid.crs,
                             {}};
    tables.user = &*user;
    return io::shortened_names(tables);
}

void add_pieces(std::vector<network::SplitPiece> const& pieces, std::vector<double>& us_area_m2,
                std::vector<double>& ds_area_m2) {
    for (network::SplitPiece const& piece : pieces) {
        double const trunk = piece.upstream ? ds_area_m2[piece.of] : us_area_m2[piece.of];
        double const moved = ds_area_m2[piece.moved];
        double const area = piece.upstream ? trunk + moved : std::max(trunk - moved, 0.0);
        us_area_m2.push_back(trunk < 0.0 || moved < 0.0 ? -1.0 : area);
        ds_area_m2.push_back(us_area_m2.back());
    }
}

std::vector<double> node_areas(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                               std::vector<double> const& ds_area_m2) {
    std::vector<double> areas;
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out(n) != no_arc) {
            areas.push_back(us_area_m2[network.out(n)]);
            continue;
        }
        double sum = 0.0;
        for (ArcId const a : network.in(n)) {
            double const area = ds_area_m2[a];
            sum = sum < 0.0 || area < 0.0 ? -1.0 : sum + area;
        }
        areas.push_back(sum);
    }
    return areas;
}

std::vector<io::CatchmentRow> catchment_rows(std::vector<flow::Reach> const& reaches,
                                             std::vector<std::int64_t> const& basins,
                                             flow::Catchments const& catchments) {
    std::vector<io::CatchmentRow> rows;
    rows.reserve(reaches.size());
    for (std::size_t a = 0; a < reaches.size(); ++a) {
        std::int64_t const ds = reaches[a].ds;
        rows.push_back({reaches[a].id, ds < 0 ? 0 : reaches[static_cast<std::size_t>(ds)].id, basins[a],
                        catchments.cells[a], catchments.upstream[a]});
    }
    return rows;
}

Raster<double> areas_m2(flow::FlowField const& drainage) {
    return in_m2(drainage.area_cells);
}

Raster<double> areas_m2(Raster<double> const& area_cells) {
    return in_m2(area_cells);
}

} // namespace thalweg::make
