// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/extract_streams.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>

namespace thalweg::flow {
namespace {

/// The cells of rivers in which nodes lie, ascending.
std::vector<std::int64_t> node_cells(FlowField const& drainage, std::int64_t support, Run const& run) {
    Raster<CellCount> const& area = drainage.area_cells;
    Raster<std::int8_t> arriving(area.grid());
    for (std::int64_t i = 0; i < area.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (std::int64_t const next = area[i] >= support ? drainage.receiver(i) : -1; next >= 0) {
            ++arriving[next];
        }
    }
    std::vector<std::int64_t> nodes;
    for (std::int64_t i = 0; i < area.cells(); ++i) {
        bool const leaves = area[i] >= support && drainage.receiver(i) < 0;
        if (area[i] >= support && (leaves ? arriving[i] > 0 : arriving[i] != 1)) {
            nodes.push_back(i);
        }
    }
    return nodes;
}

/// Numbers of straight and diagonal steps.
struct Steps {
    std::int64_t straight = 0;
    std::int64_t diagonal = 0;

    void add(Direction way) { ++(is_diagonal(way) ? diagonal : straight); }
    void add(Steps const& more) {
        straight += more.straight;
        diagonal += more.diagonal;
    }
    /// \return length [cells]
    double cells() const { return static_cast<double>(straight) + static_cast<double>(diagonal) * std::sqrt(2.0); }
};

/// Finds the greatest key such that the steps from cells with this key or more are long enough.
/// \param key_of called with the area of a cell; cells with `keys` or more are left out
/// \param enough [cells]
/// \param larger steps from cells with areas beyond those with keys; gets those with greater keys
/// \return `keys`: all steps are too short
template <class Key>
std::size_t narrow(FlowField const& drainage, Key key_of, std::size_t keys, double enough, Steps& larger,
                   Run const& run) {
    std::vector<Steps> by_key(keys);
    for (std::int64_t i = 0; i < drainage.area_cells.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (!goes_on(drainage.direction[i])) {
            continue;
        }
        if (std::size_t const key = key_of(drainage.area_cells[i]); key < keys) {
            by_key[key].add(drainage.direction[i]);
        }
    }
    for (std::size_t key = keys; key-- > 0;) {
        Steps with = larger;
        with.add(by_key[key]);
        if (with.cells() >= enough) {
            return key;
        }
        larger = with;
    }
    return keys;
}

/// Adds the cells that drain into outlets outside any arc to the first arc that ends there, as areas_d8 does.
void add_outlet_areas(StreamNetwork const& plan, ContributingAreas& areas) {
    for (NodeId const outlet : plan.outlets()) {
        double const brought = std::accumulate(plan.in(outlet).begin(), plan.in(outlet).end(), 0.0,
                                               [&](double sum, ArcId a) { return sum + areas.ds_area_m2[a]; });
        areas.ds_area_m2[plan.in(outlet).front()] += areas.node_m2[outlet] - brought;
    }
}

} // namespace

std::int64_t support_for_area(FlowField const& drainage, double area_km2) {
    require_in("flow.support_for_area", "area_km2", area_km2, Range::above(0.0), "km2");
    double const cell_km2 = drainage.grid().cell_m * drainage.grid().cell_m * 1e-6;
    double const cells = std::ceil(area_km2 / cell_km2 * (1.0 - 1e-12)); // 1 km2 of cells of 10 m is 10000, not 10001
    return std::max<std::int64_t>(static_cast<std::int64_t>(std::min(cells, 0x1p62)), 1);
}

ExtractedStreams extract_streams(FlowField const& drainage, Raster<float> const& dem,
                                 ExtractStreamsParams const& params, Run const& run) {
    Grid const& grid = drainage.area_cells.grid();
    if (params.support_km2) {
        require_in("flow.extract_streams", "support_km2", *params.support_km2, Range::above(0.0), "km2");
    }
    std::int64_t const support =
        params.support_km2 ? support_for_area(drainage, *params.support_km2) : params.support_cells;
    refuse_if<BadParameter>(params.support_cells < 1, "flow.extract_streams",
                            "the support is {} cells; it must be at least 1", params.support_cells);
    require_same_grid(dem.grid(), grid, "flow.extract_streams", "the DEM and its drainage", "drain this DEM");
    ExtractedStreams streams;
    NetworkDraft plan;
    streams.areas.source = "d8";
    streams.crs = grid.crs;
    double const cell_m2 = grid.cell_m * grid.cell_m;
    auto const area_m2 = [&](std::int64_t cell) { return static_cast<double>(drainage.area_cells[cell]) * cell_m2; };

    auto const cells = node_cells(drainage, support, run);
    for (std::int64_t const cell : cells) {
        plan.add_node(grid.centre(grid.at(cell)));
        streams.network.node_z.push_back(dem[cell]);
        streams.areas.node_m2.push_back(area_m2(cell));
    }
    for (std::size_t from = 0; from < cells.size(); ++from) {
        run.check();
        std::int64_t at = drainage.receiver(cells[from]);
        if (at < 0) {
            continue;
        }
        Arc arc;
        arc.line.push_back(plan.nodes[from].at);
        std::vector<double> z{dem[cells[from]]};
        std::int64_t last = cells[from];
        auto to = cells.end();
        for (;; last = at, at = drainage.receiver(at)) {
            arc.line.push_back(grid.centre(grid.at(at)));
            z.push_back(dem[at]);
            to = std::lower_bound(cells.begin(), cells.end(), at);
            if (to != cells.end() && *to == at) {
                break;
            }
        }
        plan.add_arc(from, static_cast<NodeId>(to - cells.begin()), std::move(arc));
        streams.network.arc_z.push_back(std::move(z));
        streams.areas.us_area_m2.push_back(area_m2(cells[from]));
        streams.areas.ds_area_m2.push_back(area_m2(last));
    }
    streams.network.planform = std::move(plan);
    add_outlet_areas(streams.network.planform, streams.areas);
    return streams;
}

std::int64_t support_for_length(FlowField const& drainage, double length_m, Run const& run) {
    refuse_if<BadParameter>(!(length_m > 0.0) || std::isinf(length_m), "flow.support_for_length",
                            "the length is {} m; it must be above 0", length_m);
    double const enough = length_m / drainage.grid().cell_m;
    Steps larger;
    constexpr std::size_t none = 32;
    std::size_t const octave = narrow(
        drainage, [](CellCount area) { return static_cast<std::size_t>(std::bit_width(area)) - 1; }, none, enough,
        larger, run);
    if (octave == none) {
        return 1;
    }
    // Within the octave, by the upper half of its bits, then by the lower.
    std::size_t const low_bits = octave / 2;
    std::size_t const high_bits = octave - low_bits;
    std::size_t const first = std::size_t{1} << high_bits;
    std::size_t const high =
        first + narrow(
                    drainage, [&](CellCount area) { return (std::size_t{area} >> low_bits) - first; }, first, enough,
                    larger, run);
    std::size_t const low = narrow(
        drainage, [&](CellCount area) { return std::size_t{area} - (high << low_bits); }, std::size_t{1} << low_bits,
        enough, larger, run);
    return static_cast<std::int64_t>((high << low_bits) + low);
}

} // namespace thalweg::flow
