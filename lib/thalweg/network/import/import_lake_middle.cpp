// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/internal/lake_middle.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include <thalweg/geometry/nearby.hpp>
#include <thalweg/geometry/polylines.hpp>

namespace thalweg::network::import_steps {

std::optional<double> meeting_along(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    double const of_c = cross(a, b, c);
    double const of_d = cross(a, b, d);
    double const of_a = cross(c, d, a);
    double const of_b = cross(c, d, b);
    if (of_a == of_b || (of_c > 0.0) == (of_d > 0.0) || of_a * of_b > 0.0) {
        return std::nullopt;
    }
    return std::clamp(of_a / (of_a - of_b), 0.0, 1.0);
}

LakeOutline::LakeOutline(Polygon const& lake) : rings_(lake.rings) {
    for (Vec2 const p : rings_.front()) {
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
    }
}

bool LakeOutline::is_about(Vec2 p, double m) const {
    return p.x >= low_.x - m && p.x <= high_.x + m && p.y >= low_.y - m && p.y <= high_.y + m;
}

bool LakeOutline::contains(Vec2 p) const {
    bool inside = false;
    for (std::vector<Vec2> const& ring : rings_) {
        inside = inside != geometry::contains(ring, p);
    }
    return inside;
}

ShorePlace LakeOutline::nearest(Vec2 p) const {
    ShorePlace best;
    for (std::size_t i = 0; i < shore().size(); ++i) {
        geometry::Foot const foot = geometry::foot_on(shore()[i], shore()[(i + 1) % shore().size()], p);
        if (double const d = distance(p, foot.at); d < best.distance_m) {
            best = {i, foot.along, foot.at, d};
        }
    }
    return best;
}

ShorePlace LakeOutline::nearest_on_island(Vec2 p) const {
    ShorePlace best;
    for (std::size_t r = 1; r < rings_.size(); ++r) {
        for (std::size_t i = 0; i < rings_[r].size(); ++i) {
            geometry::Foot const foot = geometry::foot_on(rings_[r][i], rings_[r][(i + 1) % rings_[r].size()], p);
            if (double const d = distance(p, foot.at); d < best.distance_m) {
                best = {i, foot.along, foot.at, d};
            }
        }
    }
    return best;
}

std::optional<ShorePlace> LakeOutline::way_out(Vec2 from, Vec2 to) const {
    std::optional<ShorePlace> first;
    for (std::size_t i = 0; i < shore().size(); ++i) {
        Vec2 const c = shore()[i];
        Vec2 const d = shore()[(i + 1) % shore().size()];
        if (auto const along = meeting_along(from, to, c, d)) {
            Vec2 const at = from + *along * (to - from);
            if (!first || distance(from, at) < first->distance_m) {
                first = ShorePlace{i, geometry::foot_on(c, d, at).along, at, distance(from, at)};
            }
        }
    }
    return first;
}

bool LakeOutline::sees(Vec2 a, Vec2 b) const {
    for (std::vector<Vec2> const& ring : rings_) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            auto const along = meeting_along(a, b, ring[i], ring[(i + 1) % ring.size()]);
            if (along && *along * distance(a, b) > apart_m) {
                return false;
            }
        }
    }
    return contains(a + 0.5 * (b - a));
}

LakeMiddle::LakeMiddle(LakeOutline const& lake, std::vector<Mouth> const& mouths, double tolerance_m, Run const& run) {
    std::vector<geometry::LabelledLine> shores = pieces_of_shore(lake, mouths);
    append_islands(lake, shores);
    double const margin_m = 1.0 + 0.01 * distance(lake.low(), lake.high());
    geometry::Bounds const bounds{lake.low().x - margin_m, lake.low().y - margin_m, lake.high().x + margin_m,
                                  lake.high().y + margin_m};
    diagram_ = geometry::medial_lines(shores, bounds, {tolerance_m}, run);
    at_.resize(diagram_.vertices.size());
    for (std::size_t e = 0; e < diagram_.edges.size(); ++e) {
        geometry::Diagram::Edge const& edge = diagram_.edges[e];
        std::size_t const half = edge.line.size() / 2;
        if (edge.from != edge.to &&
            lake.contains(edge.line[half - 1] + 0.5 * (edge.line[half] - edge.line[half - 1]))) {
            at_[edge.from].push_back(e);
            at_[edge.to].push_back(e);
        }
    }
    for (Mouth const& mouth : mouths) {
        leaf_.push_back(nearest_leaf(mouth.begin()));
    }
}

