// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace thalweg::network {

namespace {

struct Window {
    double west;
    double east;
    double south;
    double north;
    bool holds(Vec3 p) const { return p.x >= west && p.x <= east && p.y >= south && p.y <= north; }
};

/// The share [first, last] of segment a-b inside the box (Liang and Barsky 1984).
std::optional<std::pair<double, double>> inside(Vec3 a, Vec3 b, Window const& box) {
    double first = 0.0;
    double last = 1.0;
    double const dx = b.x - a.x;
    double const dy = b.y - a.y;
    std::array<std::pair<double, double>, 4> const sides = {
        {{-dx, a.x - box.west}, {dx, box.east - a.x}, {-dy, a.y - box.south}, {dy, box.north - a.y}}};
    for (auto const& [towards, room] : sides) {
        if (towards == 0.0) {
            if (room < 0.0) {
                return std::nullopt;
            }
        } else if (towards < 0.0) {
            first = std::max(first, room / towards);
        } else {
            last = std::min(last, room / towards);
        }
    }
    return first < last ? std::optional(std::pair(first, last)) : std::nullopt;
}

Vec3 on_edge(Vec3 a, Vec3 b, double share, Window const& box) {
    return {std::clamp(a.x + share * (b.x - a.x), box.west, box.east),
            std::clamp(a.y + share * (b.y - a.y), box.south, box.north), a.z + share * (b.z - a.z)};
}

} // namespace

RiverLines clip_lines(RiverLines const& lines, Grid const& grid) {
    Window const box{grid.west, grid.east(), grid.south(), grid.north};
    RiverLines out = lines;
    out.lines.clear();
    for (RiverLine const& line : lines.lines) {
        RiverLine piece = line;
        piece.vertices.clear();
        SecondaryLine beyond{line.feature, {}, "beyond the grid", line.feature, LeftOut::grid};
        auto const finish = [&] {
            if (piece.vertices.size() > 1) {
                out.lines.push_back(piece);
            }
            piece.vertices.clear();
        };
        auto const go_beyond = [&](Vec3 from, Vec3 to) {
            if (beyond.vertices.empty()) {
                beyond.vertices.push_back(from);
            }
            beyond.vertices.push_back(to);
        };
        auto const come_back = [&] {
            if (!beyond.vertices.empty()) {
                out.secondary.push_back(beyond);
            }
            beyond.vertices.clear();
        };
        for (std::size_t i = 1; i < line.vertices.size(); ++i) {
            Vec3 const a = line.vertices[i - 1];
            Vec3 const b = line.vertices[i];
            auto const part = inside(a, b, box);
            if (!part) {
                finish();
                go_beyond(a, b);
                continue;
            }
            Vec3 const entry = box.holds(a) ? a : on_edge(a, b, part->first, box);
            Vec3 const exit = box.holds(b) ? b : on_edge(a, b, part->second, box);
            if (!box.holds(a)) {
                go_beyond(a, entry);
            }
            come_back();
            if (piece.vertices.empty()) {
                piece.vertices.push_back(entry);
            }
            piece.vertices.push_back(exit);
            if (!box.holds(b)) {
                finish();
                go_beyond(exit, b);
            }
        }
        finish();
        come_back();
    }
    return out;
}

} // namespace thalweg::network
