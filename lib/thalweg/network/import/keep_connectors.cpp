// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>
#include <queue>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>
#include <thalweg/network/import/prepare_lines.hpp>

namespace thalweg::network {
namespace {

using import_steps::plan_of;
using import_steps::Sets;

constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

/// Places by position, bit for bit.
class Places {
public:
    std::size_t add(Vec3 const& v) { return known_.try_emplace({v.x, v.y}, known_.size()).first->second; }
    std::size_t find(Vec3 const& v) const {
        auto const at = known_.find({v.x, v.y});
        return at == known_.end() ? nowhere : at->second;
    }
    std::size_t size() const { return known_.size(); }

private:
    std::map<std::pair<double, double>, std::size_t> known_;
};

/// Ends of lines, two per line.
std::vector<Vec2> ends_of(std::vector<RiverLine> const& lines) {
    std::vector<Vec2> ends;
    for (RiverLine const& line : lines) {
        ends.push_back(in_plan(line.vertices.front()));
        ends.push_back(in_plan(line.vertices.back()));
    }
    return ends;
}

/// Rivers in connected groups, and their ends.
struct Rivers {
    Sets groups; ///< of lines
    struct Sink {
        Vec3 at;
        std::size_t line;
    };
    std::vector<Sink> sinks;
};

Rivers rivers_in(std::vector<RiverLine> const& lines, double snap_m, Run const& run) {
    Rivers rivers{Sets(lines.size()), {}};
    Places places;
    std::vector<std::size_t> first_at; // by position: a line with it
    std::vector<char> inside;          // by position: whether a line passes through
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto const& v = lines[l].vertices;
        for (std::size_t i = 0; i < v.size(); ++i) {
            std::size_t const at = places.add(v[i]);
            if (at == first_at.size()) {
                first_at.push_back(l);
                inside.push_back(0);
            }
            rivers.groups.join(l, first_at[at]);
            inside[at] = inside[at] != 0 || (i > 0 && i + 1 < v.size()) ? 1 : 0;
        }
    }
    std::vector<Vec2> const ends = ends_of(lines);
    auto const near = geometry::segments_near(ends, plan_of(lines), snap_m, run);
    std::vector<char> meets(ends.size(), 0); // something other than an end at the same position, within snap_m
    for (std::size_t e = 0; e < ends.size(); ++e) {
        for (geometry::NearSegment const& s : near[e]) {
            if (s.line != e / 2) {
                rivers.groups.join(e / 2, s.line);
                auto const& v = lines[s.line].vertices;
                bool const at_end =
                    distance(in_plan(v.front()), ends[e]) <= snap_m || distance(in_plan(v.back()), ends[e]) <= snap_m;
                meets[e] = meets[e] != 0 || !at_end ? 1 : 0;
            }
        }
    }
    // The direction of lines: 1: as drawn.
    std::vector<int> runs(lines.size(), 1);
    std::vector<char> by_height(lines.size(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        double const fall = lines[l].vertices.front().z - lines[l].vertices.back().z;
        by_height[l] = fall > 0.0 || fall < 0.0 ? 1 : 0;
        runs[l] = fall < 0.0 ? -1 : 1;
    }
    std::vector<int> leaving(places.size(), 0);
    std::vector<int> arriving(places.size(), 0);
    auto const count = [&] {
        std::ranges::fill(leaving, 0);
        std::ranges::fill(arriving, 0);
        for (std::size_t l = 0; l < lines.size(); ++l) {
            auto const& v = lines[l].vertices;
            ++leaving[places.find(runs[l] > 0 ? v.front() : v.back())];
            ++arriving[places.find(runs[l] > 0 ? v.back() : v.front())];
        }
    };
    count();
    std::vector<int> more_ends(lines.size(), 0); // by group: ends minus sources
    for (std::size_t at = 0; at < places.size(); ++at) {
        int& of_group = more_ends[rivers.groups.of(first_at[at])];
        of_group += inside[at] == 0 && arriving[at] > 0 && leaving[at] == 0 ? 1 : 0;
        of_group -= inside[at] == 0 && arriving[at] == 0 && leaving[at] > 0 ? 1 : 0;
    }
    // decides if a group's own count does not
    int const in_all = std::accumulate(more_ends.begin(), more_ends.end(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        int const of_group = more_ends[rivers.groups.of(l)];
        if (by_height[l] == 0 && (of_group > 0 || (of_group == 0 && in_all > 0))) {
            runs[l] = -1;
        }
    }
    count();
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto const& v = lines[l].vertices;
        Vec3 const& end = runs[l] > 0 ? v.back() : v.front();
        std::size_t const at = places.find(end);
        if (leaving[at] == 0 && inside[at] == 0 && meets[2 * l + (runs[l] > 0 ? 1 : 0)] == 0) {
            rivers.sinks.push_back({end, l});
        }
    }
    return rivers;
}

/// Artificial channels as a graph of their vertices.
class ChannelGraph {
public:
    ChannelGraph(std::vector<RiverLine> const& channels, std::vector<RiverLine> const& rivers, double snap_m,
                 Run const& run)
        : lines_(channels) {
        for (std::size_t l = 0; l < channels.size(); ++l) {
            auto const& v = channels[l].vertices;
            for (std::size_t i = 0; i < v.size(); ++i) {
                std::size_t const at = add(v[i]);
                if (i > 0) {
                    std::size_t const before = places_.find(v[i - 1]);
                    double const length_m = distance(in_plan(v[i - 1]), in_plan(v[i]));
                    edges_[before].push_back({at, l, i - 1, length_m});
                    edges_[at].push_back({before, l, i - 1, against_drawn * length_m});
                }
            }
        }
        // Ends that nearly meet another channel, then those that nearly meet a river.
        std::vector<Vec2> const ends = ends_of(channels);
        auto const near = geometry::segments_near(ends, plan_of(channels), snap_m, run);
        for (std::size_t e = 0; e < ends.size(); ++e) {
            std::size_t const own = end(e);
            for (geometry::NearSegment const& s : near[e]) {
                for (std::size_t const v : {s.segment, s.segment + 1}) {
                    std::size_t const other = places_.find(channels[s.line].vertices[v]);
                    if (other != own && distance(at_[other], ends[e]) <= snap_m) {
                        edges_[own].push_back({other, nowhere, 0, 0.0});
                        edges_[other].push_back({own, nowhere, 0, 0.0});
                    }
                }
            }
        }
        auto const rivers_near = geometry::segments_near(ends, plan_of(rivers), snap_m, run);
        for (std::size_t e = 0; e < ends.size(); ++e) {
            for (geometry::NearSegment const& s : rivers_near[e]) {
                rivers_at_[end(e)].push_back(s.line);
            }
        }
        for (std::size_t l = 0; l < rivers.size(); ++l) {
            for (Vec3 const& v : rivers[l].vertices) {
                if (std::size_t const at = places_.find(v); at != nowhere) {
                    rivers_at_[at].push_back(l);
                }
            }
        }
        auto const back = geometry::segments_near(ends_of(rivers), plan_of(channels), snap_m, run);
        for (std::size_t e = 0; e < back.size(); ++e) {
            Vec3 const& of = e % 2 == 0 ? rivers[e / 2].vertices.front() : rivers[e / 2].vertices.back();
            if (std::size_t const at = nearest(of, back[e], snap_m); at != nowhere) {
                rivers_at_[at].push_back(e / 2);
                by_end_[{of.x, of.y}] = at;
            }
        }
    }

