// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/geometry/internal/diagram.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace thalweg::geometry {

double distance_to(Diagram::Site const& site, Vec2 p) {
    return distance(p, foot_on(site.a, site.b, p).at);
}

Vec2 midway(Diagram::Site const& s, Diagram::Site const& t, Vec2 p, Vec2 direction) {
    constexpr int most_steps = 20;
    Vec2 best = p;
    double least = std::numeric_limits<double>::infinity();
    for (int step = 0; step < most_steps; ++step) {
        Vec2 const a = foot_on(s.a, s.b, p).at;
        Vec2 const b = foot_on(t.a, t.b, p).at;
        double const d = distance(p, a);
        double const e = distance(p, b);
        if (!(std::fabs(d - e) < least)) {
            break;
        }
        least = std::fabs(d - e);
        best = p;
        if (!(d > 0.0 && e > 0.0)) {
            break;
        }
        Vec2 const up{(p.x - a.x) / d - (p.x - b.x) / e, (p.y - a.y) / d - (p.y - b.y) / e};
        Vec2 const way = direction == Vec2{} ? up : direction;
        double const share = (e - d) / (up.x * way.x + up.y * way.y);
        p = {p.x + share * way.x, p.y + share * way.y};
    }
    return best;
}

namespace {

constexpr double far_away = 8.0;    // in units of the whole extent
constexpr double same_place = 1e-9; // in units of the whole extent

void note_label(std::vector<std::int64_t>& labels, std::int64_t label) {
    auto const place = std::ranges::lower_bound(labels, label);
    if (place == labels.end() || *place != label) {
        labels.insert(place, label);
    }
}

bool disjoint(std::vector<std::int64_t> const& a, std::vector<std::int64_t> const& b) {
    for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
        if (*i == *j) {
            return false;
        }
        *i < *j ? ++i : ++j;
    }
    return true;
}

/// Groups faces whose vertices coincide.
class Groups {
public:
    explicit Groups(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), std::size_t{0}); }
    std::size_t of(std::size_t i) {
        while (above_[i] != i) {
            above_[i] = above_[above_[i]];
            i = above_[i];
        }
        return i;
    }
    void join(std::size_t i, std::size_t j) { above_[of(i)] = of(j); }

private:
    std::vector<std::size_t> above_;
};

/// The part of pq within the bounds as shares of it.
std::optional<std::pair<double, double>> within(Vec2 p, Vec2 q, Bounds const& b) {
    double from = 0.0;
    double to = 1.0;
    auto const cut = [&](double start, double step, double low, double high) {
        if (step == 0.0) {
            return start >= low && start <= high;
        }
        double const one = (low - start) / step;
        double const other = (high - start) / step;
        from = std::max(from, std::min(one, other));
        to = std::min(to, std::max(one, other));
        return from < to;
    };
    if (cut(p.x, q.x - p.x, b.west, b.east) && cut(p.y, q.y - p.y, b.south, b.north)) {
        return std::pair(from, to);
    }
    return std::nullopt;
}

/// Adds edges to a diagram, clipped to the bounds.
class Edges {
public:
    Edges(Diagram& diagram, Bounds const& bounds) : diagram_(diagram), bounds_(bounds) {}

    void add(Diagram::Edge const& edge) {
        std::vector<Vec2> const& line = edge.line;
        Diagram::Edge piece = edge;
        piece.line.clear();
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            auto const part = within(line[i], line[i + 1], bounds_);
            if (!part || part->first > 0.0) {
                end_cut(piece);
            }
            if (!part) {
                continue;
            }
            if (piece.line.empty()) {
                piece.line.push_back(place(line[i], line[i + 1], part->first, edge));
                piece.from = i == 0 && part->first == 0.0 ? edge.from : cut_at(piece.line.back(), edge);
            }
            piece.line.push_back(part->second == 1.0 ? line[i + 1] : place(line[i], line[i + 1], part->second, edge));
            if (part->second < 1.0) {
                end_cut(piece);
            }
        }
        if (!piece.line.empty()) {
            piece.to = edge.to;
            keep(piece);
        }
    }

