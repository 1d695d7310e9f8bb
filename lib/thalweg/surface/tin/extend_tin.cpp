// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/tin/internal/extend_tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/run/parallel.hpp>

namespace thalweg::surface {
namespace {

struct OuterEdge {
    Vec3 a;
    Vec3 b;
};

std::vector<OuterEdge> outer_edges(Tin const& tin) {
    using Half = std::array<std::uint32_t, 3>; // lower end, upper end, triangle
    std::vector<Half> halves;
    halves.reserve(3 * tin.triangles.size());
    for (std::uint32_t i = 0; auto const& t : tin.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            auto const [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            halves.push_back({low, high, i});
        }
        ++i;
    }
    std::ranges::sort(halves);
    std::vector<Half> outer;
    for (std::size_t i = 0; i < halves.size(); ++i) {
        auto const same = [&](std::size_t k) {
            return k < halves.size() && halves[k][0] == halves[i][0] && halves[k][1] == halves[i][1];
        };
        if (!same(i + 1) && (i == 0 || !same(i - 1))) {
            outer.push_back(halves[i]);
        }
    }
    std::ranges::sort(outer, {}, [](Half const& h) { return h[2]; });
    std::vector<OuterEdge> edges;
    for (Half const& h : outer) {
        edges.push_back({tin.vertices[h[0]], tin.vertices[h[1]]});
    }
    return edges;
}

struct Box {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double east = -std::numeric_limits<double>::infinity();
    double north = -std::numeric_limits<double>::infinity();

    void add(Vec3 const& p) {
        west = std::min(west, p.x);
        south = std::min(south, p.y);
        east = std::max(east, p.x);
        north = std::max(north, p.y);
    }
    double squared_distance(Vec2 p) const {
        double const dx = std::max({west - p.x, 0.0, p.x - east});
        double const dy = std::max({south - p.y, 0.0, p.y - north});
        return dx * dx + dy * dy;
    }
};

// A tree of boxes over the edges, halved by their middles along the longer side.
class Nearest {
public:
    explicit Nearest(std::vector<OuterEdge> edges) : edges_(std::move(edges)), order_(edges_.size()) {
        for (std::size_t i = 0; i < order_.size(); ++i) {
            order_[i] = i;
        }
        build(0, order_.size());
    }

    // The height at the nearest point of the edges.
    double height(Vec2 p) const {
        Found found;
        visit(0, p, found);
        return found.z;
    }

private:
    static constexpr std::size_t leaf_size = 4;
    struct Branch {
        Box box;
        std::size_t begin = 0;
        std::size_t end = 0;
        std::size_t second = 0; // the first child follows its parent; 0 in a leaf
    };
    struct Found {
        double squared = std::numeric_limits<double>::infinity();
        std::size_t edge = std::numeric_limits<std::size_t>::max();
        double z = std::numeric_limits<double>::quiet_NaN();
    };

    void build(std::size_t begin, std::size_t end) {
        std::size_t const self = tree_.size();
        tree_.push_back({{}, begin, end, 0});
        Box box;
        for (std::size_t i = begin; i < end; ++i) {
            box.add(edges_[order_[i]].a);
            box.add(edges_[order_[i]].b);
        }
        tree_[self].box = box;
        if (end - begin <= leaf_size) {
            return;
        }
        bool const wide = box.east - box.west > box.north - box.south;
        auto const key = [&](std::size_t e) {
            return wide ? edges_[e].a.x + edges_[e].b.x : edges_[e].a.y + edges_[e].b.y;
        };
        std::size_t const middle = begin + (end - begin) / 2;
        std::sort(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                  order_.begin() + static_cast<std::ptrdiff_t>(end),
                  [&](std::size_t a, std::size_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
        build(begin, middle);
        tree_[self].second = tree_.size();
        build(middle, end);
    }

    void visit(std::size_t at, Vec2 p, Found& found) const {
        Branch const& branch = tree_[at];
        if (branch.box.squared_distance(p) > found.squared) {
            return;
        }
        if (branch.second == 0) {
            for (std::size_t i = branch.begin; i < branch.end; ++i) {
                look(order_[i], p, found);
            }
            return;
        }
        std::size_t const first = at + 1;
        bool const swapped = tree_[branch.second].box.squared_distance(p) < tree_[first].box.squared_distance(p);
        visit(swapped ? branch.second : first, p, found);
        visit(swapped ? first : branch.second, p, found);
    }

    void look(std::size_t number, Vec2 p, Found& found) const {
        OuterEdge const& e = edges_[number];
        double const dx = e.b.x - e.a.x;
        double const dy = e.b.y - e.a.y;
        double const t = std::clamp(((p.x - e.a.x) * dx + (p.y - e.a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
        double const rx = p.x - (e.a.x + t * dx);
        double const ry = p.y - (e.a.y + t * dy);
        double const squared = rx * rx + ry * ry;
        if (squared < found.squared || (squared == found.squared && number < found.edge)) {
            found = {squared, number, t == 1.0 ? e.b.z : e.a.z + t * (e.b.z - e.a.z)};
        }
    }

    std::vector<OuterEdge> edges_;
    std::vector<std::size_t> order_;
    std::vector<Branch> tree_;
};

} // namespace

void extend_tin(Tin const& tin, Raster<float>& dem, Run const& run) {
    if (tin.triangles.empty()) {
        return;
    }
    Nearest const nearest(outer_edges(tin));
    parallel_ranges(run, dem.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            run.check();
            for (std::int64_t col = 0; float& z : dem.row(row)) {
                if (std::isnan(z)) {
                    z = static_cast<float>(nearest.height(dem.grid().centre({col, row})));
                }
                ++col;
            }
        }
    });
}

} // namespace thalweg::surface
