// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/internal/import_reaches.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

double median_of(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    std::ranges::sort(values);
    std::size_t const n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// Whether a cell around a place is no data, or none.
bool lies_at_no_data(Raster<float> const& dem, Vec2 at) {
    Cell const c = dem.grid().cell_of(at);
    for (std::int64_t row = c.row - 1; row <= c.row + 1; ++row) {
        for (std::int64_t col = c.col - 1; col <= c.col + 1; ++col) {
            if (!dem.grid().contains({col, row}) || std::isnan(dem[Cell{col, row}])) {
                return true;
            }
        }
    }
    return false;
}

/// Whether the file lets all that meets in a node end there.
bool is_said_outlet(Pieces const& p, PieceVotes const& certain, std::size_t n) {
    return !certain.empty() && std::ranges::all_of(p.at_node[n], [&](std::size_t k) {
        return certain[k] != 0 && (certain[k] > 0 ? p.pieces[k].to : p.pieces[k].from) == n;
    });
}

/// By node: whether it lies on a side of the file on which other lines end, as those of a clipped file do, or at the
/// border of the DEM, or is an outlet by the file.
std::vector<char> likely_outlets(Pieces const& p, std::vector<RiverLine> const& lines, PieceVotes const& certain,
                                 Raster<float> const* dem) {
    std::array<double, 4> far{}; // west, east, south, north, counted outward
    far.fill(-std::numeric_limits<double>::infinity());
    auto const outward = [](double x, double y) { return std::array<double, 4>{-x, x, -y, y}; };
    for (RiverLine const& line : lines) {
        for (Vec3 const& v : line.vertices) {
            auto const of = outward(v.x, v.y);
            for (std::size_t side = 0; side < far.size(); ++side) {
                far[side] = std::max(far[side], of[side]);
            }
        }
    }
    auto const lies_on = [&](std::size_t n, std::size_t side) {
        return far[side] - outward(p.nodes[n].x, p.nodes[n].y)[side] <= same_point_m;
    };
    std::array<bool, 4> ends{};
    for (std::size_t side = 0; side < ends.size(); ++side) {
        for (std::size_t n = 0; n < p.nodes.size(); ++n) {
            ends[side] = ends[side] || (p.at_node[n].size() == 1 && lies_on(n, side));
        }
    }
    std::vector<char> result;
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        bool lies = is_said_outlet(p, certain, n) || (dem != nullptr && lies_at_no_data(*dem, p.nodes[n]));
        for (std::size_t side = 0; side < ends.size(); ++side) {
            lies = lies || (ends[side] && lies_on(n, side));
        }
        result.push_back(lies ? 1 : 0);
    }
    return result;
}

class ReachMaker {
public:
    ReachMaker(Pieces const& p, std::vector<RiverLine> const& lines, std::vector<char> const& is_outlet)
        : p_(p), lines_(lines), used_(p.pieces.size(), 0), at_(p.nodes.size()) {
        for (std::size_t n = 0; n < p.nodes.size(); ++n) {
            at_[n] = p.at_node[n];
            std::erase_if(at_[n], [&](std::size_t k) { return is_ring(k); });
        }
        for (std::size_t n = 0; n < p.nodes.size(); ++n) {
            is_inner_.push_back(at_[n].size() == 2 && is_outlet[n] == 0 ? 1 : 0);
        }
    }

    std::vector<Reach> make() {
        for (std::size_t n = 0; n < at_.size(); ++n) {
            if (is_inner_[n] == 0) {
                start(n);
            }
        }
        for (std::size_t n = 0; n < at_.size(); ++n) { // rings of several pieces
            start(n);
        }
        return std::move(reaches_);
    }

private:
    bool is_ring(std::size_t k) const { return p_.pieces[k].from == p_.pieces[k].to; }

    void start(std::size_t n) {
        for (std::size_t const k : at_[n]) {
            if (used_[k] == 0) {
                walk(n, k);
            }
        }
    }

    void walk(std::size_t start, std::size_t k) {
        Reach reach;
        reach.from = start;
        std::size_t n = start;
        while (true) {
            used_[k] = 1;
            int const runs = p_.pieces[k].from == n ? 1 : -1;
            reach.steps.push_back({k, runs});
            n = runs > 0 ? p_.pieces[k].to : p_.pieces[k].from;
            if (is_inner_[n] == 0 || n == start) {
                break;
            }
            std::size_t const next = at_[n].front() == k ? at_[n].back() : at_[n].front();
            if (used_[next] != 0) {
                break;
            }
            k = next;
        }
        reach.to = n;
        if (before(p_.nodes[reach.to], p_.nodes[reach.from])) {
            std::swap(reach.from, reach.to);
            std::ranges::reverse(reach.steps);
            for (Reach::Step& step : reach.steps) {
                step.runs = -step.runs;
            }
        }
        draw(reach);
        reaches_.push_back(std::move(reach));
    }

    void draw(Reach& reach) const {
        reach.line = {p_.nodes[reach.from]};
        for (auto const& [k, runs] : reach.steps) {
            auto const& piece = p_.pieces[k];
            auto const& v = lines_[piece.line].vertices;
            for (std::size_t i = 1; i <= piece.last - piece.first; ++i) {
                reach.line.push_back(plan(v[runs > 0 ? piece.first + i : piece.last - i]));
            }
        }
        for (std::size_t i = 1; i < reach.line.size(); ++i) {
            reach.length_m += distance(reach.line[i - 1], reach.line[i]);
        }
    }

    Pieces const& p_;
    std::vector<RiverLine> const& lines_;
    std::vector<char> used_;
    std::vector<std::vector<std::size_t>> at_; ///< by node: pieces that are no rings
    std::vector<char> is_inner_;               ///< by node: reaches go on through it
    std::vector<Reach> reaches_;
};

