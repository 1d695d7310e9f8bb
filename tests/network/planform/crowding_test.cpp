// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/crowding.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/geometry/segment_grid.hpp>

namespace crowding_test {

using namespace thalweg;
using network::Crowding;
using network::Gap;
using network::Stems;

namespace {

/// By the definition: every point against every segment.
std::vector<std::size_t> too_near(Stems const& stems, std::vector<Vec2> const& was, std::vector<Vec2> const& is,
                                  Grid const& grid, Mask const& land, Gap const& gap) {
    auto const inside = [&](Vec2 p) {
        return std::min({p.x - grid.west, grid.east() - p.x, grid.north - p.y, p.y - grid.south()});
    };
    double const gap_m2 = gap.gap_m * gap.gap_m;
    std::set<std::size_t> found;
    for (std::size_t i = 0; i < is.size(); ++i) {
        if (inside(is[i]) < std::min(grid.cell_m, inside(was[i]))) {
            found.insert(i);
        }
        if (leaves_land(stems, is, i, land) && !leaves_land(stems, was, i, land)) {
            found.insert({i, std::min(i + 1, is.size() - 1)});
        }
        for (std::size_t j = 0; j + 1 < is.size(); ++j) {
            if (stems.stem_of[j] != stems.stem_of[j + 1] || j == i || j + 1 == i ||
                (stems.stem_of[i] == stems.stem_of[j] && std::fabs(stems.way_m[i] - stems.way_m[j]) < gap.along_m)) {
                continue;
            }
            double const now = geometry::squared_distance(is[i], {is[j], is[j + 1]});
            double const before = geometry::squared_distance(was[i], {was[j], was[j + 1]});
            if (now < (before >= gap_m2 ? gap_m2 : 0.6 * 0.6 * before)) {
                found.insert({i, j});
            }
        }
    }
    return {found.begin(), found.end()};
}

} // namespace

TEST(Crowding, LooksOnlyWhereSomethingMovedAndFindsAll) {
    ASSERT_TRUE(rc::check("as every point against every segment, round by round", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net =
            *rc::gen::arbitrary<bool>() ? test::random_skeleton(seed, 16) : test::random_forest(seed, 8, 2);
        RC_PRE(net.arc_count() > 0U);
        bool const is_skeleton = net.node(0).at.x < 100.0 && net.node(net.node_count() - 1).at.x < 100.0;
        Grid grid = test::frame(32, 32);
        grid.cell_m = is_skeleton ? 1.0 : 34.0;
        grid.west = -2.0 * grid.cell_m;
        grid.north = 29.0 * grid.cell_m;
        Mask land;
        if (*rc::gen::arbitrary<bool>()) {
            land = test::raster_of<std::uint8_t>(grid, [&](Cell c) {
                return random_word(seed, 5, static_cast<std::uint64_t>(grid.index(c))) % 8 != 0 ? 1 : 0;
            });
        }
        std::vector<double> const areas(net.arc_count(), 1.0);
        Stems const stems = network::stems_of(net, areas, grid.cell_m);
        double const along_m = *rc::gen::element(0.0, 8.0) * grid.cell_m;
        Gap const gap{*rc::gen::element(0.5, 1.3, 3.0) * grid.cell_m, along_m};
        auto const often = *rc::gen::element<std::uint64_t>(2, 10, 100);
        RandomStream words(seed, 4, 0);
        Crowding crowding(stems, stems.at, grid, land, gap);
        std::vector<Vec2> is = stems.at;
        for (int round = 0; round < 5; ++round) {
            for (std::size_t i = 0; i < is.size(); ++i) {
                if (round > 0 && words.word() % often != 0) {
                    continue;
                }
                Vec2 const by{words.real() - 0.5, words.real() - 0.5};
                double const far = (words.word() % 8 == 0 ? 20.0 : 3.0) * grid.cell_m;
                is[i] = words.word() % 4 == 0 ? stems.at[i] : stems.at[i] + far * by;
            }
            RC_ASSERT(crowding.points(is) == too_near(stems, stems.at, is, grid, land, gap));
        }
    }));
}

} // namespace crowding_test
