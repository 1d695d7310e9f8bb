// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/internal/import_reaches.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include <thalweg/core/numbers/elementary.hpp>

// Described in docs/algorithms/river_directions.md.

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

/// Whether a cell around a position, or the position itself, has no data.
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

/// Whether the file makes everything at a node end there.
bool is_said_outlet(Pieces const& p, Votes const& certain, std::size_t n) {
    return !certain.empty() && std::ranges::all_of(p.at_node[n], [&](std::size_t k) {
        return certain[k] != 0 && (certain[k] > 0 ? p.pieces[k].to : p.pieces[k].from) == n;
    });
}

/// By node: whether it lies on a side of the file where other lines end, as in clipped files, or at the border of the
/// DEM, or is an outlet in the file.
std::vector<char> likely_outlets(Pieces const& p, std::vector<RiverLine> const& lines, Votes const& certain,
                                 Raster<float> const* dem) {
    std::array<double, 4> far{}; // west, east, south, north, outward
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
                reach.line.push_back(in_plan(v[runs > 0 ? piece.first + i : piece.last - i]));
            }
        }
        for (std::size_t i = 1; i < reach.line.size(); ++i) {
            reach.length_m += distance(reach.line[i - 1], reach.line[i]);
        }
    }

    Pieces const& p_;
    std::vector<RiverLine> const& lines_;
    std::vector<char> used_;
    std::vector<std::vector<std::size_t>> at_; ///< by node: pieces that are not rings
    std::vector<char> is_inner_;               ///< by node: reaches continue through it
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

// Depth-first; a reach is a bridge if nothing upstream of it is reached from downstream (Tarjan 1974).
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

// Log-odds of the true root, fitted to 16 networks: docs/algorithms/river_directions.md.
constexpr double near_scale = 0.1; // relative to the median reach
constexpr double far_scale = 1.0;
constexpr double near_weight = 1.05;
constexpr double far_weight = 0.99;
constexpr double border_weight = 1.84;
constexpr double own_border_weight = 0.82;
constexpr double free_weight = 1.02;
constexpr double free_reach = 3.0;     // relative to the median reach
constexpr double climb_per_unit = 3.0; // [m]
constexpr double most_climb_m = 12.0;  // of a reach
constexpr double split_weight = 4.0;   // of a drawn line whose parts run against each other

constexpr double fixed_point = 1LL << 32U;

std::int64_t to_fixed(double x) {
    return static_cast<std::int64_t>(std::floor(x * fixed_point + 0.5));
}
double from_fixed(std::int64_t x) {
    return static_cast<double>(x) / fixed_point;
}

std::vector<Vec2> line_from(Reach const& reach, int sign) {
    std::vector<Vec2> line = reach.line;
    if (sign < 0) {
        std::ranges::reverse(line);
    }
    return line;
}

Vec2 unit(Vec2 v) {
    double const m = norm(v);
    return m > 0.0 ? (1.0 / m) * v : Vec2{};
}

/// By branch at a node: how far it is opposite the others, minus the mean.
std::vector<double> opposed(std::vector<Vec2> const& out) {
    std::vector<double> result(out.size(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
        for (std::size_t j = 0; j < out.size(); ++j) {
            result[i] -= i == j ? 0.0 : std::clamp(dot(out[i], out[j]), -1.0, 1.0);
        }
        sum += result[i];
    }
    for (double& r : result) {
        r -= sum / static_cast<double>(out.size());
    }
    return result;
}

/// The lowest cell around a position.
double low_at(Raster<float> const& dem, Vec2 at) {
    Cell const c = dem.grid().cell_of(at);
    double low = std::numeric_limits<double>::infinity();
    for (std::int64_t row = c.row - 1; row <= c.row + 1; ++row) {
        for (std::int64_t col = c.col - 1; col <= c.col + 1; ++col) {
            if (dem.grid().contains({col, row}) && std::isfinite(dem[Cell{col, row}])) {
                low = std::min(low, static_cast<double>(dem[Cell{col, row}]));
            }
        }
    }
    return low;
}

} // namespace

