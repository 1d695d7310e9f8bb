// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/file_values.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace thalweg::pipeline {

void add_pieces(std::vector<network::SplitPiece> const& pieces, std::vector<double>& us_area_m2,
                std::vector<double>& ds_area_m2) {
    for (network::SplitPiece const& piece : pieces) {
        double const trunk = piece.upstream ? ds_area_m2[piece.of] : us_area_m2[piece.of];
        double const moved = ds_area_m2[piece.moved];
        double const area = piece.upstream ? trunk + moved : std::max(trunk - moved, 0.0);
        us_area_m2.push_back(trunk < 0.0 || moved < 0.0 ? -1.0 : area);
        ds_area_m2.push_back(us_area_m2.back());
    }
}

std::vector<double> node_areas(StreamNetwork const& network, std::vector<double> const& us_area_m2,
                               std::vector<double> const& ds_area_m2) {
    std::vector<double> areas;
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (network.out(n) != no_arc) {
            areas.push_back(us_area_m2[network.out(n)]);
            continue;
        }
        double sum = 0.0;
        for (ArcId const a : network.in(n)) {
            double const area = ds_area_m2[a];
            sum = sum < 0.0 || area < 0.0 ? -1.0 : sum + area;
        }
        areas.push_back(sum);
    }
    return areas;
}

} // namespace thalweg::pipeline
