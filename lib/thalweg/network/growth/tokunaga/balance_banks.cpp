// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/grow_strokes.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/parameters.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace thalweg::network {

namespace {

struct Wing {
    LinkId link;
    std::int64_t links; ///< with all above
};

/// By link: links above it and itself.
Indexed<LinkId, std::int64_t> sizes_of(TokunagaTree const& tree) {
    Indexed<LinkId, std::int64_t> links(tree.links.size(), 1);
    for (std::size_t i = tree.links.size(); i-- > 1;) {
        links[tree.links[i].down] += links[i];
    }
    return links;
}

} // namespace

std::vector<std::size_t> trunk_of(TokunagaTree const& tree) {
    std::vector<std::size_t> trunk;
    LinkId link = 0;
    while (link >= 0) {
        TreeLink const& here = tree.links[link];
        trunk.push_back(static_cast<std::size_t>(link));
        LinkId const next = here.up[0];
        link = next >= 0 && tree.links[next].order == here.order ? next : -1;
    }
    return trunk;
}

void balance_banks(TokunagaTree& tree, double share_left) {
    require_in("network.balance_banks", "share_left", share_left, Range::between(0.0, 1.0));
    Indexed<LinkId, std::int64_t> const sizes = sizes_of(tree);
    std::int64_t left = 0;
    std::int64_t right = 0;
    std::vector<Wing> branches;
    for (std::size_t const t : trunk_of(tree)) {
        for (LinkId const up : tree.links[t].up) {
            if (up < 0 || tree.links[up].turn == 0) {
                continue;
            }
            int const turn = tree.links[up].turn;
            if (turn == 1 || turn == -1) { // of the fork
                (turn > 0 ? left : right) += sizes[up];
            } else {
                branches.push_back({up, sizes[up]});
            }
        }
    }
    std::stable_sort(branches.begin(), branches.end(), [](Wing const& a, Wing const& b) { return a.links > b.links; });
    std::int64_t all = left + right;
    for (Wing const& branch : branches) {
        all += branch.links;
    }
    double const wanted_left = share_left * static_cast<double>(all);
    double const wanted_right = static_cast<double>(all) - wanted_left;
    for (Wing const& branch : branches) {
        double const lacks_left = wanted_left - static_cast<double>(left);
        double const lacks_right = wanted_right - static_cast<double>(right);
        bool const goes_left =
            lacks_left > lacks_right || (lacks_left == lacks_right && tree.links[branch.link].turn > 0);
        tree.links[branch.link].turn = goes_left ? 2 : -2;
        (goes_left ? left : right) += branch.links;
    }
}

} // namespace thalweg::network
