// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/dla/internal/walk.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg::network {

std::vector<double> exit_probabilities(int half) {
    double const side = 2.0 * half;
    std::vector<double> p(static_cast<std::size_t>(half), 0.0);
    for (int k = 1; k < 2 * half; k += 2) {
        double const angle = portable::pi * k / side;
        double const s = portable::sin(0.5 * angle);
        double const decay = side * portable::log(s + std::sqrt(1.0 + s * s));
        if (decay > 45.0) {
            break;
        }
        double const weight = 2.0 / (side * (portable::exp(decay) + portable::exp(-decay)));
        for (std::size_t j = 0; j < p.size(); ++j) {
            p[j] += weight * portable::cos(angle * static_cast<double>(j));
        }
    }
    return p;
}

ExitLaw::Table ExitLaw::make_table(int half) {
    std::vector<double> share = exit_probabilities(half);
    std::size_t const count = share.size();
    // An offset and its mirror image share an entry; the sign of 0 does not matter.
    for (std::size_t j = 0; j < count; ++j) {
        share[j] = std::max(share[j], 0.0) * (j == 0 ? 1.0 : 2.0);
    }
    double const mean = std::accumulate(share.begin(), share.end(), 0.0) / static_cast<double>(count);
    std::vector<std::size_t> poor;
    std::vector<std::size_t> rich;
    for (std::size_t j = 0; j < count; ++j) {
        share[j] /= mean;
        (share[j] < 1.0 ? poor : rich).push_back(j);
    }
    Table table;
    table.half = count;
    table.entries.resize(count);
    auto const set = [&](std::size_t j, double keeps, std::size_t alias) {
        auto const bits = static_cast<std::uint64_t>(keeps * 0x1p52);
        table.entries[j] = std::min(bits, low_52_bits) << 12 | alias;
    };
    while (!poor.empty() && !rich.empty()) {
        std::size_t const from = rich.back();
        std::size_t const to = poor.back();
        poor.pop_back();
        set(to, share[to], from);
        share[from] -= 1.0 - share[to];
        if (share[from] < 1.0) {
            rich.pop_back();
            poor.push_back(from);
        }
    }
    for (auto const* rest : {&poor, &rich}) {
        for (std::size_t const j : *rest) {
            set(j, 1.0, j);
        }
    }
    return table;
}

void ExitLaw::prepare(int longest) {
    for (int half = longest_ + 1; half <= std::min(longest, 15 * 256); ++half) {
        if (tables_[slot(half)].half == 0) {
            tables_[slot(half)] = make_table(half);
        }
    }
    longest_ = std::max(longest_, longest);
}

} // namespace thalweg::network
