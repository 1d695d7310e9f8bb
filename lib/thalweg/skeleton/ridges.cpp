// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/ridges.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/diagram.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace thalweg::skeleton {
namespace {

// A stretch of a ridge between two nodes.
struct RidgePiece {
    std::size_t from = 0; // node
    std::size_t to = 0;   // node
    RidgeLine ridge;
};

// Rivers as input of a diagram, with heights.
struct LabelledRivers {
    std::vector<geometry::LabelledLine> lines;
    std::vector<std::vector<double>> z; // [m] by line, one a vertex
};

struct Rise {
    double gain = 0.0;
    double farthest_m = 0.0; // infinity: no limit
    double clear_m = 0.0;
};

using geometry::Diagram;

/// The part of pq closer than clear_m to both sites of its edge, as shares of pq.
std::optional<std::pair<double, double>> too_near(Diagram::Site const& left, Diagram::Site const& right, Vec2 p, Vec2 q,
                                                  double clear_m) {
    if (left.a == left.b || right.a == right.b) {
        Vec2 const centre = left.a == left.b ? left.a : right.a;
        Vec2 const from = p - centre;
        Vec2 const step = q - p;
        double const square = dot(step, step);
        double const half = dot(from, step);
        double const root = half * half - square * (dot(from, from) - clear_m * clear_m);
        if (!(root > 0.0)) {
            return std::nullopt;
        }
        double const start = std::max(0.0, (-half - std::sqrt(root)) / square);
        double const end = std::min(1.0, (-half + std::sqrt(root)) / square);
        return start < end ? std::optional(std::pair(start, end)) : std::nullopt;
    }
    // Midway between two straight segments the distance changes linearly.
    double const here = distance_to(left, p);
    double const there = distance_to(left, q);
    if (here >= clear_m && there >= clear_m) {
        return std::nullopt;
    }
    double const share = here == there ? 0.0 : (clear_m - here) / (there - here);
    return std::pair(here < clear_m ? 0.0 : share, there < clear_m ? 1.0 : share);
}

class Cutter {
public:
    Cutter(Diagram const& diagram, LabelledRivers const& rivers, Rise const& rise)
        : diagram_(diagram), rivers_(rivers), rise_(rise), nodes_(diagram.vertices.size()) {}

    void add(Diagram::Edge const& edge) {
        auto const& left = diagram_.sites[edge.left];
        auto const& right = diagram_.sites[edge.right];
        std::array<std::size_t, 2> const both{edge.left, edge.right};
        std::optional<RidgePiece> piece;
        auto const begin = [&](std::size_t node, Vec3 at) {
            piece = RidgePiece{node, 0, {{at}, rivers_.lines[left.line].label, rivers_.lines[right.line].label}};
        };
        auto const end = [&](std::size_t node) {
            piece->to = node;
            if (piece->ridge.line.size() > 1) {
                pieces_.push_back(*piece);
            }
            piece.reset();
        };
        auto const go = [&](Vec3 at) {
            if (Vec3 const last = piece->ridge.line.back(); last.x != at.x || last.y != at.y) {
                piece->ridge.line.push_back(at);
            }
        };
        for (std::size_t i = 0; i + 1 < edge.line.size(); ++i) {
            Vec2 const p = edge.line[i];
            Vec2 const q = edge.line[i + 1];
            auto const near = too_near(left, right, p, q, rise_.clear_m);
            if (i == 0 && !(near && near->first == 0.0)) {
                begin(edge.from, raised(p, diagram_.vertices[edge.from].sites));
            }
            if (near) {
                if (piece) {
                    go(raised(midway(left, right, between(p, q, near->first)), both));
                    end(nodes_++);
                }
                if (near->second < 1.0) {
                    begin(nodes_++, raised(midway(left, right, between(p, q, near->second)), both));
                }
            }
            if (piece) {
                bool const last = i + 2 == edge.line.size();
                go(raised(q, last ? std::span<std::size_t const>(diagram_.vertices[edge.to].sites) : both));
            }
        }
        if (piece) {
            end(edge.to);
        }
    }

    std::vector<RidgePiece> take() { return std::move(pieces_); }

private:
    static Vec2 between(Vec2 p, Vec2 q, double share) { return {p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)}; }

    Vec3 raised(Vec2 at, std::span<std::size_t const> sites) const {
        double z = -std::numeric_limits<double>::infinity();
        double away = 0.0;
        for (std::size_t const s : sites) {
            auto const& site = diagram_.sites[s];
            auto const foot = geometry::foot_on(site.a, site.b, at);
            auto const& heights = rivers_.z[site.line];
            double const a = heights[site.vertex];
            double const b = site.a == site.b ? a : heights[site.vertex + 1];
            z = std::max(z, a + foot.along * (b - a));
            away = std::max(away, distance(at, foot.at));
        }
        return {at.x, at.y, z + rise_.gain * std::min(away, rise_.farthest_m)};
    }

    Diagram const& diagram_;
    LabelledRivers const& rivers_;
    Rise const& rise_;
    std::size_t nodes_;
    std::vector<RidgePiece> pieces_;
};

// Converts the edges of a diagram of rivers to pieces with heights, without the parts closer to their sites than
// clear_m.
std::vector<RidgePiece> ridge_pieces(Diagram const& diagram, LabelledRivers const& rivers, Rise const& rise) {
    Cutter cutter(diagram, rivers, rise);
    for (auto const& edge : diagram.edges) {
        cutter.add(edge);
    }
    return cutter.take();
}

/// The pieces that begin and end at a node.
struct Meeting {
    std::vector<std::size_t> out;
    std::vector<std::size_t> in;
};

std::tuple<double, double> place(Vec3 const& p) {
    return {p.x, p.y};
}

