// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/import/import_lines.hpp>

namespace thalweg::network {
namespace {

// Says where in the file it is that the segment ab of an arc, drawn downstream, rises from za to zb.
std::string uphill(RiverLines const& file, Vec2 a, Vec2 b, double za, double zb) {
    Vec2 const middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
    double least = INFINITY;
    RiverLine const* river = nullptr;
    std::size_t upper = 0; // vertices of the river, upstream first
    std::size_t lower = 0;
    for (auto const& line : file.lines) {
        for (std::size_t i = 0; i + 1 < line.vertices.size(); ++i) {
            auto const& p = line.vertices[i];
            auto const& q = line.vertices[i + 1];
            double const d = distance(middle, geometry::foot_on({p.x, p.y}, {q.x, q.y}, middle).at);
            if (d < least) {
                least = d;
                river = &line;
                bool const as_drawn = (q.x - p.x) * (b.x - a.x) + (q.y - p.y) * (b.y - a.y) >= 0.0;
                upper = as_drawn ? i : i + 1;
                lower = as_drawn ? i + 1 : i;
            }
        }
    }
    if (river == nullptr) {
        throw BadInput("network.take_file_heights: " + file.name + " holds no lines");
    }
    double const drawn_upper = river->vertices[upper].z;
    double const drawn_lower = river->vertices[lower].z;
    if (drawn_upper < drawn_lower) { // else it is the common height of rivers that meet which makes it rise
        za = drawn_upper;
        zb = drawn_lower;
    }
    bool const alike = fmt::format("{:.6g}", za) == fmt::format("{:.6g}", zb);
    auto const say = [&](double z) { return alike ? fmt::format("{}", z) : fmt::format("{:.6g}", z); };
    return fmt::format("river {} in {} runs uphill between vertex {} ({} m) and {} ({} m). Reverse the line, or leave "
                       "heights to [network] heights.",
                       river->feature, file.name, upper + 1, say(za), lower + 1, say(zb));
}

} // namespace

ElevatedNetwork take_file_heights(Imported const& imported, RiverLines const& file) {
    if (imported.arc_z.size() != imported.network.arc_count()) {
        throw BadInput("network.take_file_heights: the rivers of " + file.name +
                       " carry no heights; leave heights to [network] heights");
    }
    ElevatedNetwork raised{imported.network, std::vector<double>(imported.network.node_count(), 0.0), imported.arc_z};
    for (std::size_t i = 0; i < imported.network.arc_count(); ++i) {
        auto const& line = imported.network.arc(i).line;
        auto const& z = imported.arc_z[i];
        for (std::size_t v = 0; v + 1 < z.size(); ++v) {
            if (z[v] < z[v + 1]) {
                throw BadInput(uphill(file, line[v], line[v + 1], z[v], z[v + 1]));
            }
        }
        raised.node_z[imported.network.from(i)] = z.front();
        raised.node_z[imported.network.to(i)] = z.back();
    }
    return raised;
}

} // namespace thalweg::network