ReachGraph reaches_of(Pieces const& p, std::vector<RiverLine> const& lines, Votes const& certain,
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

RootScores::Sums& RootScores::Sums::operator+=(Sums const& o) {
    shape += o.shape;
    climb += o.climb;
    drawn += o.drawn;
    certain += o.certain;
    return *this;
}
RootScores::Sums& RootScores::Sums::operator-=(Sums const& o) {
    shape -= o.shape;
    climb -= o.climb;
    drawn -= o.drawn;
    certain -= o.certain;
    return *this;
}

RootScores::RootScores(Pieces const& p, std::vector<RiverLine> const& lines, ReachGraph const& graph,
                       Votes const& certain, Raster<float> const* dem)
    : p_(p), graph_(graph), border_m_(border_distances(p, lines)), rise_m_(graph.reaches.size(), 0.0),
      exits_(graph.block_nodes.size(), 0), block_reaches_(graph.block_nodes.size(), 0), known_(p.nodes.size(), 0),
      inside_(p.nodes.size()), scratch_{std::vector<std::size_t>(p.nodes.size(), none),
                                        std::vector<double>(p.nodes.size(), std::numeric_limits<double>::infinity())} {
    measure_angles();
    if (dem != nullptr) {
        measure_heights(*dem);
    }
    measure_votes(certain, lines);
    sample();
    for (std::size_t k = 0; k < graph.reaches.size(); ++k) {
        Reach const& r = graph.reaches[k];
        if (r.from == r.to) {
            continue;
        }
        if (graph.is_bridge[k] != 0) {
            ++exits_[graph.block[r.from]];
            ++exits_[graph.block[r.to]];
        } else {
            ++block_reaches_[graph.block[r.from]];
        }
    }
}

void RootScores::measure_angles() {
    angle_.resize(graph_.at.size());
    double const scales[] = {std::max(near_scale * graph_.median_m, 2.0 * graph_.segment_m),
                             std::max(far_scale * graph_.median_m, 2.0 * graph_.segment_m)};
    for (std::size_t n = 0; n < graph_.at.size(); ++n) {
        auto const& ways = graph_.at[n];
        if (ways.size() < 3) {
            continue;
        }
        std::vector<Vec2> near;
        std::vector<Vec2> far;
        for (Way const& way : ways) {
            auto const line = line_from(graph_.reaches[way.reach], way.sign);
            near.push_back(unit(point_along(line, scales[0]) - line.front()));
            far.push_back(unit(point_along(line, scales[1]) - line.front()));
        }
        auto const of_near = opposed(near);
        auto const of_far = opposed(far);
        for (std::size_t i = 0; i < ways.size(); ++i) {
            angle_[n].push_back(near_weight * of_near[i] + far_weight * of_far[i] - split_weight * lines_split(n, i));
        }
    }
}

/// The lines drawn through a node that would run into it from both sides if its water left by a way.
double RootScores::lines_split(std::size_t node, std::size_t left_by) const {
    auto const& ways = graph_.at[node];
    auto const line_of = [&](Way const& way) {
        auto const& steps = graph_.reaches[way.reach].steps;
        return p_.pieces[way.sign > 0 ? steps.front().piece : steps.back().piece].line;
    };
    double lines = 0.0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        for (std::size_t j = i + 1; j < ways.size(); ++j) {
            lines += i != left_by && j != left_by && line_of(ways[i]) == line_of(ways[j]) ? 1.0 : 0.0;
        }
    }
    return lines;
}

void RootScores::measure_heights(Raster<float> const& dem) {
    for (std::size_t k = 0; k < graph_.reaches.size(); ++k) {
        Reach const& r = graph_.reaches[k];
        double const rise_m = low_at(dem, p_.nodes[r.to]) - low_at(dem, p_.nodes[r.from]);
        rise_m_[k] = std::isfinite(rise_m) ? std::clamp(rise_m, -most_climb_m, most_climb_m) : 0.0;
    }
}

