// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/frame.hpp>

#include <thalweg/core/run/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thalweg::pipeline {

namespace {

struct Vertex {
    double along = 0.0; ///< its coordinate on the axis that is looked at
    Vec3 at;
    std::int64_t feature = 0;
};

[[noreturn]] void refuse(Vertex const& stray, double gap_m, RiverLines const& lines) {
    throw BadInput(
        fmt::format("grid: river {} in {} has a vertex at ({:.1f}, {:.1f}), {:.0f} km from the others, so that "
                    "a grid around all would be empty for the most part: correct it, or set grid.width, "
                    "grid.height and grid.clip = true",
                    stray.feature, lines.name, stray.at.x, stray.at.y, gap_m / 1000.0));
}

/// Looks from the beginning of sorted vertices.
void look(std::vector<Vertex> const& sorted, RiverLines const& lines) {
    constexpr double times_as_far = 20.0;
    std::size_t const few = std::max<std::size_t>(2, sorted.size() / 100);
    for (std::size_t k = 1; k <= few; ++k) {
        double const gap = std::fabs(sorted[k].along - sorted[k - 1].along);
        double const others = std::fabs(sorted.back().along - sorted[k].along);
        if (others > 0.0 && gap > times_as_far * others) {
            refuse(sorted[k - 1], gap, lines);
        }
    }
}

} // namespace

void require_no_stray_vertex(RiverLines const& lines) {
    constexpr std::size_t fewest = 20;
    for (double Vec3::*const axis : {&Vec3::x, &Vec3::y}) {
        std::vector<Vertex> vertices;
        for (RiverLine const& line : lines.lines) {
            for (Vec3 const& v : line.vertices) {
                vertices.push_back({v.*axis, v, line.feature});
            }
        }
        if (vertices.size() < fewest) {
            return;
        }
        std::stable_sort(vertices.begin(), vertices.end(),
                         [](Vertex const& a, Vertex const& b) { return a.along < b.along; });
        look(vertices, lines);
        std::reverse(vertices.begin(), vertices.end());
        look(vertices, lines);
    }
}

} // namespace thalweg::pipeline
