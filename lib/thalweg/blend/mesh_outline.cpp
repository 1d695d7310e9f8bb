// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/internal/mesh_outline.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/side_of_line.hpp>

namespace thalweg::blend {
namespace {

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<DirectedEdge> sorted_edges(Tin const& mesh) {
    std::vector<DirectedEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (auto const& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.emplace_back(t[k], t[(k + 1) % 3]);
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

std::string place(Vec3 const& v) {
    return fmt::format("({}, {})", v.x, v.y);
}

/// What follows each vertex of the boundary.
std::map<std::uint32_t, std::uint32_t> boundary(Tin const& mesh, std::string const& name) {
    std::vector<DirectedEdge> const edges = sorted_edges(mesh);
    auto const twice = std::adjacent_find(edges.begin(), edges.end());
    if (twice != edges.end()) {
        throw BadInput(
            fmt::format("blend.outline_of: {}: two triangles lie on the same side of the edge from {} to {}; "
                        "repair the mesh",
                        name, place(mesh.vertices[twice->first]), place(mesh.vertices[twice->second])));
    }
    std::map<std::uint32_t, std::uint32_t> next;
    for (DirectedEdge const& e : edges) {
        if (!std::binary_search(edges.begin(), edges.end(), DirectedEdge{e.second, e.first}) &&
            !next.insert(e).second) {
            throw BadInput(
                fmt::format("blend.outline_of: {}: its boundary touches itself at {}; the mesh must have one "
                            "simple boundary",
                            name, place(mesh.vertices[e.first])));
        }
    }
    return next;
}

void require_simple(Tin const& mesh, std::vector<std::uint32_t> const& ring, std::string const& name, Run const& run) {
    std::vector<std::vector<Vec2>> line(1);
    for (std::uint32_t const v : ring) {
        line[0].push_back(plan(mesh.vertices[v]));
    }
    line[0].push_back(line[0].front());
    for (geometry::Crossing const& c : geometry::crossings(line, run)) {
        bool const closes = (c.segment == 0 && c.along == 0.0) || (c.segment + 1 == ring.size() && c.along == 1.0);
        if (!closes) {
            throw BadInput(fmt::format("blend.outline_of: {}: its boundary meets itself in plan at ({}, {}): the mesh "
                                       "covers itself there",
                                       name, c.at.x, c.at.y));
        }
    }
}

} // namespace

Tin facing_up(Tin mesh, std::string const& name) {
    std::size_t down = 0;
    std::size_t first_down = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        auto const& t = mesh.triangles[i];
        for (std::uint32_t const v : t) {
            if (v >= mesh.vertices.size()) {
                throw BadInput(
                    fmt::format("blend.facing_up: {}: triangle {} names a vertex that is not there", name, i + 1));
            }
            Vec3 const& p = mesh.vertices[v];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
                throw BadInput(fmt::format("blend.facing_up: {}: vertex {} is not finite", name, v + 1));
            }
        }
        int const side =
            geometry::side_of_line(plan(mesh.vertices[t[0]]), plan(mesh.vertices[t[1]]), plan(mesh.vertices[t[2]]));
        if (side == 0) {
            throw BadInput(fmt::format("blend.facing_up: {}: triangle {} at {} has no area in plan; only meshes with "
                                       "one height at each place can be blended",
                                       name, i + 1, place(mesh.vertices[t[0]])));
        }
        if (side < 0 && down++ == 0) {
            first_down = i;
        }
    }
    if (down == 0) {
        return mesh;
    }
    if (down < mesh.triangles.size()) {
        throw BadInput(fmt::format(
            "blend.facing_up: {} is folded in plan: {} of {} triangles face down, triangle {} at "
            "{} first; only meshes with one height at each place can be blended",
            name, down, mesh.triangles.size(), first_down + 1, place(mesh.vertices[mesh.triangles[first_down][0]])));
    }
    for (auto& t : mesh.triangles) {
        std::swap(t[1], t[2]);
    }
    return mesh;
}

std::vector<std::uint32_t> outline_of(Tin const& mesh, std::string const& name, Run const& run) {
    std::map<std::uint32_t, std::uint32_t> const next = boundary(mesh, name);
    if (next.empty()) {
        throw BadInput(fmt::format("blend.outline_of: {} has no triangles", name));
    }
    std::vector<std::uint32_t> ring;
    std::uint32_t v = next.begin()->first;
    do {
        ring.push_back(v);
        v = next.at(v);
    } while (v != ring.front());
    if (ring.size() < next.size()) {
        std::vector<std::uint32_t> sorted = ring;
        std::sort(sorted.begin(), sorted.end());
        auto const other = std::find_if(next.begin(), next.end(), [&](auto const& e) {
            return !std::binary_search(sorted.begin(), sorted.end(), e.first);
        });
        throw BadInput(fmt::format("blend.outline_of: {} has several boundaries, one through {} and one through {}; "
                                   "close its holes, and give one part at a time",
                                   name, place(mesh.vertices[ring.front()]), place(mesh.vertices[other->first])));
    }
    require_simple(mesh, ring, name, run);
    return ring;
}

} // namespace thalweg::blend