void find_groups(Pieces const& p, ReachGraph& graph) {
    std::vector<char> seen(p.nodes.size(), 0);
    auto const by_position = [&](std::size_t a, std::size_t b) { return before(p.nodes[a], p.nodes[b]); };
    for (std::size_t start = 0; start < p.nodes.size(); ++start) {
        if (seen[start] != 0 || graph.at[start].empty()) {
            continue;
        }
        ReachGroup group;
        group.nodes = {start};
        seen[start] = 1;
        for (std::size_t i = 0; i < group.nodes.size(); ++i) {
            for (Way const& way : graph.at[group.nodes[i]]) {
                if (way.sign > 0) {
                    group.reaches.push_back(way.reach);
                }
                if (seen[way.to] == 0) {
                    seen[way.to] = 1;
                    group.nodes.push_back(way.to);
                }
            }
        }
        std::ranges::sort(group.nodes, by_position);
        std::ranges::sort(group.reaches, {}, [&](std::size_t k) {
            Reach const& r = graph.reaches[k];
            return std::tuple(r.line.front().x, r.line.front().y, r.line[1].x, r.line[1].y);
        });
        for (std::size_t const k : group.reaches) {
            group.length_m += graph.reaches[k].length_m;
        }
        graph.groups.push_back(std::move(group));
    }
    std::ranges::sort(graph.groups, [&](ReachGroup const& a, ReachGroup const& b) {
        return by_position(a.nodes.front(), b.nodes.front());
    });
}

// Depth first; a reach is a bridge where nothing above it is reached from below (Tarjan 1974).
void find_bridges(ReachGraph& graph) {
    graph.is_bridge.assign(graph.reaches.size(), 0);
    std::vector<std::size_t> number(graph.at.size(), 0); // from 1
    std::vector<std::size_t> low(graph.at.size(), 0);
    std::size_t count = 0;
    struct Visit {
        std::size_t node;
        std::size_t by;
        std::size_t next = 0;
    };
    for (ReachGroup const& group : graph.groups) {
        std::vector<Visit> stack{{group.nodes.front(), graph.reaches.size()}};
        number[stack.back().node] = low[stack.back().node] = ++count;
        while (!stack.empty()) {
            Visit& top = stack.back();
            std::size_t const n = top.node;
            if (top.next < graph.at[n].size()) {
                Way const way = graph.at[n][top.next++];
                if (way.reach == top.by) {
                    continue;
                }
                if (number[way.to] != 0) {
                    low[n] = std::min(low[n], number[way.to]);
                } else {
                    number[way.to] = low[way.to] = ++count;
                    stack.push_back({way.to, way.reach});
                }
                continue;
            }
            Visit const done = top;
            stack.pop_back();
            if (!stack.empty()) {
                std::size_t const up = stack.back().node;
                low[up] = std::min(low[up], low[n]);
                graph.is_bridge[done.by] = low[n] > number[up] ? 1 : 0;
            }
        }
    }
}

void find_blocks(ReachGraph& graph) {
    graph.block.assign(graph.at.size(), RootScores::none);
    for (ReachGroup const& group : graph.groups) {
        for (std::size_t const start : group.nodes) {
            if (graph.block[start] != RootScores::none) {
                continue;
            }
            std::size_t const b = graph.block_nodes.size();
            auto& nodes = graph.block_nodes.emplace_back();
            nodes.push_back(start);
            graph.block[start] = b;
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                for (Way const& way : graph.at[nodes[i]]) {
                    if (graph.is_bridge[way.reach] == 0 && graph.block[way.to] == RootScores::none) {
                        graph.block[way.to] = b;
                        nodes.push_back(way.to);
                    }
                }
            }
        }
    }
}

} // namespace

ReachGraph reaches_of(Pieces const& p, std::vector<RiverLine> const& lines, PieceVotes const& certain,
                      Raster<float> const* dem) {
    ReachGraph graph;
    graph.is_outlet = likely_outlets(p, lines, certain, dem);
    graph.reaches = ReachMaker(p, lines, graph.is_outlet).make();
    graph.at.resize(p.nodes.size());
    std::vector<double> lengths;
    std::vector<double> segments;
    for (std::size_t k = 0; k < graph.reaches.size(); ++k) {
        Reach const& r = graph.reaches[k];
        lengths.push_back(r.length_m);
        for (std::size_t i = 1; i < r.line.size(); ++i) {
            segments.push_back(distance(r.line[i - 1], r.line[i]));
        }
        if (r.from != r.to) {
            graph.at[r.from].push_back({k, r.to, 1});
            graph.at[r.to].push_back({k, r.from, -1});
        }
    }
    for (auto& ways : graph.at) {
        std::ranges::sort(ways, {}, [&](Way const& way) {
            auto const& line = graph.reaches[way.reach].line;
            Vec2 const next = way.sign > 0 ? line[1] : line[line.size() - 2];
            return std::tuple(next.x, next.y, graph.reaches[way.reach].length_m);
        });
    }
    graph.median_m = median_of(std::move(lengths));
    graph.segment_m = median_of(std::move(segments));
    find_groups(p, graph);
    find_bridges(graph);
    find_blocks(graph);
    return graph;
}

Vec2 point_along(std::vector<Vec2> const& line, double along_m) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        double const m = distance(line[i - 1], line[i]);
        if (along_m < m) {
            return line[i - 1] + (along_m / m) * (line[i] - line[i - 1]);
        }
        along_m -= m;
    }
    return line.back();
}

} // namespace thalweg::network::import_steps
