// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/topology/topology.hpp>

#include <cstdlib>
#include <mutex>
#include <string>

#include <gtest/gtest.h>

#include <thalweg/core/run/run.hpp>

#include "faults.hpp"

namespace injected_faults_test {

// Each fault, twenty times at places at random, one a file: it is found, its feature named, and nothing is found beside
// what it cannot help but cause.
namespace {

using namespace thalweg;

constexpr std::size_t instances = 20;

/// What is wrong with the report of one planted fault; "" for nothing.
std::string complaint(faults::Fault const& fault, faults::Features const& features,
                      measure::TopologyReport const& report) {
    bool named = false;
    for (Finding const& f : report.findings) {
        bool const is_it = f.kind == fault.kind;
        named = named || (is_it && std::find(features.begin(), features.end(), f.feature) != features.end());
        if (!is_it && fault.besides.count(f.kind) == 0) {
            return "found besides: " + f.kind + ": " + f.text;
        }
    }
    return named ? "" : "not found";
}

/// Every fault `times` times in networks of so many arcs, of which `networks` differ.
void expect_all_found(std::size_t arcs, std::size_t networks, std::size_t times = instances) {
    std::vector<NetworkFile> clean;
    for (std::size_t seed = 0; seed < networks; ++seed) {
        clean.push_back(faults::clean_of(arcs, seed));
        ASSERT_GE(clean.back().arcs.size(), arcs);
        auto const findings = measure::check_topology(clean.back()).findings;
        ASSERT_TRUE(findings.empty()) << findings.front().text;
    }
    auto const& all = faults::all();
    std::mutex one_at_a_time;
    auto const plant = [&](std::size_t fault, std::size_t instance) {
        for (std::uint64_t seed = instance;; seed += instances) { // until there is a place for it
            NetworkFile file = clean[seed % networks];
            auto const features = all[fault].plant(file, random_word(seed, fault) % file.arcs.size());
            if (features.empty()) {
                ASSERT_LT(seed, 1000 * instances) << all[fault].kind << " has no place";
                continue;
            }
            std::string const wrong = complaint(all[fault], features, measure::check_topology(file));
            std::lock_guard const lock(one_at_a_time);
            EXPECT_EQ(wrong, "") << all[fault].kind << ", " << all[fault].what << ", instance " << instance << ", arc "
                                 << features.front();
            return;
        }
    };
    parallel_ranges({}, static_cast<std::int64_t>(all.size() * times), 1, [&](auto first, auto last) {
        for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
            plant(i / times, i % times);
        }
    });
}

} // namespace

TEST(InjectedFaults, OfTenArcs) {
    expect_all_found(10, instances);
}

TEST(InjectedFaults, OfAThousandArcs) {
    expect_all_found(1000, 4);
}

TEST(SoakInjectedFaults, OfAHundredThousandArcs) {
    expect_all_found(100'000, 1);
}

} // namespace injected_faults_test
