// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/link_lengths.hpp>

#include <algorithm>

#include <thalweg/measure/laws/internal/mean_and_deviation.hpp>

namespace thalweg::measure {

namespace {

LengthSpread spread_of(std::vector<double> lengths) {
    LengthSpread spread;
    spread.links = static_cast<std::int64_t>(lengths.size());
    if (lengths.empty()) {
        return spread;
    }
    auto const [mean, deviation] = mean_and_deviation(lengths);
    spread.mean_m = mean;
    spread.cv = deviation / mean;
    std::sort(lengths.begin(), lengths.end());
    std::size_t const middle = lengths.size() / 2;
    spread.median_m =
        lengths.size() % 2 == 1 ? lengths[middle] : lengths[middle - 1] + 0.5 * (lengths[middle] - lengths[middle - 1]);
    return spread;
}

} // namespace

LinkLengths link_lengths(StreamNetwork const& network) {
    std::vector<double> exterior;
    std::vector<double> interior;
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        std::size_t const above = network.in(network.from(a)).size();
        if (above == 1) {
            continue;
        }
        double length = network.length_m(a);
        for (NodeId at = network.to(a); network.in(at).size() == 1 && network.out(at) != no_arc;) {
            auto const next = network.out(at);
            length += network.length_m(next);
            at = network.to(next);
        }
        (above == 0 ? exterior : interior).push_back(length);
    }
    LinkLengths lengths{spread_of(std::move(exterior)), spread_of(std::move(interior)), std::nullopt};
    if (lengths.exterior.links > 0 && lengths.interior.links > 0 && lengths.interior.mean_m > 0.0) {
        lengths.ratio = lengths.exterior.mean_m / lengths.interior.mean_m;
    }
    return lengths;
}

} // namespace thalweg::measure
