// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/dla/grow_dla.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <fmt/format.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>

namespace thalweg::network {

namespace {

/// The share of an arm that has to lie in its direction's quadrant.
constexpr std::int64_t of_four = 3;

void check(Cluster const& cluster, BranchParams const& params) {
    if (params.max_width < 0 || params.max_height < 0) {
        throw BadParameter(fmt::format("network.pick_branch: max_width is {} and max_height {}, they must be at least "
                                       "1, or 0 for no limit",
                                       params.max_width, params.max_height));
    }
    require_in("network.pick_branch", "turn_deg", params.turn_deg, Range::between(-180.0, 180.0));
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

/// Whether each descends from the root, which does itself.
Indexed<ParticleId, std::uint8_t> descendants(Cluster const& cluster, std::size_t root) {
    Indexed<ParticleId, std::uint8_t> descends(cluster.cells.size(), 0);
    descends[root] = 1;
    for (std::size_t p = root + 1; p < descends.size(); ++p) {
        descends[p] = descends[cluster.parent[p]];
    }
    return descends;
}

/// Whether a cell lies in the quadrant around a direction, seen from the seed.
bool lies(Cell c, BranchChoice direction) {
    switch (direction) {
    case BranchChoice::north: return -c.row > 0 && std::abs(c.col) <= -c.row;
    case BranchChoice::east: return c.col > 0 && std::abs(c.row) <= c.col;
    case BranchChoice::south: return c.row > 0 && std::abs(c.col) <= c.row;
    case BranchChoice::west: return -c.col > 0 && std::abs(c.row) <= -c.col;
    case BranchChoice::largest:
    case BranchChoice::all: break;
    }
    return true;
}

/// The particle whose descendants are the arm; 0 where there is none.
std::size_t root_of(Cluster const& cluster, BranchChoice choice) {
    std::size_t const count = cluster.cells.size();
    Indexed<ParticleId, std::int64_t> size(count, 1);
    Indexed<ParticleId, std::int64_t> inside(count, 0);
    Cell const seed = cluster.cells.front();
    for (std::size_t p = count - 1; p > 0; --p) { // children arrive after their parents
        Cell const c{cluster.cells[p].col - seed.col, cluster.cells[p].row - seed.row};
        inside[p] += lies(c, choice) ? 1 : 0;
        ParticleId const up = cluster.parent[p];
        size[up] += size[p];
        inside[up] += inside[p];
    }
    std::size_t best = 0;
    std::int64_t most = 0;
    for (std::size_t p = 1; p < count; ++p) {
        bool const is_arm =
            choice == BranchChoice::largest ? cluster.parent[p] == 0 : 4 * inside[p] >= of_four * size[p];
        if (is_arm && inside[p] > most) {
            most = inside[p];
            best = p;
        }
    }
    return best;
}

std::vector<std::uint8_t> choose(Cluster const& cluster, BranchChoice choice) {
    std::size_t const root = root_of(cluster, choice);
    if (root == 0) {
        throw BadInput(fmt::format("network.pick_branch: the cluster of {} particles has no arm there, choose another "
                                   "or grow more particles",
                                   cluster.cells.size()));
    }
    return descendants(cluster, root);
}

} // namespace

Branch pick_branch(Cluster const& cluster, BranchParams const& params) {
    check(cluster, params);
    auto const chosen = params.choice == BranchChoice::all ? std::vector<std::uint8_t>(cluster.cells.size(), 1)
                                                           : choose(cluster, params.choice);
    Branch branch;
    double const turn = params.turn_deg / 180.0 * portable::pi;
    double const c = params.turn_deg == 0.0 ? 1.0 : portable::cos(turn);
    double const s = params.turn_deg == 0.0 ? 0.0 : portable::sin(turn);
    Vec2 low;
    Vec2 high;
    for (std::size_t p = 0; p < chosen.size(); ++p) {
        if (chosen[p] == 0) {
            continue;
        }
        Cell const cell = cluster.cells[p];
        auto const col = static_cast<double>(cell.col);
        auto const row = static_cast<double>(cell.row);
        Vec2 const at{c * col + s * row, c * row - s * col}; // rows grow to the south
        bool const first = branch.cells.empty();
        Vec2 const wider_low = first ? at : Vec2{std::min(low.x, at.x), std::min(low.y, at.y)};
        Vec2 const wider_high = first ? at : Vec2{std::max(high.x, at.x), std::max(high.y, at.y)};
        bool const too_wide =
            params.max_width > 0 && wider_high.x - wider_low.x > static_cast<double>(params.max_width - 1);
        bool const too_high =
            params.max_height > 0 && wider_high.y - wider_low.y > static_cast<double>(params.max_height - 1);
        if (too_wide || too_high) {
            branch.cut = true;
            break;
        }
        low = wider_low;
        high = wider_high;
        branch.cells.push_back(cell);
    }
    return branch;
}

} // namespace thalweg::network