/// A line that others meet on its way votes once, however many reaches that makes of it; one through a lake does not.
void RootScores::measure_votes(Votes const& certain, std::vector<RiverLine> const& lines) {
    std::vector<double> reaches_of_line(lines.size(), 0.0);
    for (Reach const& r : graph_.reaches) {
        std::vector<std::size_t> seen;
        for (auto const& [k, runs] : r.steps) {
            if (std::size_t const line = p_.pieces[k].line; std::ranges::find(seen, line) == seen.end()) {
                seen.push_back(line);
                reaches_of_line[line] += 1.0;
            }
        }
    }
    for (Reach const& r : graph_.reaches) {
        double drawn_m = 0.0;
        double vote_m = 0.0;
        double weight_m = 0.0;
        double certain_m = 0.0;
        double length_m = 0.0;
        for (auto const& [k, runs] : r.steps) {
            double const m = p_.pieces[k].length_m;
            double const share = 1.0 / reaches_of_line[p_.pieces[k].line];
            bool const is_drawn = lines[p_.pieces[k].line].feature != 0;
            length_m += m;
            certain_m += certain.empty() ? 0.0 : runs * certain[k] * m;
            if (!is_drawn) {
                continue;
            }
            drawn_m += runs * m;
            vote_m += runs * m * share;
            weight_m += m * share;
        }
        drawn_.push_back(drawn_m / length_m);
        vote_.push_back(vote_m / length_m);
        voters_.push_back(drawn_m == 0.0 ? 0.0 : weight_m / length_m);
        certain_.push_back(certain_m / length_m);
    }
}

void RootScores::sample() {
    constexpr double step = 0.25; // relative to the median reach
    constexpr double least = 2.0;
    constexpr double most = 20.0;
    double const side_m = free_reach * graph_.median_m;
    for (std::size_t k = 0; k < graph_.reaches.size(); ++k) {
        Reach const& r = graph_.reaches[k];
        double const count = std::clamp(std::floor(r.length_m / (step * graph_.median_m)), least, most);
        double const gap_m = r.length_m / (count - 1.0);
        double along_m = 0.0;
        double next_m = 0.0;
        auto const add = [&](Vec2 at) {
            samples_.push_back({static_cast<std::int64_t>(std::floor(at.x / side_m)),
                                static_cast<std::int64_t>(std::floor(at.y / side_m)), k, at});
        };
        for (std::size_t i = 1; i < r.line.size(); ++i) {
            double const m = distance(r.line[i - 1], r.line[i]);
            for (; next_m < along_m + m; next_m += gap_m) {
                add(r.line[i - 1] + ((next_m - along_m) / m) * (r.line[i] - r.line[i - 1]));
            }
            along_m += m;
        }
        add(r.line.back());
    }
    std::ranges::sort(samples_, {}, [](Sample const& s) { return std::tuple(s.col, s.row, s.reach, s.at.x, s.at.y); });
}

bool RootScores::is_free_ahead(std::size_t node) const {
    Way const& way = graph_.at[node].front();
    auto const line = line_from(graph_.reaches[way.reach], way.sign);
    Vec2 const at = line.front();
    Vec2 const ahead = unit(at - point_along(line, 0.5 * graph_.median_m));
    double const side_m = free_reach * graph_.median_m;
    auto const col = static_cast<std::int64_t>(std::floor(at.x / side_m));
    auto const row = static_cast<std::int64_t>(std::floor(at.y / side_m));
    for (std::int64_t c = col - 1; c <= col + 1; ++c) {
        auto const key = [](Sample const& s) { return std::pair(s.col, s.row); };
        auto const first = std::ranges::lower_bound(samples_, std::pair(c, row - 1), {}, key);
        for (auto s = first; s != samples_.end() && s->col == c && s->row <= row + 1; ++s) {
            Vec2 const to = s->at - at;
            double const m = norm(to);
            if (s->reach != way.reach && m <= side_m && dot(to, ahead) > 0.5 * m) {
                return false;
            }
        }
    }
    return true;
}

double RootScores::leaf_terms(std::size_t node, Vec2 low, Vec2 high) const {
    Vec2 const at = p_.nodes[node];
    double const own_m = std::min({at.x - low.x, high.x - at.x, at.y - low.y, high.y - at.y});
    return border_weight * portable::exp(-std::max(0.0, border_m_[node]) / graph_.median_m) +
           own_border_weight * portable::exp(-std::max(0.0, own_m) / graph_.median_m) +
           (graph_.at[node].size() == 1 && is_free_ahead(node) ? free_weight : 0.0);
}

double RootScores::angle(std::size_t node, std::size_t reach) const {
    auto const& of = angle_[node];
    for (std::size_t i = 0; i < of.size(); ++i) {
        if (graph_.at[node][i].reach == reach) {
            return of[i];
        }
    }
    return 0.0;
}

