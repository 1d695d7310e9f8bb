// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/fuse_tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/blend/internal/cut_tin.hpp>
#include <thalweg/blend/internal/mesh_outline.hpp>
#include <thalweg/blend/paste_tin.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/side_of_line.hpp>
#include <thalweg/geometry/triangle_order.hpp>

namespace thalweg::blend {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Inserted = std::vector<std::uint32_t>;

constexpr std::uint32_t elsewhere = std::numeric_limits<std::uint32_t>::max();

/// The patch with its outline cut as the target's edges cut it, at its own heights.
struct Region {
    Tin mesh;
    std::vector<std::uint32_t> vertex_of; ///< by vertex of the region: that of the cut target, elsewhere inside
    std::map<std::pair<std::uint32_t, std::uint32_t>, Inserted> inserted; ///< by edge of the patch's outline
};

double height_between(Vec3 const& a, Vec3 const& b, Vec2 p) {
    double const length = distance(plan(a), plan(b));
    double const along = length > 0.0 ? distance(plan(a), p) / length : 0.0;
    return a.z + along * (b.z - a.z);
}

/// A triangle and what lies on its edges a-b, b-c and c-a, cut into triangles with these as corners.
void cut_triangle(Triangle const& t, std::array<Inserted, 3> const& on, std::vector<Triangle>& out) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (on[k].empty()) {
            continue;
        }
        std::uint32_t const top = t[(k + 2) % 3];
        Inserted points{t[k]};
        points.insert(points.end(), on[k].begin(), on[k].end());
        points.push_back(t[(k + 1) % 3]);
        for (std::size_t i = 1; i < points.size(); ++i) {
            cut_triangle({points[i - 1], points[i], top},
                         {Inserted{}, i + 1 == points.size() ? on[(k + 1) % 3] : Inserted{},
                          i == 1 ? on[(k + 2) % 3] : Inserted{}},
                         out);
        }
        return;
    }
    out.push_back(t);
}

/// Numbers the patch's vertices as the region's, those of the outline by the cut target's.
Region region_of(Tin const& patch, std::vector<std::uint32_t> const& outline, CutTin const& cut) {
    Region region;
    std::vector<std::uint32_t> number(patch.vertices.size(), elsewhere);
    auto const add = [&](Vec3 const& at, std::uint32_t vertex) {
        region.mesh.vertices.push_back(at);
        region.vertex_of.push_back(vertex);
        return static_cast<std::uint32_t>(region.vertex_of.size() - 1);
    };
    auto const on_target = [&](std::uint32_t vertex, double z) {
        Vec3 const& at = cut.tin.vertices[vertex];
        return Vec3{at.x, at.y, z};
    };
    for (std::size_t i = 0; i < outline.size(); ++i) {
        std::uint32_t const vertex = cut.sides[i].front();
        number[outline[i]] = add(on_target(vertex, patch.vertices[outline[i]].z), vertex);
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
        std::uint32_t const from = outline[i];
        std::uint32_t const to = outline[(i + 1) % outline.size()];
        auto const& side = cut.sides[i];
        Inserted& inserted = region.inserted[{from, to}];
        for (std::size_t k = 1; k + 1 < side.size(); ++k) {
            double const z = height_between(patch.vertices[from], patch.vertices[to], plan(cut.tin.vertices[side[k]]));
            inserted.push_back(add(on_target(side[k], z), side[k]));
        }
    }
    std::vector<std::uint8_t> used(patch.vertices.size(), 0);
    for (Triangle const& t : patch.triangles) {
        used[t[0]] = used[t[1]] = used[t[2]] = 1;
    }
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (used[v] != 0 && number[v] == elsewhere) {
            number[v] = add(patch.vertices[v], elsewhere);
        }
    }
    for (Triangle const& t : patch.triangles) {
        Triangle corners{};
        std::array<Inserted, 3> on;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = number[t[k]];
            auto const found = region.inserted.find({t[k], t[(k + 1) % 3]});
            on[k] = found == region.inserted.end() ? Inserted{} : found->second;
        }
        cut_triangle(corners, on, region.mesh.triangles);
    }
    return region;
}

void require_area(Tin const& tin) {
    for (Triangle const& t : tin.triangles) {
        Vec3 const& a = tin.vertices[t[0]];
        if (geometry::side_of_line(plan(a), plan(tin.vertices[t[1]]), plan(tin.vertices[t[2]])) <= 0) {
            throw BadInput(
                fmt::format("blend.fuse_tin: near ({}, {}) vertices of the target and of the patch's outline "
                            "lie too close to be told apart; move the patch a little",
                            a.x, a.y));
        }
    }
}

} // namespace

FusedTin fuse_tin(Tin const& target, Tin const& patch, Run const& run) {
    Tin const below = facing_up(target, "the target");
    Tin const above = facing_up(patch, "the patch");
    std::vector<std::uint32_t> const outline = outline_of(above, "the patch", run);
    std::vector<Vec2> ring;
    for (std::uint32_t const v : outline) {
        ring.push_back(plan(above.vertices[v]));
    }
    CutTin cut = cut_tin(below, ring, run);
    Region const region = region_of(above, outline, cut);
    require_area(region.mesh);
    require_area(cut.tin);

    FusedTin fused;
    std::vector<FixedVertex> fixed;
    for (std::uint32_t v = 0; v < region.vertex_of.size(); ++v) {
        if (region.vertex_of[v] != elsewhere) {
            fixed.push_back({v, cut.tin.vertices[region.vertex_of[v]]});
            fused.lift_max_m = std::max(fused.lift_max_m, std::fabs(fixed.back().at.z - region.mesh.vertices[v].z));
        }
    }
    PastedTin const pasted = paste_tin(region.mesh, gradients_of(region.mesh, region.mesh.vertices), fixed,
                                       geometry::Measured::in_plan, run);
    fused.residual = pasted.residual;
    fused.removed = cut.removed;
    fused.added = cut.added;
    fused.tin = std::move(cut.tin);
    std::vector<std::uint32_t> number = region.vertex_of;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == elsewhere) {
            number[v] = static_cast<std::uint32_t>(fused.tin.vertices.size());
            fused.tin.vertices.push_back(pasted.tin.vertices[v]);
            ++fused.inner;
        }
    }
    for (Triangle const& t : pasted.tin.triangles) {
        fused.tin.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    }
    geometry::put_in_order(fused.tin);
    return fused;
}

} // namespace thalweg::blend
