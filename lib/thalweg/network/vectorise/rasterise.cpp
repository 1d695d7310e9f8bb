// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/rasterise.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::network {
namespace {

/// Indices of a cell of a reach and of the next one.
using Step = std::pair<std::int64_t, std::int64_t>;

/// Lowers every cell to the lowest cell upstream: in ascending order of height, no cell is lowered twice.
void lower_downstream(std::vector<Step> steps, RasterisedRivers& out) {
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    Raster<float>& z = out.valley.z;

    // Nothing to do unless some step rises.
    std::vector<std::int64_t> begin;
    for (Step const& s : steps) {
        if (z[s.second] > z[s.first]) {
            begin.push_back(s.first);
        }
    }
    std::sort(begin.begin(), begin.end(),
              [&z](std::int64_t a, std::int64_t b) { return z[a] != z[b] ? z[a] < z[b] : a < b; });
    std::vector<std::int64_t> open;
    for (std::int64_t const cell : begin) {
        open.push_back(cell);
        while (!open.empty()) {
            std::int64_t const u = open.back();
            open.pop_back();
            auto s = std::lower_bound(steps.begin(), steps.end(), Step{u, std::numeric_limits<std::int64_t>::min()});
            for (; s != steps.end() && s->first == u; ++s) {
                if (z[s->second] > z[u]) {
                    ++out.lowered_cells;
                    out.max_lowered_m =
                        std::max(out.max_lowered_m, static_cast<double>(z[s->second]) - static_cast<double>(z[u]));
                    z[s->second] = z[u];
                    open.push_back(s->second);
                }
            }
        }
    }
}

} // namespace

RasterisedRivers rasterise(ElevatedNetwork const& network, Grid const& grid) {
    refuse_if<BadInput>(network.arc_z.size() != network.planform.arc_count(), "network.rasterise",
                        "{} arcs with heights for {}; set the heights again", network.planform.arc_count(),
                        network.arc_z.size());
    RasterisedRivers out;
    out.valley.z = Raster<float>(grid, std::numeric_limits<float>::quiet_NaN());
    Raster<float>& z = out.valley.z;
    std::vector<Step> steps;
    for (std::size_t a = 0; a < network.planform.arc_count(); ++a) {
        std::vector<Cell> const at =
            cells_of_vertices(network.planform.arc(a).line, grid, fmt::format("arc {}", a + 1));
        std::vector<double> const& height = network.arc_z[a];
        refuse_if<BadInput>(height.size() != at.size(), "network.rasterise",
                            "arc {} has {} vertices and {} heights; set the heights again", a + 1, at.size(),
                            height.size());
        std::int64_t before = grid.index(at.front());
        for (std::size_t i = 1; i < at.size(); ++i) {
            double const from = height[i - 1];
            double const to = height[i];
            if (!std::isfinite(from) || !std::isfinite(to)) {
                Vec2 const p = network.planform.arc(a).line[std::isfinite(from) ? i : i - 1];
                throw BadInput("network.rasterise", fmt::format("the height of arc {} at ({:.3f}, {:.3f}) is not a "
                                                                "number; set it in the file or let it be computed",
                                                                a + 1, p.x, p.y));
            }
            double const lowest = std::min(from, to);
            walk_cells(at[i - 1], at[i], [&](Cell c, std::int64_t k, std::int64_t n) {
                double const t = n == 0 ? 0.0 : static_cast<double>(k) / static_cast<double>(n);
                double const here = n == 0   ? lowest
                                    : k == n ? to
                                             : std::clamp(from + (to - from) * t, lowest, std::max(from, to));
                std::int64_t const cell = grid.index(c);
                auto const rounded = static_cast<float>(here);
                if (std::isnan(z[cell]) || rounded < z[cell]) {
                    z[cell] = rounded;
                }
                if (cell != before) {
                    steps.emplace_back(before, cell);
                    before = cell;
                }
            });
        }
    }
    lower_downstream(std::move(steps), out);
    return out;
}

std::vector<float> channel_heights(ElevatedNetwork const& network, Channels const& channels) {
    Raster<float> const drawn = rasterise(network, channels.grid).valley.z;
    std::vector<float> z;
    z.reserve(channels.cell.size());
    for (std::int64_t const cell : channels.cell) {
        z.push_back(drawn[cell]);
    }
    for (std::size_t i = z.size(); i-- > 0;) { // donors before their receivers
        if (channels.receiver[i] >= 0) {
            float& below = z[channels.receiver[i]];
            below = z[i] < below ? z[i] : below;
        }
    }
    return z;
}

} // namespace thalweg::network