private:
    // Chords deviate from their arcs: a point cut off a chord is moved along the bounds to the arc.
    Vec2 place(Vec2 p, Vec2 q, double share, Diagram::Edge const& edge) const {
        if (share == 0.0) {
            return p;
        }
        Vec2 const cut = inside({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
        bool const beside = cut.x == bounds_.west || cut.x == bounds_.east;
        Vec2 const along = beside ? Vec2{0.0, 1.0} : Vec2{1.0, 0.0};
        return inside(midway(diagram_.sites[edge.left], diagram_.sites[edge.right], cut, along));
    }
    Vec2 inside(Vec2 p) const {
        return {std::clamp(p.x, bounds_.west, bounds_.east), std::clamp(p.y, bounds_.south, bounds_.north)};
    }
    std::size_t cut_at(Vec2 at, Diagram::Edge const& edge) {
        diagram_.vertices.push_back({at, {std::min(edge.left, edge.right), std::max(edge.left, edge.right)}});
        return diagram_.vertices.size() - 1;
    }
    void end_cut(Diagram::Edge& piece) {
        if (!piece.line.empty()) {
            piece.to = cut_at(piece.line.back(), piece);
            keep(piece);
        }
    }
    void keep(Diagram::Edge& piece) {
        piece.line.erase(std::unique(piece.line.begin(), piece.line.end()), piece.line.end());
        if (piece.line.size() > 1) {
            diagram_.edges.push_back(piece);
        }
        piece.line.clear();
    }

    Diagram& diagram_;
    Bounds const& bounds_;
};

/// Sorts by faces, the lower first in each link: an order independent of memory addresses.
void sort(std::vector<RawDiagram::Link>& links) {
    for (auto& link : links) {
        if (link.from > link.to) {
            std::swap(link.from, link.to);
            std::swap(link.left, link.right);
        }
    }
    std::ranges::sort(links, {}, [](auto const& l) { return std::tie(l.from, l.to, l.left, l.right); });
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using LabelMesh = CGAL::Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>,
                                                 CGAL::Triangulation_face_base_with_info_2<std::size_t, Kernel>>>;

LabelMesh mesh_of(LabelledSites const& sites, Run const& run) {
    using Entry = std::pair<Point, std::size_t>;
    std::vector<Entry> entries;
    for (auto const& site : sites.sites) {
        entries.emplace_back(Point(site.a.x, site.a.y), entries.size());
    }
    for (Vec2 const p : sites.far) {
        entries.emplace_back(Point(p.x, p.y), entries.size());
    }
    CGAL::spatial_sort(entries.begin(), entries.end(),
                       CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::First_of_pair_property_map<Entry>>());
    LabelMesh mesh;
    LabelMesh::Face_handle hint;
    std::size_t done = 0;
    for (auto const& [point, site] : entries) {
        if ((done++ & 0x3fff) == 0) {
            run.at(static_cast<double>(done) / static_cast<double>(entries.size()), "ridges");
        }
        auto const vertex = mesh.insert(point, hint);
        vertex->info() = site;
        hint = vertex->face();
    }
    return mesh;
}

/// The finite faces, sorted by the sites around them.
std::vector<std::pair<Around, LabelMesh::Face_handle>> faces_of(LabelMesh const& mesh) {
    std::vector<std::pair<Around, LabelMesh::Face_handle>> faces;
    for (auto const face : mesh.finite_face_handles()) {
        auto const site = [&](int i) { return face->vertex(i)->info(); };
        faces.emplace_back(least_first({site(0), site(1), site(2)}), face);
    }
    std::ranges::sort(faces, {}, [](auto const& f) { return f.first.sites; });
    return faces;
}

} // namespace

LabelledSites sites_of(std::vector<LabelledLine> const& lines, Bounds const& bounds, Parts parts,
                       std::string const& where) {
    refuse_if<BadParameter>(
        !(bounds.west < bounds.east) || !(bounds.south < bounds.north) || !std::isfinite(bounds.east - bounds.west) ||
            !std::isfinite(bounds.north - bounds.south),
        where, "bounds from ({}, {}) to ({}, {}) have no area", bounds.west, bounds.south, bounds.east, bounds.north);
    LabelledSites out;
    Bounds all = bounds;
    std::map<std::pair<double, double>, std::size_t> point_at;
    std::vector<std::vector<std::size_t>> chains;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto& chain = chains.emplace_back();
        for (std::size_t v = 0; v < lines[l].line.size(); ++v) {
            Vec2 const p{lines[l].line[v].x + 0.0, lines[l].line[v].y + 0.0};
            refuse_if<BadInput>(!is_finite(p), where, "vertex {} of line {} is not finite; remove it", v, l);
            auto const [place, is_new] = point_at.try_emplace({p.x, p.y}, out.sites.size());
            if (is_new) {
                out.sites.push_back({l, v, p, p});
                out.labels.emplace_back();
            }
            note_label(out.labels[place->second], lines[l].label);
            chain.push_back(place->second);
            all = {std::min(all.west, p.x), std::min(all.south, p.y), std::max(all.east, p.x),
                   std::max(all.north, p.y)};
        }
    }
    out.points = out.sites.size();
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> segment_at;
    for (std::size_t l = 0; l < lines.size() && parts == Parts::segments; ++l) {
        for (std::size_t v = 0; v + 1 < chains[l].size(); ++v) {
            std::size_t const a = chains[l][v];
            std::size_t const b = chains[l][v + 1];
            if (a == b) {
                continue;
            }
            auto const [place, is_new] = segment_at.try_emplace(std::minmax(a, b), out.sites.size());
            if (is_new) {
                out.sites.push_back({l, v, out.sites[a].a, out.sites[b].a});
                out.labels.emplace_back();
                out.ends.push_back({a, b});
            }
            note_label(out.labels[place->second], lines[l].label);
        }
    }
    out.size_m = distance({all.west, all.south}, {all.east, all.north});
    double const off = far_away * out.size_m;
    out.far = {Vec2{all.west - off, all.south - off},
               {all.east + off, all.south - off},
               {all.east + off, all.north + off},
               {all.west - off, all.north + off}};
    return out;
}

