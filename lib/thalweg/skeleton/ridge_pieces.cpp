// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/internal/ridge_pieces.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <thalweg/geometry/segments_near.hpp>

namespace thalweg::skeleton {
namespace {

using geometry::Diagram;

/// The part of pq nearer than clear_m to both sites of the edge it belongs to, as shares of it.
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
    // Midway between two straight stretches the distance changes evenly.
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

} // namespace

std::vector<RidgePiece> ridge_pieces(Diagram const& diagram, LabelledRivers const& rivers, Rise const& rise) {
    Cutter cutter(diagram, rivers, rise);
    for (auto const& edge : diagram.edges) {
        cutter.add(edge);
    }
    return cutter.take();
}

} // namespace thalweg::skeleton
