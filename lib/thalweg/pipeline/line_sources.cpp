// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/line_sources.hpp>

#include <bit>

namespace thalweg::pipeline {

namespace {

std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
    std::uint64_t const h = (a ^ (b * 0x9e3779b97f4a7c15ULL)) * 0xbf58476d1ce4e5b9ULL;
    return h ^ (h >> 29);
}

} // namespace

std::size_t LineSources::Hash::operator()(Vec2 p) const {
    return static_cast<std::size_t>(mix(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y)));
}

std::size_t LineSources::Hash::operator()(std::pair<Vec2, Vec2> const& segment) const {
    return static_cast<std::size_t>(mix((*this)(segment.first), (*this)(segment.second)));
}

LineSources::LineSources(StreamNetwork const& network, std::vector<std::vector<Stretch>> const& stretches) {
    NetworkIndex const index(network);
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        auto const& line = network[index.arcs[a]].line;
        auto const& own = stretches[a];
        double along_m = 0.0;
        std::size_t k = 0;
        for (std::size_t i = 1; i < line.size() && k < own.size(); ++i) {
            double const length_m = distance(line[i - 1], line[i]);
            double const middle_m = along_m + 0.5 * length_m;
            along_m += length_m;
            while (k + 1 < own.size() && middle_m > own[k].to_m) {
                ++k;
            }
            if (middle_m < own[k].from_m || middle_m > own[k].to_m + 1e-6 * length_m) {
                continue;
            }
            segments_[{line[i - 1], line[i]}] = own[k].feature;
            arriving_[line[i]] = own[k].feature;
        }
    }
}

std::vector<std::vector<Stretch>> LineSources::of(StreamNetwork const& network) const {
    std::vector<std::vector<Stretch>> result;
    for (ArcId const arc : NetworkIndex(network).arcs) {
        auto const& line = network[arc].line;
        auto& stretches = result.emplace_back();
        double along_m = 0.0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            double const from_m = along_m;
            along_m += distance(line[i - 1], line[i]);
            std::int64_t feature = 0;
            if (auto const known = segments_.find({line[i - 1], line[i]}); known != segments_.end()) {
                feature = known->second;
            } else if (i == 1) { // an arc that begins farther down
                auto const end = arriving_.find(line[i]);
                feature = end == arriving_.end() ? 0 : end->second;
            }
            if (feature == 0) {
                continue;
            }
            if (stretches.empty() || stretches.back().feature != feature || stretches.back().to_m != from_m) {
                stretches.push_back({feature, from_m, from_m});
            }
            stretches.back().to_m = along_m;
        }
    }
    return result;
}

LineSources LineSources::bent(StreamNetwork const& before, StreamNetwork const& after) const {
    auto stretches = of(before);
    NetworkIndex const was(before);
    NetworkIndex const is(after);
    for (std::size_t a = 0; a < stretches.size(); ++a) {
        double const share = is.length_m[a] / was.length_m[a];
        for (Stretch& s : stretches[a]) {
            s.from_m *= share;
            s.to_m *= share;
        }
    }
    return {after, stretches};
}

} // namespace thalweg::pipeline
