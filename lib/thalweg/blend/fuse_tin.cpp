// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <thalweg/blend/internal/cut_tin.hpp>
#include <thalweg/blend/tin.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/triangles.hpp>
#include <thalweg/geometry/triangulate.hpp>

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

/// Maps each vertex of the boundary to the next.
std::map<std::uint32_t, std::uint32_t> boundary(Tin const& mesh, std::string const& name) {
    std::vector<DirectedEdge> const edges = sorted_edges(mesh);
    auto const twice = std::adjacent_find(edges.begin(), edges.end());
    if (twice != edges.end()) {
        throw BadInput("blend.outline_of",
                       fmt::format("{}: two triangles lie on the same side of the edge from {} to {}; repair the mesh",
                                   name, place(mesh.vertices[twice->first]), place(mesh.vertices[twice->second])));
    }
    std::map<std::uint32_t, std::uint32_t> next;
    for (DirectedEdge const& e : edges) {
        if (!std::binary_search(edges.begin(), edges.end(), DirectedEdge{e.second, e.first}) &&
            !next.insert(e).second) {
            throw BadInput("blend.outline_of",
                           fmt::format("{}: its boundary touches itself at {}; the mesh must have one simple boundary",
                                       name, place(mesh.vertices[e.first])));
        }
    }
    return next;
}

void require_simple(Tin const& mesh, std::vector<std::uint32_t> const& ring, std::string const& name, Run const& run) {
    std::vector<std::vector<Vec2>> line(1);
    for (std::uint32_t const v : ring) {
        line[0].push_back(in_plan(mesh.vertices[v]));
    }
    line[0].push_back(line[0].front());
    for (geometry::Crossing const& c : geometry::crossings(line, run)) {
        bool const closes = (c.segment == 0 && c.along == 0.0) || (c.segment + 1 == ring.size() && c.along == 1.0);
        refuse_if<BadInput>(!closes, "blend.outline_of",
                            "{}: its boundary meets itself in plan at ({}, {}): the mesh covers itself there", name,
                            c.at.x, c.at.y);
    }
}

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();

Edge edge_of(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

struct PlanBox {
    Vec2 least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 most{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    void add(Vec2 p) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y)};
    }
    bool meets(PlanBox const& other) const {
        return least.x <= other.most.x && other.least.x <= most.x && least.y <= other.most.y && other.least.y <= most.y;
    }
};

/// Triangles that the region may touch, and all others.
struct SplitTriangles {
    std::vector<Triangle> near;
    std::vector<Triangle> far;
};

SplitTriangles part(Tin const& target, std::vector<Vec2> const& outline) {
    PlanBox region;
    for (Vec2 const p : outline) {
        region.add(p);
    }
    SplitTriangles parted;
    for (Triangle const& t : target.triangles) {
        PlanBox box;
        for (std::uint32_t const v : t) {
            box.add(in_plan(target.vertices[v]));
        }
        (box.meets(region) ? parted.near : parted.far).push_back(t);
    }
    return parted;
}

/// The target's height at each vertex of the outline.
std::vector<double> heights_on(Tin const& target, std::vector<Triangle> const& near, std::vector<Vec2> const& outline) {
    std::vector<std::size_t> by_x(outline.size());
    for (std::size_t i = 0; i < by_x.size(); ++i) {
        by_x[i] = i;
    }
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) { return before(outline[a], outline[b]); });
    std::vector<std::optional<double>> found(outline.size());
    for (Triangle const& t : near) {
        Vec3 const& a = target.vertices[t[0]];
        Vec3 const& b = target.vertices[t[1]];
        Vec3 const& c = target.vertices[t[2]];
        double const most = std::max({a.x, b.x, c.x});
        auto at = std::lower_bound(by_x.begin(), by_x.end(), std::min({a.x, b.x, c.x}),
                                   [&](std::size_t i, double x) { return outline[i].x < x; });
        for (; at != by_x.end() && outline[*at].x <= most; ++at) {
            Vec2 const p = outline[*at];
            if (!found[*at] && geometry::side_of_line(in_plan(a), in_plan(b), p) >= 0 &&
                geometry::side_of_line(in_plan(b), in_plan(c), p) >= 0 &&
                geometry::side_of_line(in_plan(c), in_plan(a), p) >= 0) {
                found[*at] = geometry::height_on_plane(a, b, c, p);
            }
        }
    }
    std::vector<double> heights;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        if (!found[i]) {
            throw BadInput("blend.cut_tin", fmt::format("the patch leaves the target at ({}, {}); it must lie within",
                                                        outline[i].x, outline[i].y));
        }
        heights.push_back(*found[i]);
    }
    return heights;
}