void LakeMiddle::root_at(std::size_t mouth) {
    using Entry = std::pair<double, std::size_t>;
    std::vector<double> way_m(at_.size(), std::numeric_limits<double>::infinity());
    towards_.assign(at_.size(), no_edge);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    way_m[leaf_[mouth]] = 0.0;
    queue.emplace(0.0, leaf_[mouth]);
    while (!queue.empty()) {
        auto const [m, v] = queue.top();
        queue.pop();
        if (m > way_m[v]) {
            continue;
        }
        for (std::size_t const e : at_[v]) {
            std::size_t const to = other_end(e, v);
            if (double const next_m = m + length_of(e); next_m < way_m[to]) {
                way_m[to] = next_m;
                towards_[to] = e;
                queue.emplace(next_m, to);
            }
        }
    }
    is_taken_.assign(at_.size(), 0);
}

LakeMiddle::Way LakeMiddle::way_from(std::size_t mouth) const {
    std::size_t v = leaf_[mouth];
    Way way{{diagram_.vertices[v].at}, {{v, 0}}};
    while (is_taken_[v] == 0 && towards_[v] != no_edge) {
        geometry::Diagram::Edge const& edge = diagram_.edges[towards_[v]];
        if (edge.from == v) {
            way.line.insert(way.line.end(), edge.line.begin() + 1, edge.line.end());
        } else {
            way.line.insert(way.line.end(), edge.line.rbegin() + 1, edge.line.rend());
        }
        v = other_end(towards_[v], v);
        way.vertices.emplace_back(v, way.line.size() - 1);
    }
    way.ends_at_root = is_taken_[v] == 0;
    return way;
}

void LakeMiddle::take(Way const& way, std::size_t vertices) {
    for (auto const& [v, place] : way.vertices) {
        is_taken_[v] = is_taken_[v] != 0 || place < vertices ? 1 : 0;
    }
}

bool LakeMiddle::is_whole() const {
    return std::ranges::all_of(leaf_, [&](std::size_t v) { return v != no_edge; });
}

std::size_t LakeMiddle::other_end(std::size_t e, std::size_t v) const {
    return diagram_.edges[e].from == v ? diagram_.edges[e].to : diagram_.edges[e].from;
}

double LakeMiddle::length_of(std::size_t e) const {
    double length_m = 0.0;
    std::vector<Vec2> const& line = diagram_.edges[e].line;
    for (std::size_t i = 1; i < line.size(); ++i) {
        length_m += distance(line[i - 1], line[i]);
    }
    return length_m;
}

std::vector<geometry::LabelledLine> LakeMiddle::pieces_of_shore(LakeOutline const& lake,
                                                                std::vector<Mouth> const& mouths) {
    std::vector<std::vector<Vec2>> lines;
    for (std::size_t i = 0; i < mouths.size(); ++i) {
        lines.push_back(shore_between(lake.shore(), mouths[i], mouths[(i + 1) % mouths.size()]));
    }
    double const outward = geometry::signed_area(lake.shore()) > 0.0 ? 1.0 : -1.0;
    std::vector<geometry::LabelledLine> pieces;
    std::vector<geometry::LabelledLine> behind;
    for (std::size_t i = 0; i < mouths.size(); ++i) {
        if (mouths[i].inside.size() > 1) {
            continue;
        }
        std::size_t const last = (i + mouths.size() - 1) % mouths.size();
        Vec2 const at = mouths[i].shore.at;
        Vec2 const before = moved_back(lines[last], false);
        Vec2 const after = moved_back(lines[i], true);
        Vec2 const along = after - before;
        double const m = norm(along);
        Vec2 const out = m > 0.0 ? (outward * gap_m / m) * Vec2{along.y, -along.x} : Vec2{};
        if (m > 0.0) {
            behind.push_back({{at + out}, static_cast<std::int64_t>(last)});
            behind.push_back({{at + out}, static_cast<std::int64_t>(i)});
        }
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
        pieces.push_back({std::move(lines[i]), static_cast<std::int64_t>(i)});
    }
    pieces.insert(pieces.end(), behind.begin(), behind.end());
    return pieces;
}