    /// The segments from the end of a river to another group; none: there is no path.
    std::vector<std::pair<std::size_t, std::size_t>> path_to_other_group(Vec3 const& from, std::size_t own,
                                                                         Sets& groups, std::size_t& into) const {
        auto const begin = by_end_.find({from.x, from.y});
        if (begin == by_end_.end()) {
            return {};
        }
        struct Reached {
            double cost = std::numeric_limits<double>::infinity();
            std::size_t before = nowhere;
            std::pair<std::size_t, std::size_t> by = {nowhere, 0};
        };
        std::map<std::size_t, Reached> reached;
        std::priority_queue<std::pair<double, std::size_t>, std::vector<std::pair<double, std::size_t>>, std::greater<>>
            queue;
        reached[begin->second].cost = 0.0;
        queue.emplace(0.0, begin->second);
        while (!queue.empty()) {
            auto const [cost, at] = queue.top();
            queue.pop();
            if (cost > reached[at].cost) {
                continue;
            }
            auto const other = std::ranges::find_if(
                rivers_at_[at], [&](std::size_t river) { return groups.of(river) != groups.of(own); });
            if (other != rivers_at_[at].end()) {
                into = *other;
                std::vector<std::pair<std::size_t, std::size_t>> way;
                for (std::size_t n = at; n != nowhere; n = reached[n].before) {
                    if (reached[n].by.first != nowhere) {
                        way.push_back(reached[n].by);
                    }
                }
                return way;
            }
            for (Edge const& edge : edges_[at]) {
                Reached& next = reached[edge.to];
                if (cost + edge.cost < next.cost) {
                    next = {cost + edge.cost, at, {edge.line, edge.segment}};
                    queue.emplace(next.cost, edge.to);
                }
            }
        }
        return {};
    }

private:
    static constexpr double against_drawn = 3.0;
    struct Edge {
        std::size_t to;
        std::size_t line;
        std::size_t segment;
        double cost;
    };