RootScores::Sums RootScores::along(std::size_t reach, int sign) const {
    Sums sums;
    sums.climb = to_fixed(-std::max(0.0, sign * rise_m_[reach]) / climb_per_unit);
    sums.drawn = graph_.is_bridge[reach] != 0 ? to_fixed(sign * vote_[reach]) : 0;
    sums.certain = graph_.is_bridge[reach] != 0 ? to_fixed(sign * certain_[reach]) : 0;
    return sums;
}

void RootScores::search(std::size_t from, bool in_block, Ways& ways, std::vector<std::size_t>& reached) const {
    using Entry = std::tuple<double, double, double, std::size_t>; // distance, position, node
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    auto const push = [&](std::size_t n) { queue.emplace(ways.way_m[n], p_.nodes[n].x, p_.nodes[n].y, n); };
    reached = {from};
    ways.way_m[from] = 0.0;
    ways.down[from] = none;
    push(from);
    while (!queue.empty()) {
        std::size_t const n = std::get<3>(queue.top());
        bool const is_old = std::get<0>(queue.top()) > ways.way_m[n];
        queue.pop();
        if (is_old) {
            continue;
        }
        for (Way const& way : graph_.at[n]) {
            double const m = ways.way_m[n] + graph_.reaches[way.reach].length_m;
            if ((in_block && graph_.is_bridge[way.reach] != 0) || !(m < ways.way_m[way.to])) {
                continue;
            }
            if (std::isinf(ways.way_m[way.to])) {
                reached.push_back(way.to);
            }
            ways.way_m[way.to] = m;
            ways.down[way.to] = way.reach;
            push(way.to);
        }
    }
}

/// The scores of a block whose water leaves at one of its nodes, without the angles there.
RootScores::Sums const& RootScores::inside(std::size_t exit) {
    // a braid with thousands of tributaries: its angles are uninformative
    constexpr std::size_t most_visits = 50'000'000;
    if (known_[exit] != 0) {
        return inside_[exit];
    }
    known_[exit] = 1;
    Sums& sums = inside_[exit];
    std::size_t const block = graph_.block[exit];
    if (graph_.block_nodes[block].size() < 2 || exits_[block] * block_reaches_[block] > most_visits) {
        return sums;
    }
    search(exit, true, scratch_, reached_);
    for (std::size_t const n : reached_) {
        if (n != exit) {
            sums.shape += to_fixed(angle(n, scratch_.down[n]));
        }
        for (Way const& way : graph_.at[n]) {
            if (way.sign > 0 && graph_.is_bridge[way.reach] == 0) {
                bool const is_way = scratch_.down[n] == way.reach;
                bool const is_back = !is_way && scratch_.down[way.to] == way.reach;
                bool const forth = is_way || (!is_back && scratch_.way_m[n] > scratch_.way_m[way.to]);
                sums += along(way.reach, forth ? 1 : -1);
            }
        }
    }
    for (std::size_t const n : reached_) {
        scratch_.way_m[n] = std::numeric_limits<double>::infinity();
        scratch_.down[n] = none;
    }
    return sums;
}

/// The scores of a block whose water leaves a node over a bridge.
RootScores::Sums RootScores::leaving(std::size_t node, std::size_t reach, int sign) {
    Sums sums = inside(node);
    sums += along(reach, sign);
    sums.shape += to_fixed(angle(node, reach));
    return sums;
}

