// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/main_stem.hpp>

#include <algorithm>

namespace thalweg::draw {

MainStem main_stem(StreamNetwork const& network, NetworkOrders const& orders) {
    MainStem stem;
    ArcId arc = no_arc;
    double longest = -1.0;
    for (std::size_t k = 0; k < network.arc_count() && k < orders.arc_basin.size(); ++k) {
        double const far = orders.arc_basin[k] > 0 ? orders.node_dist_out_m[network.from(k)] : -1.0;
        if (far > longest) {
            longest = far;
            arc = k;
        }
    }
    while (arc != no_arc) {
        std::vector<Vec2> const& line = network.arc(arc).line;
        bool const joins = !stem.line.empty() && !line.empty() && stem.line.back() == line.front();
        stem.line.insert(stem.line.end(), line.begin() + (joins ? 1 : 0), line.end());
        arc = network.out(network.to(arc));
    }
    std::reverse(stem.line.begin(), stem.line.end());
    stem.from_out_m.assign(stem.line.size(), 0.0);
    for (std::size_t i = 1; i < stem.line.size(); ++i) {
        stem.from_out_m[i] = stem.from_out_m[i - 1] + distance(stem.line[i - 1], stem.line[i]);
    }
    return stem;
}

} // namespace thalweg::draw