Vec2 LakeMiddle::moved_back(std::vector<Vec2>& line, bool is_start) {
    Vec2& end = is_start ? line.front() : line.back();
    Vec2 const next = is_start ? line[1] : line[line.size() - 2];
    double const m = distance(end, next);
    end = end + (std::min(gap_m, 0.4 * m) / m) * (next - end);
    return end;
}

std::vector<Vec2> LakeMiddle::shore_between(std::vector<Vec2> const& shore, Mouth const& from, Mouth const& to) {
    std::vector<Vec2> line = from.inside;
    auto const add = [&](Vec2 p) {
        if (distance(p, line.back()) > same_point_m) {
            line.push_back(p);
        }
    };
    std::size_t segment = from.shore.segment;
    bool const is_around =
        to.shore.segment < segment || (to.shore.segment == segment && to.shore.along <= from.shore.along);
    std::size_t const vertices = to.shore.segment + (is_around ? shore.size() : std::size_t{0}) - segment;
    for (std::size_t k = 0; k < vertices; ++k) {
        segment = (segment + 1) % shore.size();
        if (distance(shore[segment], to.inside.back()) > same_point_m) {
            add(shore[segment]);
        }
    }
    for (auto p = to.inside.rbegin(); p != to.inside.rend(); ++p) {
        add(*p);
    }
    return line;
}

void LakeMiddle::append_islands(LakeOutline const& lake, std::vector<geometry::LabelledLine>& shores) {
    constexpr std::size_t most_islands = 200;
    std::vector<std::vector<Vec2>> islands(lake.rings().begin() + 1, lake.rings().end());
    std::erase_if(islands, [](std::vector<Vec2> const& island) { return island.size() < 3; });
    std::ranges::stable_sort(islands, std::greater(),
                             [](std::vector<Vec2> const& island) { return std::fabs(geometry::signed_area(island)); });
    islands.resize(std::min(islands.size(), most_islands));
    struct Nearest {
        double m = std::numeric_limits<double>::infinity();
        std::int64_t label = 0;
    };
    std::vector<Nearest> nearest(islands.size());
    for (std::vector<Vec2>& island : islands) {
        island.push_back(island.front());
    }
    auto const look_at = [&](geometry::LabelledLine const& line) {
        for (std::size_t k = 0; k < islands.size(); ++k) {
            if (double const m = distance_between(islands[k], line.line); m < nearest[k].m) {
                nearest[k] = {m, line.label};
            }
        }
    };
    std::ranges::for_each(shores, look_at);
    while (!islands.empty()) {
        auto const k = std::ranges::min_element(nearest, {}, &Nearest::m) - nearest.begin();
        shores.push_back({std::move(islands[static_cast<std::size_t>(k)]), nearest[static_cast<std::size_t>(k)].label});
        islands.erase(islands.begin() + k);
        nearest.erase(nearest.begin() + k);
        look_at(shores.back());
    }
}

double LakeMiddle::distance_between(std::vector<Vec2> const& one, std::vector<Vec2> const& other) {
    double least_m = std::numeric_limits<double>::infinity();
    auto const look = [&](std::vector<Vec2> const& points, std::vector<Vec2> const& line) {
        for (Vec2 const p : points) {
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                least_m = std::min(least_m, distance(p, geometry::foot_on(line[i], line[i + 1], p).at));
            }
        }
    };
    look(one, other);
    look(other, one);
    return least_m;
}

std::size_t LakeMiddle::nearest_leaf(Vec2 p) const {
    std::size_t best = no_edge;
    double least_m = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < at_.size(); ++v) {
        double const d = distance(diagram_.vertices[v].at, p);
        if (at_[v].size() == 1 && d < least_m) {
            best = v;
            least_m = d;
        }
    }
    return best;
}

} // namespace thalweg::network::import_steps
