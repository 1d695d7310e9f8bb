// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/line_sources.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <unordered_set>

namespace thalweg::make {

namespace {

std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
    std::uint64_t const h = (a ^ (b * 0x9e3779b97f4a7c15ULL)) * 0xbf58476d1ce4e5b9ULL;
    return h ^ (h >> 29);
}

constexpr std::int64_t several = -1;

/// features: by segment; 0: none.
std::vector<Stretch> stretches_of(std::vector<Vec2> const& line, std::vector<std::int64_t> const& features) {
    std::vector<Stretch> stretches;
    double along_m = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        double const from_m = along_m;
        along_m += distance(line[i - 1], line[i]);
        std::int64_t const feature = features[i - 1];
        if (feature <= 0) {
            continue;
        }
        if (stretches.empty() || stretches.back().feature != feature || stretches.back().to_m != from_m) {
            stretches.push_back({feature, from_m, from_m});
        }
        stretches.back().to_m = along_m;
    }
    return stretches;
}

} // namespace

std::size_t LineSources::Hash::operator()(Vec2 p) const {
    return static_cast<std::size_t>(mix(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y)));
}

std::size_t LineSources::Hash::operator()(std::pair<Vec2, Vec2> const& segment) const {
    return static_cast<std::size_t>(mix((*this)(segment.first), (*this)(segment.second)));
}

LineSources::LineSources(StreamNetwork const& network, std::vector<std::vector<Stretch>> const& stretches) {
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        auto const& line = network.arc(a).line;
        auto const& own = stretches[a];
        double along_m = 0.0;
        std::size_t k = 0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const length_m = distance(line[i - 1], line[i]);
            double const middle_m = along_m + 0.5 * length_m;
            along_m += length_m;
            while (k + 1 < own.size() && middle_m > own[k].to_m) {
                ++k;
            }
            bool const is_known =
                k < own.size() && middle_m >= own[k].from_m && middle_m <= own[k].to_m + 1e-6 * length_m;
            std::int64_t const feature = is_known ? own[k].feature : 0;
            segments_[{line[i - 1], line[i]}] = feature;
            leaving_[line[i - 1]] = feature;
            auto const [end, is_first] = arriving_.try_emplace(line[i], feature);
            end->second = is_first || end->second == feature ? feature : several;
            knows_any_ = knows_any_ || is_known;
        }
    }
}

std::vector<std::vector<Stretch>> LineSources::of(StreamNetwork const& network) const {
    std::vector<std::vector<Stretch>> result;
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        auto const& line = network.arc(arc).line;
        std::vector<std::int64_t> features;
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (auto const known = segments_.find({line[i - 1], line[i]}); known != segments_.end()) {
                features.push_back(known->second);
            } else { // an arc may begin farther downstream, unless it is the terrain's own
                bool const is_cut = i == 1 && network.arc(arc).feature > 0 && arriving_.contains(line[i]);
                features.push_back(is_cut ? replaced(network.arc(arc), i) : 0);
            }
        }
        result.push_back(stretches_of(line, features));
    }
    return result;
}

double LineSources::length_m(StreamNetwork const& network) const {
    double sum = 0.0;
    for (std::vector<Stretch> const& of_arc : of(network)) {
        for (Stretch const& s : of_arc) {
            sum += s.to_m - s.from_m;
        }
    }
    return sum;
}

std::vector<std::vector<Stretch>> LineSources::redrawn(StreamNetwork const& network) const {
    std::vector<std::vector<Stretch>> result;
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        auto const& line = network.arc(arc).line;
        std::vector<std::int64_t> features;
        std::size_t unknown = 0; // at the beginning
        for (std::size_t i = 1; i < line.size(); ++i) {
            auto const known = segments_.find({line[i - 1], line[i]});
            bool const is_known =
                known != segments_.end() || arriving_.contains(line[i]) || leaving_.contains(line[i - 1]);
            unknown += !is_known && unknown + 1 == i ? 1U : 0U;
            features.push_back(known != segments_.end() ? known->second
                               : is_known               ? replaced(network.arc(arc), i)
                               : features.empty()       ? network.arc(arc).feature
                                                        : features.back());
        }
        if (unknown < features.size()) {
            std::fill_n(features.begin(), unknown, features[unknown]);
        }
        result.push_back(stretches_of(line, features));
    }
    return result;
}

