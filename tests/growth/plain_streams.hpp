// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

/// Strahler orders and side branches counted junction by junction from who flows into whom alone: the slow, obvious
/// way.
namespace test {

using namespace thalweg;

struct PlainStreams {
    std::map<int, double> streams;                  ///< by order
    std::map<std::pair<int, int>, double> branches; ///< by order of the stream and of the branch
    int order = 0;

    /// Side branches of k orders less, for each stream that can have them.
    double side(int k) const {
        double n = 0.0;
        double of = 0.0;
        for (auto const& [w, count] : streams) {
            if (w > k) {
                of += count;
                auto const found = branches.find({w, w - k});
                n += found == branches.end() ? 0.0 : found->second;
            }
        }
        return n / of;
    }
    double ratio(int w) const { return streams.at(w) / streams.at(w + 1); }
};

inline PlainStreams plain_streams(std::vector<std::int64_t> const& down) {
    std::vector<std::vector<std::size_t>> above(down.size());
    for (std::size_t i = 0; i < down.size(); ++i) {
        if (down[i] >= 0) {
            above[static_cast<std::size_t>(down[i])].push_back(i);
        }
    }
    // A link is ready when all above it are: no trust in how they are numbered.
    std::vector<int> order(down.size(), 0);
    std::vector<std::size_t> waits(down.size());
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < down.size(); ++i) {
        waits[i] = above[i].size();
        if (waits[i] == 0) {
            ready.push_back(i);
        }
    }
    PlainStreams out;
    while (!ready.empty()) {
        std::size_t const i = ready.back();
        ready.pop_back();
        std::vector<int> orders;
        for (std::size_t const a : above[i]) {
            orders.push_back(order[a]);
        }
        std::sort(orders.rbegin(), orders.rend());
        bool const first = orders.empty();
        bool const joins = orders.size() > 1 && orders[0] == orders[1];
        order[i] = first ? 1 : orders[0] + (joins ? 1 : 0);
        out.order = std::max(out.order, order[i]);
        if (first || joins) {
            out.streams[order[i]] += 1.0; // here a stream begins
        }
        for (std::size_t k = joins ? 2 : 1; k < orders.size(); ++k) {
            out.branches[{order[i], orders[k]}] += 1.0;
        }
        if (down[i] >= 0 && --waits[static_cast<std::size_t>(down[i])] == 0) {
            ready.push_back(static_cast<std::size_t>(down[i]));
        }
    }
    return out;
}

inline std::vector<std::int64_t> down_of(growth::TokunagaTree const& tree) {
    std::vector<std::int64_t> down;
    for (growth::TreeLink const& link : tree.links) {
        down.push_back(link.down);
    }
    return down;
}

} // namespace test
