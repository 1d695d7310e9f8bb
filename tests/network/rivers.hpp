// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <thalweg/core/river_files.hpp>

/// Rivers as a file gives them.
namespace test {

using namespace thalweg;

/// Lines with these vertices, numbered from 1.
inline RiverLines lines_of(std::vector<std::vector<Vec3>> const& drawn, std::string const& name = "rivers.gpkg") {
    RiverLines lines;
    lines.name = name;
    for (auto const& vertices : drawn) {
        lines.lines.push_back({static_cast<std::int64_t>(lines.lines.size()) + 1, vertices, "", 0});
    }
    return lines;
}

/// The same without heights.
inline RiverLines flats(std::vector<std::vector<Vec2>> const& plans) {
    std::vector<std::vector<Vec3>> drawn;
    for (auto const& plan : plans) {
        auto& vertices = drawn.emplace_back();
        for (Vec2 const p : plan) {
            vertices.push_back({p.x, p.y, std::numeric_limits<double>::quiet_NaN()});
        }
    }
    return lines_of(drawn);
}

} // namespace test
