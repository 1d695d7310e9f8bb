// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/split_areas.hpp>

#include <algorithm>

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

} // namespace thalweg::pipeline
