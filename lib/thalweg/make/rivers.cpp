// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/rivers.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/make/internal/lakes.hpp>
#include <thalweg/make/internal/raise_rivers.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/make/valley_cells.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::make {
namespace {

struct RiversWithHeights {
    ElevatedNetwork network;
    network::HeightReport repair = {};                 ///< under modes that set heights
    std::optional<flow::ContributingAreas> areas = {}; ///< as RaisedRivers
};

RiversWithHeights elevated(recipe::Recipe const& recipe, Planform const& planform, Run const& run) {
    recipe::NetworkRecipe const& wanted = *recipe.network;
    if (planform.file_heights) {
        return {*planform.file_heights};
    }
    if (wanted.heights == recipe::Heights::rosgen) {
        return {
            network::set_heights_by_type(planform.network, planform.types, {wanted.rosgen_slope, recipe.seed}, run)};
    }
    if (wanted.heights == recipe::Heights::graded) {
        flow::ContributingAreas areas = flow::areas_nearest(planform.network, planform.grid, run);
        double const cell = planform.grid.cell_m * planform.grid.cell_m;
        network::GradedNetwork graded = network::set_heights_graded(
            planform.network, areas.us_area_m2, areas.ds_area_m2, {wanted.slope, wanted.concavity, cell}, run);
        return {std::move(graded.network), {}, std::move(areas)};
    }
    network::HeightMode const mode = wanted.heights == recipe::Heights::straight ? network::HeightMode::straight
                                     : wanted.heights == recipe::Heights::along_stream
                                         ? network::HeightMode::along_stream
                                         : network::HeightMode::straight_repaired;
    network::NetworkWithHeights set = network::set_heights(planform.network, {mode, wanted.slope}, run);
    return {std::move(set.network), set.report};
}

constexpr float no_limit = std::numeric_limits<float>::infinity();

/// The height of a DEM in a cell of a river.
float height_below_river(Raster<float> const& dem, CellIndex cell, std::string const& source) {
    if (std::isnan(dem[cell])) {
        Vec2 const at = dem.grid().centre(dem.grid().at(cell));
        throw BadInput(
            "make.make_terrain",
            fmt::format("surface.source = \"{}\" has no height at ({:.1f}, {:.1f}), where a river runs: "
                        "set grid.clip = true, which cuts rivers where the DEM has no data, or fill the hole "
                        "(gdal_fillnodata.py)",
                        source, at.x, at.y));
    }
    return dem[cell];
}

/// The heights of a DEM in the cells of rivers, cut until each cell lies below those upstream. A lake is as high as its
/// outlet; where that has a level, rivers that enter the lake below it are raised.
Valley bed_of(Channels const& channels, Raster<float> const& dem, std::string const& source) {
    std::vector<float> z(channels.cell.size());
    std::vector<float> most(channels.cell.size(), no_limit);
    auto const is_level = [&](std::size_t i) { return !channels.level.empty() && channels.level[i] != 0; };
    for (std::size_t i = channels.cell.size(); i-- > 0;) { // donors before their receivers
        if (is_level(i)) {
            z[i] = most[i]; // its own heights may be those of its floor
        } else if (!channels.lake_z.empty() && !std::isnan(channels.lake_z[i])) {
            z[i] = channels.lake_z[i];
        } else {
            z[i] = std::min(height_below_river(dem, channels.cell[i], source), most[i]);
        }
        if (channels.receiver[i] >= 0) {
            float& below = most[channels.receiver[i]];
            below = std::min(below, is_level(i) ? z[i] : std::nextafterf(z[i], -no_limit));
        }
    }
    Valley valley{Raster<float>(dem.grid(), std::numeric_limits<float>::quiet_NaN())};
    for (std::size_t i = 0; i < channels.cell.size(); ++i) {
        if (ChannelId const to = channels.receiver[i]; to >= 0) {
            z[i] = is_level(i) ? z[to] : std::max(z[i], std::nextafterf(z[to], no_limit));
        }
        valley.z[channels.cell[i]] = z[i];
    }
    return valley;
}

/// A valley in which each sink lies below what is around it.
Valley with_sinks_lowest(Valley valley, std::vector<CellIndex> const& sinks, Raster<float> const& dem) {
    Grid const& grid = dem.grid();
    for (CellIndex const sink : sinks) {
        for (Cell const step : d8_steps) {
            Cell const c{grid.at(sink).col + step.col, grid.at(sink).row + step.row};
            float const beside = !grid.contains(c) ? no_limit : std::isnan(valley.z[c]) ? dem[c] : valley.z[c];
            if (!(beside > valley.z[sink])) {
                valley.z[sink] = std::nextafterf(beside, -no_limit);
            }
        }
    }
    return valley;
}

/// A warning of the cell in which rivers lie farthest below the DEM or, beside a lake with a level, above it.
std::vector<Finding> far_from_dem(FindingKind kind, recipe::SurfaceRecipe const& wanted, Vec2 at, double by_m) {
    if (!(by_m > wanted.max_cut_m)) {
        return {};
    }
    bool const is_cut = kind == FindingKind("deep_cut");
    return {{.kind = kind,
             .where = at,
             .amount = by_m,
             .text = fmt::format("rivers are {} {} by up to {:.1f} m, at ({:.0f}, {:.0f})",
                                 is_cut ? "cut into" : "dammed by lakes above", wanted.source, by_m, at.x, at.y),
             .key = is_cut ? "surface.max_cut" : "surface.lakes"}};
}

/// Rivers in the cells of the DEM that is the terrain.
RaisedRivers laid_on_raster(recipe::Recipe const& recipe, Raster<float> const& dem, Planform const& planform,
                            Run const& run) {
    WithLakes drawn = with_lakes(recipe, planform, network::channels(planform.network, planform.grid, {}, run), run);
    Channels& channels = drawn.rivers.channels;
    RaisedRivers laid;
    Valley valley = bed_of(channels, dem, recipe.surface->source);
    if (recipe.network->inland == recipe::InlandEnds::sink) {
        std::vector<NodeId> const sinks = inland_ends(planform.network, dem);
        valley = with_sinks_lowest(std::move(valley), cells_of(sinks, planform.network, planform.grid), dem);
    }
    Raster<float> cut = dem;
    CellIndex deepest = 0;
    CellIndex most_raised = 0;
    double raised_m = 0.0;
    for (std::size_t i = 0; i < channels.cell.size(); ++i) {
        CellIndex const cell = channels.cell[i];
        double const by_m = static_cast<double>(cut[cell]) - static_cast<double>(valley.z[cell]);
        laid.statistics.lowered_cells += by_m > 0.0 ? 1 : 0;
        deepest = by_m > laid.statistics.max_lowered_m ? cell : deepest;
        laid.statistics.max_lowered_m = std::max(laid.statistics.max_lowered_m, by_m);
        bool const is_floor = !channels.level.empty() && channels.level[i] != 0;
        most_raised = !is_floor && -by_m > raised_m ? cell : most_raised;
        raised_m = is_floor ? raised_m : std::max(raised_m, -by_m);
        cut[cell] = valley.z[cell];
    }
    laid.network = network::elevate_from_dem(planform.network, channels, cut);
    laid.valley = valley_cells(valley);
    auto const centre_of = [&](CellIndex cell) { return dem.grid().centre(dem.grid().at(cell)); };
    laid.findings = std::move(drawn.rivers.notes);
    append(laid.findings, drawn.notes);
    append(laid.findings, far_from_dem("deep_cut", *recipe.surface, centre_of(deepest), laid.statistics.max_lowered_m));
    append(laid.findings, far_from_dem("high_lake", *recipe.surface, centre_of(most_raised), raised_m));
    if (!drawn.lakes.empty()) {
        laid.lakes = std::ssize(drawn.lakes);
        laid.channels = std::move(channels);
    }
    return laid;
}

} // namespace