/// The triangles that the region may touch, cut along the outline.
struct Overlay {
    geometry::Triangulation mesh;
    std::size_t target_edges = 0; ///< chains that are the target's edges, followed by the outline's sides
    std::vector<Edge> edges;      ///< of the target, by chain
    std::map<Edge, int> rim;      ///< edges of the overlay at which the near triangles end, with their count
    std::map<Edge, int> outline;  ///< edges on the outline, with their count
};

void count_edges(std::vector<std::uint32_t> const& chain, std::map<Edge, int>& counts) {
    for (std::size_t i = 1; i < chain.size(); ++i) {
        ++counts[edge_of(chain[i - 1], chain[i])];
    }
}

Overlay overlay_of(Tin const& target, std::vector<Triangle> const& near, std::vector<Vec2> const& outline,
                   Run const& run) {
    std::map<Edge, int> sides;
    for (Triangle const& t : near) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++sides[edge_of(t[k], t[(k + 1) % 3])];
        }
    }
    Overlay overlay;
    std::vector<std::vector<Vec3>> lines; // the target's first: its heights are used at crossings
    for (auto const& [edge, times] : sides) {
        overlay.edges.push_back(edge);
        lines.push_back({target.vertices[edge.first], target.vertices[edge.second]});
    }
    std::vector<double> const heights = heights_on(target, near, outline);
    for (std::size_t i = 0; i < outline.size(); ++i) {
        std::size_t const next = (i + 1) % outline.size();
        lines.push_back({{outline[i].x, outline[i].y, heights[i]}, {outline[next].x, outline[next].y, heights[next]}});
    }
    overlay.mesh = geometry::triangulate({}, lines, run);
    for (std::size_t i = 0; i < overlay.edges.size(); ++i) {
        if (sides.at(overlay.edges[i]) == 1) {
            count_edges(overlay.mesh.chains[i], overlay.rim);
        }
    }
    for (std::size_t i = overlay.edges.size(); i < overlay.mesh.chains.size(); ++i) {
        count_edges(overlay.mesh.chains[i], overlay.outline);
    }
    return overlay;
}

/// Where a triangle of the overlay lies.
struct Where {
    bool known = false;
    bool in_target = false;
    bool in_region = false;
};

bool is_odd(std::map<Edge, int> const& counts, Edge const& edge) {
    auto const found = counts.find(edge);
    return found != counts.end() && found->second % 2 != 0;
}

/// Floods from outside the hull into every triangle: each line crossed changes the side.
std::vector<Where> sides_of(Overlay const& overlay) {
    constexpr std::size_t outside = std::numeric_limits<std::size_t>::max();
    std::vector<Triangle> const& triangles = overlay.mesh.tin.triangles;
    std::map<Edge, std::array<std::size_t, 2>> beside;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            auto const [at, is_new] = beside.try_emplace(edge_of(triangles[i][k], triangles[i][(k + 1) % 3]),
                                                         std::array<std::size_t, 2>{i, outside});
            if (!is_new) {
                at->second[1] = i;
            }
        }
    }
    std::vector<Where> where(triangles.size());
    std::vector<std::size_t> queue;
    auto const enter = [&](std::size_t triangle, Where const& from, Edge const& edge) {
        if (!where[triangle].known) {
            where[triangle] = {true, from.in_target != is_odd(overlay.rim, edge),
                               from.in_region != is_odd(overlay.outline, edge)};
            queue.push_back(triangle);
        }
    };
    for (auto const& [edge, both] : beside) {
        if (both[1] == outside) {
            enter(both[0], {}, edge);
        }
    }
    while (!queue.empty()) {
        std::size_t const i = queue.back();
        queue.pop_back();
        for (std::size_t k = 0; k < 3; ++k) {
            Edge const edge = edge_of(triangles[i][k], triangles[i][(k + 1) % 3]);
            auto const& both = beside.at(edge);
            std::size_t const other = both[0] == i ? both[1] : both[0];
            if (other != outside) {
                enter(other, where[i], edge);
            }
        }
    }
    return where;
}

/// Numbers the result's vertices: the remaining ones of the target, then the overlay's own.
class Numbers {
public:
    Numbers(Tin const& target, Overlay const& overlay)
        : target_(target), overlay_(overlay), target_of_(overlay.mesh.tin.vertices.size(), unnumbered),
          used_(target.vertices.size(), 0), of_target_(target.vertices.size(), unnumbered),
          of_overlay_(overlay.mesh.tin.vertices.size(), unnumbered) {
        for (std::size_t i = 0; i < overlay.edges.size(); ++i) {
            target_of_[overlay.mesh.chains[i].front()] = overlay.edges[i].first;
            target_of_[overlay.mesh.chains[i].back()] = overlay.edges[i].second;
        }
    }

