// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/dla/grow_dla.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace pick_branch_test {

using namespace thalweg::network;
using thalweg::BadInput;
using thalweg::BadParameter;
using thalweg::Cell;

namespace {

/// A cross with two cells to the north, three to the east, two to the south and none to the west.
Cluster cross() {
    Cluster c;
    c.cells = {{0, 0}, {0, -1}, {1, 0}, {0, 1}, {2, 0}, {0, -2}, {0, 2}, {3, 0}};
    c.parent = {-1, 0, 0, 0, 2, 1, 3, 4};
    return c;
}

Cluster grown(std::uint64_t seed) {
    DlaParams params;
    params.particles = 200;
    params.visits = 1;
    params.seed = seed;
    return grow_dla(params);
}

/// By the definition: every subtree counted anew.
std::vector<Cell> best_subtree(Cluster const& cluster, BranchChoice choice) {
    auto const inside = [choice](Cell c) {
        std::int64_t const along = choice == BranchChoice::north   ? -c.row
                                   : choice == BranchChoice::south ? c.row
                                   : choice == BranchChoice::east  ? c.col
                                                                   : -c.col;
        std::int64_t const across =
            choice == BranchChoice::north || choice == BranchChoice::south ? std::abs(c.col) : std::abs(c.row);
        return choice == BranchChoice::largest || (along > 0 && across <= along);
    };
    std::vector<Cell> best;
    std::ptrdiff_t most = 0;
    for (std::size_t root = 1; root < cluster.cells.size(); ++root) {
        if (choice == BranchChoice::largest && cluster.parent[root] != 0) {
            continue;
        }
        std::vector<Cell> tree;
        for (std::size_t p = root; p < cluster.cells.size(); ++p) {
            std::size_t at = p;
            while (at > root) {
                at = static_cast<std::size_t>(cluster.parent[at]);
            }
            if (at == root) {
                tree.push_back(cluster.cells[p]);
            }
        }
        std::ptrdiff_t const there = std::ranges::count_if(tree, inside);
        if (there > most && 4 * there >= 3 * static_cast<std::ptrdiff_t>(tree.size())) {
            most = there;
            best = tree;
        }
    }
    return best;
}

BranchParams choosing(BranchChoice choice) {
    BranchParams params;
    params.choice = choice;
    return params;
}

} // namespace

TEST(PickBranch, a_lone_seed_has_no_arm) {
    Cluster lone;
    lone.cells = {{0, 0}};
    lone.parent = {-1};
    EXPECT_THROW(pick_branch(lone), BadInput);
    EXPECT_THROW(pick_branch(lone, choosing(BranchChoice::south)), BadInput);
    EXPECT_EQ(pick_branch(lone, choosing(BranchChoice::all)).cells, lone.cells);
}

TEST(PickBranch, refuses_what_is_no_cluster) {
    EXPECT_THROW(pick_branch({}), BadInput);
    Cluster broken = cross();
    broken.parent.pop_back();
    EXPECT_THROW(pick_branch(broken), BadInput);
    broken = cross();
    broken.parent[4] = 4;
    EXPECT_THROW(pick_branch(broken), BadInput);
    broken.parent[4] = -1;
    EXPECT_THROW(pick_branch(broken), BadInput);
    BranchParams params;
    params.max_width = -1;
    EXPECT_THROW(pick_branch(cross(), params), BadParameter);
}

TEST(PickBranch, takes_the_arm_of_a_direction) {
    using Cells = std::vector<Cell>;
    EXPECT_EQ(pick_branch(cross(), choosing(BranchChoice::north)).cells, (Cells{{0, -1}, {0, -2}}));
    EXPECT_EQ(pick_branch(cross(), choosing(BranchChoice::east)).cells, (Cells{{1, 0}, {2, 0}, {3, 0}}));
    EXPECT_EQ(pick_branch(cross(), choosing(BranchChoice::south)).cells, (Cells{{0, 1}, {0, 2}}));
    EXPECT_THROW(pick_branch(cross(), choosing(BranchChoice::west)), BadInput);
    EXPECT_EQ(pick_branch(cross(), choosing(BranchChoice::all)).cells, cross().cells);
}

TEST(PickBranch, takes_the_largest_arm_and_of_equals_the_first_to_arrive) {
    EXPECT_EQ(pick_branch(cross()).cells.front(), (Cell{1, 0}));
    Cluster even = cross();
    even.cells.pop_back();
    even.parent.pop_back();
    EXPECT_EQ(pick_branch(even).cells.front(), (Cell{0, -1}));
}

TEST(PickBranch, cuts_at_the_first_particle_that_overflows_the_box) {
    BranchParams params = choosing(BranchChoice::all);
    params.max_width = 3;
    Branch const narrow = pick_branch(cross(), params);
    EXPECT_TRUE(narrow.cut);
    EXPECT_EQ(narrow.cells.size(), 7U);
    params.max_width = 4;
    params.max_height = 5;
    Branch const whole = pick_branch(cross(), params);
    EXPECT_FALSE(whole.cut);
    EXPECT_EQ(whole.cells.size(), 8U);
    params.max_height = 3;
    Branch const low = pick_branch(cross(), params);
    EXPECT_TRUE(low.cut);
    EXPECT_EQ(low.cells.size(), 5U);
}

// Laws: three in four particles of an arm lie in its quadrant, and no subtree of which that holds has more there; the
// largest hangs on the seed; an arm is 4-connected and keeps the order of arrival; a cut branch is a beginning of the
// uncut one and fits the box.
TEST(PickBranch, laws_of_arms) {
    ASSERT_TRUE(rc::check([] {
        Cluster const cluster = grown(*rc::gen::inRange<std::uint64_t>(0, 1000));
        for (auto const choice : {BranchChoice::largest, BranchChoice::north, BranchChoice::east, BranchChoice::south,
                                  BranchChoice::west}) {
            Branch const arm = pick_branch(cluster, choosing(choice));
            RC_ASSERT(arm.cells == best_subtree(cluster, choice));
            for (std::size_t i = 1; i < arm.cells.size(); ++i) {
                RC_ASSERT(
                    std::any_of(arm.cells.begin(), arm.cells.begin() + static_cast<std::ptrdiff_t>(i), [&](Cell c) {
                        return std::abs(c.col - arm.cells[i].col) + std::abs(c.row - arm.cells[i].row) == 1;
                    }));
            }
            BranchParams boxed = choosing(choice);
            boxed.max_width = *rc::gen::inRange<std::int64_t>(1, 30);
            boxed.max_height = *rc::gen::inRange<std::int64_t>(1, 30);
            Branch const cut = pick_branch(cluster, boxed);
            RC_ASSERT(cut.cut == (cut.cells.size() < arm.cells.size()));
            RC_ASSERT(std::equal(cut.cells.begin(), cut.cells.end(), arm.cells.begin()));
            auto const [west, east] = std::ranges::minmax(cut.cells, {}, &Cell::col);
            auto const [north, south] = std::ranges::minmax(cut.cells, {}, &Cell::row);
            RC_ASSERT(east.col - west.col < boxed.max_width);
            RC_ASSERT(south.row - north.row < boxed.max_height);
        }
    }));
}

} // namespace pick_branch_test