NetworkOrders order_rivers(StreamNetwork const& network, RiverClues const& clues) {
    network::StemClues of_arcs;
    for (Arc const& arc : network.arcs()) {
        auto const feature = static_cast<std::size_t>(arc.feature);
        of_arcs.arcs.push_back(feature < clues.size() ? clues[feature] : network::StemClues::OfArc{});
    }
    return network::order(network, network::main_inflows(network, of_arcs));
}

Rivers rivers_of(ElevatedNetwork network, network::RiverTypes types, RiverClues clues) {
    NetworkOrders orders = order_rivers(network.planform, clues);
    network::StreamCounts streams = network::count_streams(network.planform);
    return {std::move(network), std::move(types), std::move(orders), std::move(streams), std::move(clues)};
}

RaisedRivers raise_rivers(recipe::Recipe const& recipe, Raster<float> const& dem, Planform const& planform,
                          StageLog& stage_log, Run const& run) {
    if (recipe::on_raster(recipe) && recipe.network->heights == recipe::Heights::automatic) {
        RaisedRivers laid =
            stage_log.stage(recipe::stage::raise.name, [&] { return laid_on_raster(recipe, dem, planform, run); });
        stage_log.say(fmt::format("{} cells of rivers cut, by up to {:.3g} m", laid.statistics.lowered_cells,
                                  laid.statistics.max_lowered_m));
        return laid;
    }
    RiversWithHeights raised =
        stage_log.stage(recipe::stage::raise.name, [&] { return elevated(recipe, planform, run); });
    network::RasterisedRivers cells = network::rasterise(raised.network, planform.grid);
    return {std::move(raised.network), valley_cells(cells.valley),
            HeightsStatistics{raised.repair, cells.lowered_cells, cells.max_lowered_m}, std::move(raised.areas)};
}

} // namespace thalweg::make
