// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/report.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace thalweg::pipeline {

std::string inflows_json(Grid const& grid, std::vector<surface::RegionInflow> inflows) {
    std::sort(inflows.begin(), inflows.end(), [](auto const& a, auto const& b) {
        return std::pair{-a.area_cells, a.cell} < std::pair{-b.area_cells, b.cell};
    });
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (surface::RegionInflow const& in : inflows) {
        Vec2 const at = grid.centre(grid.at(in.cell));
        array.push_back({{"x", at.x},
                         {"y", at.y},
                         {"area_km2", static_cast<double>(in.area_cells) * grid.cell_m * grid.cell_m * 1e-6}});
    }
    return array.dump();
}

} // namespace thalweg::pipeline