    void use_target(std::uint32_t v) { used_[v] = 1; }
    void use_overlay(std::uint32_t v) {
        if (target_of_[v] != unnumbered) {
            used_[target_of_[v]] = 1;
        } else {
            of_overlay_[v] = 0;
        }
    }
    /// Numbers the vertices in use.
    void give_numbers(CutTin& cut) {
        for (std::size_t v = 0; v < used_.size(); ++v) {
            if (used_[v] != 0) {
                of_target_[v] = static_cast<std::uint32_t>(cut.tin.vertices.size());
                cut.tin.vertices.push_back(target_.vertices[v]);
            }
        }
        for (std::size_t v = 0; v < of_overlay_.size(); ++v) {
            if (of_overlay_[v] != unnumbered) {
                of_overlay_[v] = static_cast<std::uint32_t>(cut.tin.vertices.size());
                cut.tin.vertices.push_back(overlay_.mesh.tin.vertices[v]);
                ++cut.added;
            }
        }
    }
    std::uint32_t of_target(std::uint32_t v) const { return of_target_[v]; }
    std::uint32_t of_overlay(std::uint32_t v) const {
        return target_of_[v] != unnumbered ? of_target_[target_of_[v]] : of_overlay_[v];
    }

private:
    Tin const& target_;
    Overlay const& overlay_;
    std::vector<std::uint32_t> target_of_; ///< by vertex of the overlay
    std::vector<std::uint8_t> used_;       ///< by vertex of the target
    std::vector<std::uint32_t> of_target_;
    std::vector<std::uint32_t> of_overlay_;
};

double area(Tin const& tin, Triangle const& t) {
    return 0.5 * cross(in_plan(tin.vertices[t[0]]), in_plan(tin.vertices[t[1]]), in_plan(tin.vertices[t[2]]));
}

void require_whole(Tin const& target, std::vector<Triangle> const& near, Overlay const& overlay,
                   std::vector<Where> const& where) {
    double before_cut = 0.0;
    for (Triangle const& t : near) {
        before_cut += area(target, t);
    }
    double after_cut = 0.0;
    Tin const& tin = overlay.mesh.tin;
    for (std::size_t i = 0; i < where.size(); ++i) {
        double const here = area(tin, tin.triangles[i]);
        after_cut += where[i].in_target ? here : 0.0;
        // Slivers left by rounding along the target's edge do not count.
        if (where[i].in_region && !where[i].in_target && here > 1e-12 * before_cut) {
            Vec3 const& p = tin.vertices[tin.triangles[i][0]];
            throw BadInput(
                "blend.cut_tin",
                fmt::format("the patch leaves the target near ({}, {}); it must lie within, and not over its holes",
                            p.x, p.y));
        }
    }
    refuse_if<BadInput>(std::fabs(after_cut - before_cut) > 1e-6 * before_cut, "blend.cut_tin",
                        "the target covers itself in plan where the patch lies: its triangles there have {} m2, their "
                        "outline {} m2; repair the target",
                        before_cut, after_cut);
}

using Inserted = std::vector<std::uint32_t>;

constexpr std::uint32_t elsewhere = std::numeric_limits<std::uint32_t>::max();

/// The patch at its own heights, with its outline split where the target's edges cross it.
struct Region {
    Tin mesh;
    std::vector<std::uint32_t> vertex_of; ///< by vertex of the region: its vertex in the cut target; inside: new
    std::map<std::pair<std::uint32_t, std::uint32_t>, Inserted> inserted; ///< by edge of the patch's outline
};

double height_between(Vec3 const& a, Vec3 const& b, Vec2 p) {
    double const length = distance(in_plan(a), in_plan(b));
    double const along = length > 0.0 ? distance(in_plan(a), p) / length : 0.0;
    return a.z + along * (b.z - a.z);
}

/// Splits a triangle at the vertices on its edges a-b, b-c and c-a.
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

/// Numbers the patch's vertices as the region's, those on the outline as in the cut target.
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
            double const z =
                height_between(patch.vertices[from], patch.vertices[to], in_plan(cut.tin.vertices[side[k]]));
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
        refuse_if<BadInput>(
            geometry::side_of_line(in_plan(a), in_plan(tin.vertices[t[1]]), in_plan(tin.vertices[t[2]])) <= 0,
            "blend.fuse_tin",
            "near ({}, {}) vertices of the target and of the patch's outline lie too close to be told apart; move the "
            "patch a little",
            a.x, a.y);
    }
}

} // namespace