std::vector<Root> RootScores::of(ReachGroup const& group) {
    struct Step {
        std::size_t block;
        std::size_t before; ///< index of the block from which it was reached
        std::size_t reach = none;
        std::size_t near = none; ///< end of the reach in that block
        std::size_t far = none;
        int sign = 0; ///< of the reach towards this block
    };
    std::vector<Step> order{{graph_.block[group.nodes.front()], none}};
    Sums first;
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t const n : graph_.block_nodes[order[i].block]) {
            for (Way const& way : graph_.at[n]) {
                if (graph_.is_bridge[way.reach] != 0 && way.reach != order[i].reach) {
                    order.push_back({graph_.block[way.to], i, way.reach, n, way.to, way.sign});
                    first += leaving(way.to, way.reach, -way.sign);
                }
            }
        }
    }
    std::vector<Sums> at{first}; // by index: scores of all other blocks if the root is in this one
    std::vector<std::pair<std::size_t, std::size_t>> place{{order.front().block, 0}};
    for (std::size_t i = 1; i < order.size(); ++i) {
        Step const& step = order[i];
        Sums sums = at[step.before];
        sums -= leaving(step.far, step.reach, -step.sign);
        sums += leaving(step.near, step.reach, step.sign);
        at.push_back(sums);
        place.emplace_back(step.block, i);
    }
    std::ranges::sort(place);

    std::vector<std::size_t> nodes;
    std::ranges::copy_if(group.nodes, std::back_inserter(nodes),
                         [&](std::size_t n) { return graph_.at[n].size() == 1 || graph_.is_outlet[n] != 0; });
    Vec2 low = p_.nodes[group.nodes.front()];
    Vec2 high = low;
    for (std::size_t const n : group.nodes) {
        low = {std::min(low.x, p_.nodes[n].x), std::min(low.y, p_.nodes[n].y)};
        high = {std::max(high.x, p_.nodes[n].x), std::max(high.y, p_.nodes[n].y)};
    }
    if (nodes.empty()) {
        constexpr std::size_t most = 64;
        nodes = group.nodes;
        std::ranges::stable_sort(nodes, {}, [&](std::size_t n) {
            Vec2 const v = p_.nodes[n];
            return std::min({v.x - low.x, high.x - v.x, v.y - low.y, high.y - v.y});
        });
        nodes.resize(std::min(nodes.size(), most));
    }
    std::vector<Root> roots;
    for (std::size_t const n : nodes) {
        auto const found = std::ranges::lower_bound(place, std::pair(graph_.block[n], std::size_t{0}));
        Sums sums = at[found->second];
        sums += inside(n);
        roots.push_back({n, from_fixed(sums.shape) + leaf_terms(n, low, high), from_fixed(sums.climb),
                         from_fixed(sums.drawn), from_fixed(sums.certain)});
    }
    return roots;
}

void RootScores::shortest_paths(std::size_t root, Ways& ways) const {
    ways.down.resize(p_.nodes.size(), none);
    ways.way_m.resize(p_.nodes.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> reached;
    search(root, false, ways, reached);
}

RootScores::Second RootScores::second_outlet(ReachGroup const& group, std::size_t root, double drawn_weight) {
    Second best{-1.0, none};
    if (group.reaches.size() + 1 != group.nodes.size()) {
        return best;
    }
    Vec2 low = p_.nodes[group.nodes.front()];
    Vec2 high = low;
    for (std::size_t const n : group.nodes) {
        low = {std::min(low.x, p_.nodes[n].x), std::min(low.y, p_.nodes[n].y)};
        high = {std::max(high.x, p_.nodes[n].x), std::max(high.y, p_.nodes[n].y)};
    }
    struct Visit {
        std::size_t node;
        Way down; ///< the reach downstream, as it leaves the node; unused for the root
    };
    std::vector<Visit> order{{root, {none, none, 0}}};
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (Way const& way : graph_.at[order[i].node]) {
            if (way.reach != order[i].down.reach) {
                order.push_back({way.to, {way.reach, order[i].node, -way.sign}});
            }
        }
    }
    // By node: the best outlet upstream if the node were cut off downstream.
    above_.resize(p_.nodes.size());
    for (std::size_t const n : group.nodes) {
        above_[n] = {-std::numeric_limits<double>::infinity(), none};
    }
    for (std::size_t i = order.size(); i-- > 1;) {
        auto const [n, down] = order[i];
        if (graph_.at[n].size() == 1) {
            above_[n] = {leaf_terms(n, low, high), n};
        } else {
            above_[n].gain -= angle(n, down.reach);
            best = above_[n].gain > best.gain ? above_[n] : best;
        }
        // Over the reach downstream: the gain of reversing it, with the node downstream draining up it.
        std::size_t const below = down.to;
        if (below == root) {
            continue;
        }
        Sums turned = along(down.reach, -down.sign);
        turned -= along(down.reach, down.sign);
        double const of_reach = from_fixed(turned.climb) + drawn_weight * from_fixed(turned.drawn);
        double const gain = above_[n].gain + of_reach + angle(below, down.reach);
        if (gain > above_[below].gain) {
            above_[below] = {gain, above_[n].outlet};
        }
    }
    return best;
}

} // namespace thalweg::network::import_steps
