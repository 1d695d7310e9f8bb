// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sample 7: one network says little; an ensemble has a mean and a spread.
// Networks of several seeds are grown in parallel. Each depends on its seed alone, so that neither the number of
// threads nor the order in which they finish changes a figure.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <thalweg/core.hpp>
#include <thalweg/growth.hpp>
#include <thalweg/network.hpp>

using namespace thalweg;

struct Figures {
    double sources = 0.0;
    double bifurcation = 0.0; ///< streams of order 1 for one of order 2
};

Figures of_seed(std::uint64_t seed, Run const& run) {
    growth::TokunagaTree const tree = growth::grow_tokunaga({.seed = seed, .generator = 3, .order = 6}, run);
    std::vector<std::int64_t> down;
    for (growth::TreeLink const& link : tree.links) {
        down.push_back(link.down);
    }
    network::StreamCounts const counts = network::count_streams(down);
    return {static_cast<double>(counts.sources),
            static_cast<double>(counts.streams[0]) / static_cast<double>(counts.streams[1])};
}

//! [ensemble]
std::vector<Figures> ensemble(std::int64_t seeds, int threads) {
    std::vector<Figures> figures(static_cast<std::size_t>(seeds));
    Run run;
    run.threads = threads;
    parallel_ranges(run, seeds, 1, [&](std::int64_t first, std::int64_t last) {
        Run one; // a thread for each: the ensemble has them all already
        one.threads = 1;
        for (std::int64_t i = first; i < last; ++i) {
            figures[static_cast<std::size_t>(i)] = of_seed(static_cast<std::uint64_t>(i + 1), one);
        }
    });
    return figures; // in the order of seeds
}
//! [ensemble]

int main() try {
    std::vector<Figures> const figures = ensemble(64, 0);
    auto const count = static_cast<double>(figures.size());
    double mean = 0.0;
    double sources = 0.0;
    for (Figures const& of : figures) {
        mean += of.bifurcation / count;
        sources += of.sources / count;
    }
    double variance = 0.0;
    for (Figures const& of : figures) {
        variance += (of.bifurcation - mean) * (of.bifurcation - mean) / (count - 1.0);
    }
    std::printf("%zu networks, %.1f sources each\n", figures.size(), sources);
    std::printf("streams of order 1 for one of order 2: %.3f +- %.3f\n", mean, std::sqrt(variance));

    std::vector<Figures> const alone = ensemble(64, 1);
    bool const same =
        std::equal(figures.begin(), figures.end(), alone.begin(), alone.end(), [](Figures const& a, Figures const& b) {
            return a.sources == b.sources && a.bifurcation == b.bifurcation;
        });
    std::printf("on one thread: %s\n", same ? "the same" : "another result");
} catch (Error const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
