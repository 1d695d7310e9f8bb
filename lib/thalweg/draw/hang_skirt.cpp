// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/wireframe_model.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace thalweg::draw {
namespace {

/// How high the land nearer to the viewer than a place stands in its column of the sheet.
double cover_before(Net const& net, Feet const& feet, Foot const& place) {
    double cover = -std::numeric_limits<double>::infinity();
    auto const ask = [&](KnotId a, KnotId b) {
        Vec2 const from = net.at[a];
        Vec2 const to = net.at[b];
        double const share = (place.at.x - from.x) / (to.x - from.x);
        // Sides that end in the knot above cover nothing; between two knots the share is never a hair from the ends.
        if (share > 1e-9 && share < 1.0 - 1e-9 && std::isfinite(from.y) && std::isfinite(to.y) &&
            feet[a].depth + (feet[b].depth - feet[a].depth) * share < place.depth - 1e-9 * std::fabs(place.depth)) {
            cover = std::max(cover, from.y + (to.y - from.y) * share);
        }
    };
    for (KnotId i = 0; i < net.at.count(); ++i) {
        if ((i + 1) % net.columns != 0) {
            ask(i, i + 1);
        }
        if (i + net.columns < net.at.count()) {
            ask(i, i + net.columns);
        }
    }
    return cover;
}

} // namespace

void hang_skirt(Model& model, Feet const& feet) {
    Net const& net = model.net;
    auto const has = [&](std::int64_t col, std::int64_t row) {
        return col >= 0 && row >= 0 && col < net.columns && row < net.rows && std::isfinite(net.knot(col, row).y);
    };
    auto const has_mesh = [&](std::int64_t col, std::int64_t row) { // by its knot of lowest column and row
        return has(col, row) && has(col + 1, row) && has(col, row + 1) && has(col + 1, row + 1);
    };
    Indexed<KnotId, std::int8_t> hung(net.at.size(), 0); // 1: seen down to the base, 2: covered there
    auto const hang = [&](std::int64_t col, std::int64_t row) {
        KnotId const knot = row * net.columns + col;
        if (hung[knot] == 0) {
            double const down_to = std::max(feet[knot].at.y, cover_before(net, feet, feet[knot]));
            Vec2 const top = net.at[knot];
            if (down_to < top.y) {
                model.skirt.push_back({top, Vec2{top.x, down_to}});
            }
            hung[knot] = down_to > feet[knot].at.y ? 2 : 1;
        }
        return hung[knot] == 1;
    };
    auto const hang_side = [&](std::int64_t col, std::int64_t row, std::int64_t next_col, std::int64_t next_row) {
        bool const first = hang(col, row);
        bool const second = hang(next_col, next_row);
        Foot const& from = feet[row * net.columns + col];
        Foot const& to = feet[next_row * net.columns + next_col];
        if (first && second) {
            model.bottom.push_back({from.at, to.at});
            return;
        }
        constexpr int parts = 12; // of a line that is partly covered
        auto const at = [&](double share) {
            return Foot{{from.at.x + (to.at.x - from.at.x) * share, from.at.y + (to.at.y - from.at.y) * share},
                        from.depth + (to.depth - from.depth) * share};
        };
        for (int k = 0; k < parts; ++k) {
            Foot const middle = at((k + 0.5) / parts);
            if (cover_before(net, feet, middle) < middle.at.y) {
                model.bottom.push_back({at(static_cast<double>(k) / parts).at, at((k + 1.0) / parts).at});
            }
        }
    };
    for (std::int64_t row = 0; row < net.rows; ++row) {
        for (std::int64_t col = 0; col < net.columns; ++col) {
            std::int64_t const above = net.away_row > 0 ? row : row - 1; // the mesh behind a side along the row
            std::int64_t const before = net.away_row > 0 ? row - 1 : row;
            if (has_mesh(col, above) && !has_mesh(col, before)) {
                hang_side(col, row, col + 1, row);
            }
            std::int64_t const behind = net.away_col > 0 ? col : col - 1;
            std::int64_t const in_front = net.away_col > 0 ? col - 1 : col;
            if (has_mesh(behind, row) && !has_mesh(in_front, row)) {
                hang_side(col, row, col, row + 1);
            }
        }
    }
}

} // namespace thalweg::draw