    std::size_t add(Vec3 const& v) {
        std::size_t const at = places_.add(v);
        if (at == at_.size()) {
            at_.push_back(in_plan(v));
            edges_.emplace_back();
            rivers_at_.emplace_back();
        }
        return at;
    }
    std::size_t end(std::size_t e) const {
        auto const& v = lines_[e / 2].vertices;
        return places_.find(e % 2 == 0 ? v.front() : v.back());
    }
    std::size_t nearest(Vec3 const& of, std::vector<geometry::NearSegment> const& near, double snap_m) const {
        std::size_t best = places_.find(of);
        double best_m = best == nowhere ? snap_m : 0.0;
        for (geometry::NearSegment const& s : near) {
            for (std::size_t const v : {s.segment, s.segment + 1}) {
                Vec3 const& vertex = lines_[s.line].vertices[v];
                double const m = distance(in_plan(vertex), in_plan(of));
                if (m < best_m || (best == nowhere && m <= best_m)) {
                    best = places_.find(vertex);
                    best_m = m;
                }
            }
        }
        return best;
    }

    std::vector<RiverLine> const& lines_;
    Places places_;
    std::vector<Vec2> at_;
    std::vector<std::vector<Edge>> edges_;
    std::vector<std::vector<std::size_t>> rivers_at_;         ///< by position: lines of rivers that touch it
    std::map<std::pair<double, double>, std::size_t> by_end_; ///< where a river's end meets a channel
};

} // namespace

RiverLines keep_connectors(RiverLines rivers, double snap_m, Run const& run) {
    std::vector<RiverLine> const channels = std::exchange(rivers.channels, {});
    if (channels.empty()) {
        return rivers;
    }
    constexpr std::int64_t nobody = std::numeric_limits<std::int64_t>::min();
    std::vector<std::vector<std::int64_t>> needed_by(channels.size()); // by segment: the river that ends there
    for (std::size_t l = 0; l < channels.size(); ++l) {
        needed_by[l].assign(channels[l].vertices.size() - 1, nobody);
    }
    if (!rivers.lines.empty()) {
        double const near_m = snap_m > 0.0 ? snap_m : 1e-6 * import_steps::diagonal_of(rivers.lines);
        Rivers found = rivers_in(rivers.lines, near_m, run);
        ChannelGraph const graph(channels, rivers.lines, near_m, run);
        for (Rivers::Sink const& sink : found.sinks) {
            run.check();
            std::size_t into = nowhere;
            for (auto const& [line, segment] : graph.path_to_other_group(sink.at, sink.line, found.groups, into)) {
                needed_by[line][segment] = rivers.lines[sink.line].number();
            }
            if (into != nowhere) {
                found.groups.join(sink.line, into);
            }
        }
    }
    for (std::size_t l = 0; l < channels.size(); ++l) {
        RiverLine const& channel = channels[l];
        for (std::size_t first = 0; first < needed_by[l].size();) {
            std::size_t last = first;
            auto const is_needed = [&](std::size_t segment) { return needed_by[l][segment] != nobody; };
            while (last + 1 < needed_by[l].size() && is_needed(last + 1) == is_needed(first)) {
                ++last;
            }
            std::vector<Vec3> part(channel.vertices.begin() + static_cast<std::ptrdiff_t>(first),
                                   channel.vertices.begin() + static_cast<std::ptrdiff_t>(last) + 2);
            if (is_needed(first)) {
                double const length_m = length_in_plan(part);
                rivers.findings.push_back(
                    {"connector", channel.number(), in_plan(part.front()), length_m,
                     fmt::format("line {} ({}) is kept for {:.6g} m: river {} continues through it", channel.number(),
                                 channel.artificial, length_m, needed_by[l][first])});
                RiverLine& kept = rivers.lines.emplace_back(channel);
                kept.vertices = std::move(part);
                rivers.has_z =
                    rivers.has_z && std::ranges::none_of(kept.vertices, [](Vec3 const& v) { return std::isnan(v.z); });
            } else {
                rivers.secondary.push_back(
                    {channel.feature, std::move(part), channel.artificial, channel.feature, LeftOut::filter});
            }
            first = last + 1;
        }
    }
    return rivers;
}

} // namespace thalweg::network