/// The feature of a segment that is part of a former one, or connects the same points; 0: none.
std::int64_t LineSources::replaced(Arc const& arc, std::size_t segment) const {
    if (arc.feature <= 0) {
        return 0;
    }
    if (auto const end = arriving_.find(arc.line[segment]); end != arriving_.end()) {
        return end->second == several ? arc.feature : end->second;
    }
    auto const begin = leaving_.find(arc.line[segment - 1]);
    return begin == leaving_.end() ? 0 : begin->second;
}

std::vector<SecondaryLine> LineSources::missing(StreamNetwork const& before, StreamNetwork const& after, LeftOut cause,
                                                std::string const& reason) const {
    std::unordered_set<Vec2, Hash> remembered;
    for (Arc const& arc : before.arcs()) {
        remembered.insert(arc.line.begin(), arc.line.end());
    }
    std::unordered_map<Vec2, Vec2, Hash> next;
    for (Arc const& arc : after.arcs()) {
        for (std::size_t i = 1; i < arc.line.size(); ++i) {
            next.try_emplace(arc.line[i - 1], arc.line[i]);
        }
    }
    // The former vertex downstream of a position; the position itself: there is none.
    auto const below = [&](Vec2 const p) {
        for (auto step = next.find(p); step != next.end(); step = next.find(step->second)) {
            if (remembered.contains(step->second)) {
                return step->second;
            }
        }
        return p;
    };
    std::unordered_multimap<Vec2, Vec2, Hash> heads; // where arcs begin within a segment, by its lower end
    for (Arc const& arc : after.arcs()) {
        if (!remembered.contains(arc.line.front())) {
            heads.emplace(below(arc.line.front()), arc.line.front());
        }
    }
    std::vector<SecondaryLine> gone;
    SecondaryLine one{0, {}, reason, 0, cause};
    auto const finish = [&] {
        if (!one.vertices.empty()) {
            one.record = one.feature;
            gone.push_back(one);
            one.vertices.clear();
        }
    };
    auto const add = [&](std::int64_t feature, Vec2 from, Vec2 to) {
        if (one.feature != feature) {
            finish();
        }
        one.feature = feature;
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        if (one.vertices.empty()) {
            one.vertices.push_back({from.x, from.y, none});
        }
        one.vertices.push_back({to.x, to.y, none});
    };
    for (Arc const& arc : before.arcs()) {
        for (std::size_t i = 1; i < arc.line.size(); ++i) {
            Vec2 const p = arc.line[i - 1];
            Vec2 const q = arc.line[i];
            auto const known = segments_.find({p, q});
            if (known == segments_.end() || known->second <= 0 || below(p) == q) {
                finish();
                continue;
            }
            auto const [first, last] = heads.equal_range(q);
            auto const begins = std::find_if(first, last, [&](auto const& head) {
                return distance(p, head.second) + distance(head.second, q) <= distance(p, q) + 1e-6;
            });
            add(known->second, p, begins == last ? q : begins->second);
            if (begins != last) {
                finish();
            }
        }
        finish();
    }
    return gone;
}

LineSources LineSources::bent(StreamNetwork const& before, StreamNetwork const& after) const {
    if (!knows_any_) { // a record of nothing takes as much memory as another
        return {};
    }
    auto stretches = of(before);
    for (std::size_t a = 0; a < stretches.size(); ++a) {
        double const share = after.length_m(a) / before.length_m(a);
        for (Stretch& s : stretches[a]) {
            s.from_m *= share;
            s.to_m *= share;
        }
    }
    return {after, stretches};
}

} // namespace thalweg::make
