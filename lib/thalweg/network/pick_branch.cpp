// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/pick_branch.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>

namespace thalweg::network {

namespace {

/// Neighbours of the seed in the order of BranchChoice: north, east, south, west.
constexpr std::array<Cell, 4> roots = {{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
constexpr std::array<char const*, 4> root_names = {"north", "east", "south", "west"};

void check(Cluster const& cluster, BranchParams const& params) {
    if (params.max_width < 0 || params.max_height < 0) {
        throw BadParameter(fmt::format("network.pick_branch: max_width is {} and max_height {}, they must be at least "
                                       "1, or 0 for no limit",
                                       params.max_width, params.max_height));
    }
    if (cluster.cells.empty() || cluster.parent.size() != cluster.cells.size() || cluster.parent[0] != -1) {
        throw BadInput("network.pick_branch: the cluster needs a seed and a parent for every other particle");
    }
    for (std::size_t p = 1; p < cluster.parent.size(); ++p) {
        if (cluster.parent[p] < 0 || cluster.parent[p] >= static_cast<std::int64_t>(p)) {
            throw BadInput(
                fmt::format("network.pick_branch: particle {} hangs on {}, it must hang on one that arrived before it",
                            p, cluster.parent[p]));
        }
    }
}

/// The particle on a neighbour of the seed.
std::optional<std::size_t> find_root(Cluster const& cluster, std::size_t direction) {
    Cell const seed = cluster.cells.front();
    Cell const wanted = {seed.col + roots[direction].col, seed.row + roots[direction].row};
    auto const found = std::ranges::find(cluster.cells, wanted);
    if (found == cluster.cells.end()) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(found - cluster.cells.begin());
}

/// By particle: whether it descends from the root, which does itself.
std::vector<std::uint8_t> descendants(Cluster const& cluster, std::size_t root) {
    std::vector<std::uint8_t> descends(cluster.cells.size(), 0);
    descends[root] = 1;
    for (std::size_t p = root + 1; p < descends.size(); ++p) {
        descends[p] = descends[static_cast<std::size_t>(cluster.parent[p])];
    }
    return descends;
}

std::vector<std::uint8_t> choose(Cluster const& cluster, BranchChoice choice) {
    std::vector<std::uint8_t> chosen;
    std::ptrdiff_t most = 0;
    for (std::size_t d = 0; d < roots.size(); ++d) {
        auto const direction = static_cast<BranchChoice>(static_cast<std::size_t>(BranchChoice::north) + d);
        auto const root = find_root(cluster, d);
        if ((choice != BranchChoice::largest && choice != direction) || !root) {
            continue;
        }
        auto arm = descendants(cluster, *root);
        std::ptrdiff_t const size = std::ranges::count(arm, std::uint8_t{1});
        if (size > most) {
            most = size;
            chosen = std::move(arm);
        }
    }
    if (most == 0) {
        auto const d = static_cast<std::size_t>(choice) - static_cast<std::size_t>(BranchChoice::north);
        throw BadInput(fmt::format("network.pick_branch: the cluster of {} particles has no arm {}, choose another or "
                                   "grow more particles",
                                   cluster.cells.size(), choice == BranchChoice::largest ? "at all" : root_names[d]));
    }
    return chosen;
}

} // namespace

Branch pick_branch(Cluster const& cluster, BranchParams const& params) {
    check(cluster, params);
    auto const chosen = params.choice == BranchChoice::all ? std::vector<std::uint8_t>(cluster.cells.size(), 1)
                                                           : choose(cluster, params.choice);
    Branch branch;
    Cell low;
    Cell high;
    for (std::size_t p = 0; p < chosen.size(); ++p) {
        if (chosen[p] == 0) {
            continue;
        }
        Cell const c = cluster.cells[p];
        bool const first = branch.cells.empty();
        Cell const wider_low = first ? c : Cell{std::min(low.col, c.col), std::min(low.row, c.row)};
        Cell const wider_high = first ? c : Cell{std::max(high.col, c.col), std::max(high.row, c.row)};
        bool const too_wide = params.max_width > 0 && wider_high.col - wider_low.col >= params.max_width;
        bool const too_high = params.max_height > 0 && wider_high.row - wider_low.row >= params.max_height;
        if (too_wide || too_high) {
            branch.cut = true;
            break;
        }
        low = wider_low;
        high = wider_high;
        branch.cells.push_back(c);
    }
    return branch;
}

} // namespace thalweg::network