class Chains {
public:
    explicit Chains(std::vector<RidgePiece> pieces) : pieces_(std::move(pieces)), used_(pieces_.size(), 0) {
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            auto& [from, to, ridge] = pieces_[i];
            if (ridge.left > ridge.right) {
                std::swap(from, to);
                std::swap(ridge.left, ridge.right);
                std::ranges::reverse(ridge.line);
            }
            meetings_[from].out.push_back(i);
            meetings_[to].in.push_back(i);
        }
    }

    RidgeLines take() {
        RidgeLines ridges;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            if (!runs_through(pieces_[i].from)) {
                ridges.lines.push_back(from(i));
            }
        }
        // The remaining pieces form closed lines.
        std::vector<std::size_t> order(pieces_.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        std::ranges::sort(order, {}, [&](std::size_t i) { return place(pieces_[i].ridge.line.front()); });
        for (std::size_t const i : order) {
            if (used_[i] == 0) {
                ridges.lines.push_back(from(i));
            }
        }
        std::ranges::sort(ridges.lines, {}, [](RidgeLine const& r) {
            return std::tuple(r.left, r.right, place(r.line.front()), place(r.line[1]));
        });
        return ridges;
    }

private:
    bool runs_through(std::size_t node) const {
        auto const& [out, in] = meetings_.at(node);
        return out.size() == 1 && in.size() == 1 && pieces_[out.front()].ridge.left == pieces_[in.front()].ridge.left &&
               pieces_[out.front()].ridge.right == pieces_[in.front()].ridge.right;
    }

    RidgeLine from(std::size_t i) {
        RidgeLine line = pieces_[i].ridge;
        used_[i] = 1;
        while (runs_through(pieces_[i].to)) {
            i = meetings_.at(pieces_[i].to).out.front();
            if (used_[i] != 0) {
                break;
            }
            used_[i] = 1;
            auto const& more = pieces_[i].ridge.line;
            line.line.insert(line.line.end(), more.begin() + 1, more.end());
        }
        return line;
    }

    std::vector<RidgePiece> pieces_;
    std::vector<char> used_;
    std::map<std::size_t, Meeting> meetings_;
};

// Joins pieces into the longest lines that have the same labels and meet others only at their ends. Each piece is in
// one line; left < right; sorted by left, right and position; closed lines begin at their westernmost vertex.
RidgeLines chain_ridges(std::vector<RidgePiece> pieces) {
    return Chains(std::move(pieces)).take();
}

void require(RidgesParams const& params, Grid const& grid) {
    for (auto const& [name, value] : {std::pair{"gain", params.gain},
                                      {"farthest_m", params.farthest_m},
                                      {"spacing_m", params.spacing_m},
                                      {"tolerance_m", params.tolerance_m},
                                      {"clear_m", params.clear_m}}) {
        require_in("skeleton.ridges", name, value, Range::at_least(0.0));
    }
    refuse_if<BadParameter>(grid.width < 1 || grid.height < 1 || !(grid.cell_m > 0.0), "skeleton.ridges",
                            "a grid of {} x {} cells of {} m has no ground", grid.width, grid.height, grid.cell_m);
}

void require(ElevatedNetwork const& network, std::vector<std::int64_t> const& labels) {
    std::size_t const arcs = network.planform.arc_count();
    refuse_if<BadInput>(labels.size() != arcs || network.arc_z.size() != arcs, "skeleton.ridges",
                        "{} labels and heights of {} arcs for a network of {}; give one for each arc", labels.size(),
                        network.arc_z.size(), arcs);
    for (std::size_t a = 0; a < arcs; ++a) {
        auto const& line = network.planform.arc(a).line;
        auto const& z = network.arc_z[a];
        auto const bad = std::ranges::find_if_not(z, [](double h) { return std::isfinite(h); });
        if (z.size() != line.size() || bad != z.end()) {
            throw BadInput("skeleton.ridges",
                           fmt::format("arc {} from ({:.3f}, {:.3f}) has no height at every vertex; raise the network",
                                       a + 1, line.front().x, line.front().y));
        }
    }
}

/// Orders arcs from downstream: at a confluence the first of all labels is that of the arc that leaves it.
std::vector<std::size_t> downstream_first(StreamNetwork const& network) {
    std::vector<std::size_t> order;
    for (NodeId const n : network.upstream_order()) {
        if (network.out(n) != no_arc) {
            order.push_back(network.out(n));
        }
    }
    return order;
}

/// Inserts vertices so that consecutive ones are at most spacing_m apart.
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

/// Removes pieces that meet a river, or meet another piece elsewhere than at ends of both.
std::vector<RidgePiece> without_meetings(std::vector<RidgePiece> pieces, LabelledRivers const& rivers, Run const& run) {
    std::vector<std::vector<Vec2>> drawn;
    for (auto const& river : rivers.lines) {
        drawn.push_back(river.line);
    }
    std::size_t const first = drawn.size();
    for (auto const& piece : pieces) {
        drawn.push_back(in_plan(piece.ridge.line));
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
    require(params, grid);
    require(network, stream_of_arc);
    LabelledRivers rivers;
    for (std::size_t const a : downstream_first(network.planform)) {
        rivers.lines.push_back({network.planform.arc(a).line, stream_of_arc[a]});
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
    for (RidgePiece& piece : pieces) { // clipping near rivers may round a point off its edge
        for (Vec3& p : piece.ridge.line) {
            p.x = std::clamp(p.x, bounds.west, bounds.east);
            p.y = std::clamp(p.y, bounds.south, bounds.north);
        }
    }
    return chain_ridges(without_meetings(std::move(pieces), rivers, run));
}

} // namespace thalweg::skeleton