Tin facing_up(Tin mesh, std::string const& name) {
    std::size_t down = 0;
    std::size_t first_down = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        auto const& t = mesh.triangles[i];
        for (std::uint32_t const v : t) {
            refuse_if<BadInput>(v >= mesh.vertices.size(), "blend.facing_up",
                                "{}: triangle {} names a vertex that is not there", name, i + 1);
            Vec3 const& p = mesh.vertices[v];
            refuse_if<BadInput>(!is_finite(p), "blend.facing_up", "{}: vertex {} is not finite", name, v + 1);
        }
        int const side = geometry::side_of_line(in_plan(mesh.vertices[t[0]]), in_plan(mesh.vertices[t[1]]),
                                                in_plan(mesh.vertices[t[2]]));
        if (side == 0) {
            throw BadInput("blend.facing_up", fmt::format("{}: triangle {} at {} has no area in plan; only meshes with "
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
        throw BadInput("blend.facing_up",
                       fmt::format("{} is folded in plan: {} of {} triangles face down, triangle {} at {} first; only "
                                   "meshes with one height at each place can be blended",
                                   name, down, mesh.triangles.size(), first_down + 1,
                                   place(mesh.vertices[mesh.triangles[first_down][0]])));
    }
    for (auto& t : mesh.triangles) {
        std::swap(t[1], t[2]);
    }
    return mesh;
}

std::vector<std::uint32_t> outline_of(Tin const& mesh, std::string const& name, Run const& run) {
    std::map<std::uint32_t, std::uint32_t> const next = boundary(mesh, name);
    refuse_if<BadInput>(next.empty(), "blend.outline_of", "{} has no triangles", name);
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
        throw BadInput("blend.outline_of",
                       fmt::format("{} has several boundaries, one through {} and one through {}; close its holes, and "
                                   "give one part at a time",
                                   name, place(mesh.vertices[ring.front()]), place(mesh.vertices[other->first])));
    }
    require_simple(mesh, ring, name, run);
    return ring;
}

CutTin cut_tin(Tin const& target, std::vector<Vec2> const& outline, Run const& run) {
    SplitTriangles const parted = part(target, outline);
    if (parted.near.empty()) {
        throw BadInput("blend.cut_tin",
                       fmt::format("the patch at ({}, {}) lies off the target", outline.at(0).x, outline.at(0).y));
    }
    Overlay const overlay = overlay_of(target, parted.near, outline, run);
    std::vector<Where> const where = sides_of(overlay);
    require_whole(target, parted.near, overlay, where);
    std::vector<Triangle> const& triangles = overlay.mesh.tin.triangles;
    Numbers numbers(target, overlay);
    for (Triangle const& t : parted.far) {
        std::for_each(t.begin(), t.end(), [&](std::uint32_t v) { numbers.use_target(v); });
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (where[i].in_target && !where[i].in_region) {
            std::for_each(triangles[i].begin(), triangles[i].end(), [&](std::uint32_t v) { numbers.use_overlay(v); });
        }
    }
    for (std::size_t i = overlay.edges.size(); i < overlay.mesh.chains.size(); ++i) {
        for (std::uint32_t const v : overlay.mesh.chains[i]) {
            numbers.use_overlay(v);
        }
    }
    CutTin cut;
    numbers.give_numbers(cut);
    cut.removed = static_cast<std::int64_t>(target.vertices.size()) -
                  (static_cast<std::int64_t>(cut.tin.vertices.size()) - cut.added);
    for (Triangle const& t : parted.far) {
        cut.tin.triangles.push_back({numbers.of_target(t[0]), numbers.of_target(t[1]), numbers.of_target(t[2])});
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (where[i].in_target && !where[i].in_region) {
            Triangle const& t = triangles[i];
            cut.tin.triangles.push_back({numbers.of_overlay(t[0]), numbers.of_overlay(t[1]), numbers.of_overlay(t[2])});
        }
    }
    for (std::size_t i = overlay.edges.size(); i < overlay.mesh.chains.size(); ++i) {
        auto& side = cut.sides.emplace_back();
        for (std::uint32_t const v : overlay.mesh.chains[i]) {
            side.push_back(numbers.of_overlay(v));
        }
    }
    return cut;
}

FusedTin fuse_tin(Tin const& target, Tin const& patch, Run const& run) {
    Tin const below = facing_up(target, "the target");
    Tin const above = facing_up(patch, "the patch");
    std::vector<std::uint32_t> const outline = outline_of(above, "the patch", run);
    std::vector<Vec2> ring;
    for (std::uint32_t const v : outline) {
        ring.push_back(in_plan(above.vertices[v]));
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