Around least_first(std::array<std::size_t, 3> const& sites) {
    Around around{sites, 0};
    auto const least = std::ranges::min_element(around.sites);
    around.first = static_cast<int>(least - around.sites.begin());
    std::rotate(around.sites.begin(), least, around.sites.end());
    return around;
}

Diagram finish(LabelledSites const& sites, RawDiagram raw, Bounds const& bounds, Curve const& curve, Run const& run) {
    sort(raw.links);
    Groups groups(raw.at.size());
    for (auto const& link : raw.links) {
        if (distance(raw.at[link.from], raw.at[link.to]) <= same_place * sites.size_m) {
            groups.join(link.from, link.to);
        }
    }
    Diagram diagram;
    diagram.sites = sites.sites;
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> vertex_of(raw.at.size(), none);
    for (std::size_t f = 0; f < raw.at.size(); ++f) {
        std::size_t& vertex = vertex_of[groups.of(f)];
        if (vertex == none) {
            vertex = diagram.vertices.size();
            diagram.vertices.push_back({raw.at[f], {}});
        }
        auto& [at, around] = diagram.vertices[vertex];
        at = std::min(at, raw.at[f], before);
        std::ranges::copy_if(raw.sites[f], std::back_inserter(around),
                             [&](std::size_t s) { return s < sites.sites.size(); });
    }
    for (auto& [at, around] : diagram.vertices) {
        std::ranges::sort(around);
        around.erase(std::unique(around.begin(), around.end()), around.end());
    }
    Edges edges(diagram, bounds);
    std::size_t done = 0;
    for (auto const& link : raw.links) {
        if ((done++ & 0xfff) == 0) {
            run.check();
        }
        std::size_t const from = vertex_of[groups.of(link.from)];
        std::size_t const to = vertex_of[groups.of(link.to)];
        bool const real = link.left < sites.sites.size() && link.right < sites.sites.size();
        if (!real || from == to || !disjoint(sites.labels[link.left], sites.labels[link.right])) {
            continue;
        }
        Vec2 const p = diagram.vertices[from].at;
        Vec2 const q = diagram.vertices[to].at;
        Diagram::Edge edge{from, to, link.left, link.right, {p}};
        auto const inner = curve(sites.sites[link.left], sites.sites[link.right], p, q);
        edge.line.insert(edge.line.end(), inner.begin(), inner.end());
        edge.line.push_back(q);
        edges.add(edge);
    }
    return diagram;
}

Diagram voronoi(std::vector<LabelledLine> const& lines, Bounds const& bounds, Run const& run) {
    LabelledSites const sites = sites_of(lines, bounds, Parts::vertices, "geometry.voronoi");
    if (sites.points < 2) {
        return {};
    }
    LabelMesh const mesh = mesh_of(sites, run);
    RawDiagram raw;
    for (auto const& [around, face] : faces_of(mesh)) {
        face->info() = raw.at.size();
        int const next = LabelMesh::ccw(around.first);
        Point const at = CGAL::circumcenter(face->vertex(around.first)->point(), face->vertex(next)->point(),
                                            face->vertex(LabelMesh::ccw(next))->point());
        raw.at.push_back({at.x(), at.y()});
        raw.sites.push_back(around.sites);
    }
    for (auto const& [face, i] : mesh.finite_edges()) {
        auto const beyond = face->neighbor(i);
        if (!mesh.is_infinite(face) && !mesh.is_infinite(beyond)) {
            raw.links.push_back({face->info(), beyond->info(), face->vertex(LabelMesh::cw(i))->info(),
                                 face->vertex(LabelMesh::ccw(i))->info()});
        }
    }
    return finish(
        sites, std::move(raw), bounds, [](auto const&, auto const&, Vec2, Vec2) { return std::vector<Vec2>{}; }, run);
}

} // namespace thalweg::geometry
