// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/count_streams.hpp>

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>

namespace thalweg::network {

namespace {} // namespace

StreamCounts count_streams(std::vector<std::int64_t> const& down) {
    std::size_t const links = down.size();
    StreamCounts counts;
    counts.links = static_cast<std::int64_t>(links);
    std::size_t orders = 0;
    Indexed<std::int64_t, std::size_t> order(links, 1);
    Indexed<std::int64_t, std::size_t> highest(links, 0); // of those above
    Indexed<std::int64_t, int> equals(links, 0);          // of those above, of the highest order
    for (std::size_t i = links; i-- > 0;) {
        if (down[i] >= static_cast<std::int64_t>(i)) {
            throw BadInput(fmt::format("network.count_streams: link {} flows into link {}; number them from the outlet",
                                       i, down[i]));
        }
        counts.sources += highest[i] == 0 ? 1 : 0;
        order[i] = std::max<std::size_t>(1, highest[i] + (equals[i] > 1 ? 1 : 0));
        orders = std::max(orders, order[i]);
        if (down[i] >= 0) {
            std::int64_t const below = down[i];
            if (order[i] > highest[below]) {
                highest[below] = order[i];
                equals[below] = 0;
            }
            equals[below] += order[i] == highest[below] ? 1 : 0;
        }
    }
    counts.order = static_cast<int>(orders);
    counts.streams.assign(orders, 0);
    counts.branches.assign(orders, {});
    for (std::size_t w = 0; w < orders; ++w) {
        counts.branches[w].assign(w, 0);
    }
    for (std::size_t i = 0; i < links; ++i) {
        bool const mouth = down[i] < 0;
        if (mouth || order[down[i]] != order[i]) {
            ++counts.streams[order[i] - 1];
        }
        // The two that make a stream of the next order are none of its side branches.
        if (!mouth && order[down[i]] > order[i] && !(highest[down[i]] == order[i] && order[down[i]] == order[i] + 1)) {
            ++counts.branches[order[down[i]] - 1][order[down[i]] - order[i] - 1];
        }
    }
    for (std::size_t k = 1; k < orders; ++k) {
        std::int64_t side = 0;
        std::int64_t streams = 0;
        for (std::size_t w = k; w < orders; ++w) {
            side += counts.branches[w][k - 1];
            streams += counts.streams[w];
        }
        counts.side.push_back(static_cast<double>(side) / static_cast<double>(streams));
    }
    return counts;
}

StreamCounts count_streams(StreamNetwork const& network) {
    std::vector<std::int64_t> place(network.arc_count(), -1); // downstream before upstream
    std::vector<std::int64_t> down;
    for (NodeId const n : network.upstream_order()) {
        if (ArcId const arc = network.out(n); arc != no_arc) {
            ArcId const below = network.out(network.to(arc));
            place[arc] = static_cast<std::int64_t>(down.size());
            down.push_back(below == no_arc ? -1 : place[below]);
        }
    }
    return count_streams(down);
}

} // namespace thalweg::network
