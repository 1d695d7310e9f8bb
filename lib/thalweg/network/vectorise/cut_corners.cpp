// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/cut_corners.hpp>

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>

namespace thalweg::network {

namespace {

constexpr double of_cell = 1e-6; // centres of cells far from the origin are rounded

bool is_one(double step, double cell_m) {
    return std::fabs(std::fabs(step) - cell_m) <= of_cell * cell_m;
}

bool is_none(double step, double cell_m) {
    return std::fabs(step) <= of_cell * cell_m;
}

bool is_corner(Vec2 a, Vec2 b, Vec2 c, double cell_m) {
    bool const across = is_one(b.x - a.x, cell_m) && is_none(b.y - a.y, cell_m) && is_none(c.x - b.x, cell_m) &&
                        is_one(c.y - b.y, cell_m);
    bool const along = is_none(b.x - a.x, cell_m) && is_one(b.y - a.y, cell_m) && is_one(c.x - b.x, cell_m) &&
                       is_none(c.y - b.y, cell_m);
    return across || along;
}

} // namespace

StreamNetwork cut_corners(StreamNetwork const& network, double cell_m, Run const& run) {
    require_in("network.cut_corners", "cell", cell_m, Range::above(0.0), "m");
    NetworkDraft shorter = network.draft();
    for (DraftArc& drawn : shorter.arcs) {
        run.check();
        std::vector<Vec2>& line = drawn.arc.line;
        std::vector<Vec2> cut;
        for (std::size_t i = 0; i < line.size(); ++i) {
            bool const inner = !cut.empty() && i + 1 < line.size();
            if (!inner || !is_corner(cut.back(), line[i], line[i + 1], cell_m)) {
                cut.push_back(line[i]);
            }
        }
        line = std::move(cut);
    }
    return shorter;
}

} // namespace thalweg::network
