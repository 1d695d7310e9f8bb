// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/edge.hpp>

#include <cmath>
#include <cstdint>
#include <functional>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>

namespace edge_test {

using namespace thalweg;

TEST(CutByEdge, ACellIsCutWhereAnyUpstreamOfItIsAtTheEdge) {
    ASSERT_TRUE(rc::check("by the definition", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(1, 15), *rc::gen::inRange<std::int64_t>(1, 15));
        bool const holes = *rc::gen::arbitrary<bool>();
        Raster<float> dem(grid);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::uint64_t const word = random_word(seed, static_cast<std::uint64_t>(i));
            dem[i] = holes && word % 13 == 0 ? std::nanf("") : static_cast<float>(word % 100);
        }
        flow::FlowField const drainage = flow::route(dem);
        Mask const cut = flow::cut_by_edge(drainage);
        auto const has_data = [&](Cell c) { return grid.contains(c) && !std::isnan(dem[c]); };
        std::function<bool(std::int64_t)> const is_cut = [&](std::int64_t i) {
            for (Cell const step : d8_steps) {
                Cell const c{grid.at(i).col + step.col, grid.at(i).row + step.row};
                if (!has_data(c) || (drainage.receiver(grid.index(c)) == i && is_cut(grid.index(c)))) {
                    return true;
                }
            }
            return false;
        };
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT((cut[i] != 0) == (!std::isnan(dem[i]) && is_cut(i)));
        }
    }));
}

} // namespace edge_test
