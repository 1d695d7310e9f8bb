// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/ridges.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/medial_lines.hpp>
#include <thalweg/geometry/voronoi.hpp>
#include <thalweg/skeleton/internal/chain_ridges.hpp>
#include <thalweg/skeleton/internal/ridge_pieces.hpp>

namespace thalweg::skeleton {
namespace {

void demand(RidgesParams const& params, Grid const& grid) {
    for (auto const& [name, value] : {std::pair{"gain", params.gain},
                                      {"farthest_m", params.farthest_m},
                                      {"spacing_m", params.spacing_m},
                                      {"tolerance_m", params.tolerance_m},
                                      {"clear_m", params.clear_m}}) {
        require_in("skeleton.ridges", name, value, Range::at_least(0.0));
    }
    if (grid.width < 1 || grid.height < 1 || !(grid.cell_m > 0.0)) {
        throw BadParameter(fmt::format("skeleton.ridges: a grid of {} x {} cells of {} m has no ground", grid.width,
                                       grid.height, grid.cell_m));
    }
}

void demand(ElevatedNetwork const& network, std::vector<std::int64_t> const& labels) {
    std::size_t const arcs = network.plan.arc_count();
    if (labels.size() != arcs || network.arc_z.size() != arcs) {
        throw BadInput(
            fmt::format("skeleton.ridges: {} labels and heights of {} arcs for a network of {}; give one for "
                        "each arc",
                        labels.size(), network.arc_z.size(), arcs));
    }
    for (std::size_t a = 0; a < arcs; ++a) {
        auto const& line = network.plan.arc(a).line;
        auto const& z = network.arc_z[a];
        auto const bad = std::ranges::find_if_not(z, [](double h) { return std::isfinite(h); });
        if (z.size() != line.size() || bad != z.end()) {
            throw BadInput(fmt::format("skeleton.ridges: arc {} from ({:.3f}, {:.3f}) has no height at every vertex; "
                                       "raise the network",
                                       a + 1, line.front().x, line.front().y));
        }
    }
}

/// The arcs in an order that begins downstream: of all labels at a confluence the first is that of the arc leaving it.
std::vector<std::size_t> downstream_first(StreamNetwork const& network) {
    std::vector<std::size_t> order;
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) != no_arc) {
            order.push_back(network.out(n));
        }
    }
    return order;
}

/// Puts vertices into a line so that none are farther apart than spacing_m.
void densify(std::vector<Vec2>& line, std::vector<double>& z, double spacing_m) {
    std::vector<Vec2> denser{line.front()};
    std::vector<double> heights{z.front()};
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec2 const p = line[i - 1];
        double const parts = std::ceil(distance(p, line[i]) / spacing_m);
        for (double k = 1.0; k < parts; k += 1.0) {
            double const share = k / parts;
            denser.push_back({p.x + share * (line[i].x - p.x), p.y + share * (line[i].y - p.y)});
            heights.push_back(z[i - 1] + share * (z[i] - z[i - 1]));
        }
        denser.push_back(line[i]);
        heights.push_back(z[i]);
    }
    line = std::move(denser);
    z = std::move(heights);
}

/// Leaves out pieces that meet a river, or another piece elsewhere than in both their ends.
std::vector<RidgePiece> without_meetings(std::vector<RidgePiece> pieces, LabelledRivers const& rivers, Run const& run) {
    std::vector<std::vector<Vec2>> drawn;
    for (auto const& river : rivers.lines) {
        drawn.push_back(river.line);
    }
    std::size_t const first = drawn.size();
    for (auto const& piece : pieces) {
        auto& line = drawn.emplace_back();
        for (Vec3 const& p : piece.ridge.line) {
            line.push_back({p.x, p.y});
        }
    }
    auto const found = geometry::crossings(drawn, run);
    std::set<std::pair<double, double>> on_rivers;
    for (auto const& c : found) {
        if (c.line < first) {
            on_rivers.emplace(c.at.x, c.at.y);
        }
    }
    std::vector<char> left_out(pieces.size(), 0);
    for (auto const& c : found) {
        if (c.line >= first) {
            auto const& line = drawn[c.line];
            bool const in_an_end = c.at == line.front() || c.at == line.back();
            if (!in_an_end || on_rivers.contains({c.at.x, c.at.y})) {
                left_out[c.line - first] = 1;
            }
        }
    }
    std::vector<RidgePiece> kept;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (left_out[i] == 0) {
            kept.push_back(std::move(pieces[i]));
        }
    }
    return kept;
}

double or_else(double asked, double chosen) {
    return asked > 0.0 ? asked : chosen;
}

} // namespace

RidgeLines ridges(ElevatedNetwork const& network, std::vector<std::int64_t> const& stream_of_arc, Grid const& grid,
                  RidgesParams const& params, Run const& run) {
    demand(params, grid);
    demand(network, stream_of_arc);
    LabelledRivers rivers;
    for (std::size_t const a : downstream_first(network.plan)) {
        rivers.lines.push_back({network.plan.arc(a).line, stream_of_arc[a]});
        rivers.z.push_back(network.arc_z[a]);
    }
    geometry::Bounds const bounds{grid.west, grid.south(), grid.east(), grid.north};
    Rise const rise{params.gain, or_else(params.farthest_m, std::numeric_limits<double>::infinity()),
                    or_else(params.clear_m, 0.5 * grid.cell_m)};
    std::vector<RidgePiece> pieces;
    if (params.method == RidgesParams::Method::segments) {
        double const tolerance = or_else(params.tolerance_m, 0.1 * grid.cell_m);
        pieces = ridge_pieces(geometry::medial_lines(rivers.lines, bounds, {tolerance}, run), rivers, rise);
    } else {
        LabelledRivers dense = rivers;
        for (std::size_t i = 0; i < dense.lines.size(); ++i) {
            densify(dense.lines[i].line, dense.z[i], or_else(params.spacing_m, grid.cell_m));
        }
        pieces = ridge_pieces(geometry::voronoi(dense.lines, bounds, run), dense, rise);
    }
    for (RidgePiece& piece : pieces) { // cut anew near rivers, a place on the edge may leave it by a rounding
        for (Vec3& p : piece.ridge.line) {
            p.x = std::clamp(p.x, bounds.west, bounds.east);
            p.y = std::clamp(p.y, bounds.south, bounds.north);
        }
    }
    return chain_ridges(without_meetings(std::move(pieces), rivers, run));
}

} // namespace thalweg::skeleton
