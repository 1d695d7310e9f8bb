// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/given.hpp>

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace thalweg::pipeline {

namespace {

/// The doubts of a kind, the greatest first.
std::vector<Finding const*> doubts_of(network::Directions const& directions, std::string_view kind) {
    std::vector<Finding const*> result;
    for (Finding const& doubt : directions.doubts) {
        if (doubt.kind == kind) {
            result.push_back(&doubt);
        }
    }
    std::ranges::stable_sort(result, [](Finding const* a, Finding const* b) { return a->amount > b->amount; });
    return result;
}

std::string groups(std::size_t count) {
    return count == 1 ? "1 group of lines" : fmt::format("{} groups of lines", count);
}

} // namespace

std::string in_km(double m) {
    constexpr double least_m = 50.0; // less would be 0.0 km
    return m < least_m ? fmt::format("{:.2g} m", m) : fmt::format("{:.1f} km", m / 1000.0);
}

std::string turned_in_words(network::Directions const& directions) {
    double sum_m = 0.0;
    std::string parts;
    for (network::Directions::Turned const& turned : directions.turned) {
        sum_m += turned.length_m;
        parts += fmt::format("{}{} by {}", parts.empty() ? "" : ", ", in_km(turned.length_m), turned.by);
    }
    if (directions.turned.size() == 1) {
        return fmt::format("{} reversed by {}", in_km(sum_m), directions.turned.front().by);
    }
    return parts.empty() ? "" : fmt::format("{} reversed: {}", in_km(sum_m), parts);
}

std::vector<std::string> direction_doubts(network::Directions const& directions, std::string const& by_dem,
                                          std::string const& by_rule) {
    std::vector<std::string> said;
    std::string const either = by_dem.empty() ? by_rule : by_rule.empty() ? by_dem : by_dem + " or " + by_rule;
    std::string const decides = either.empty() ? "" : fmt::format(" {} decides.", either);
    if (auto const uncertain = doubts_of(directions, "uncertain_direction"); !uncertain.empty()) {
        said.push_back(fmt::format("the flow direction of {} ({}) is uncertain: {:.0f} % of that length is expected to "
                                   "run the wrong way, the first group at ({:.0f}, {:.0f}).{}",
                                   groups(uncertain.size()), in_km(directions.uncertain_m),
                                   100.0 * directions.expected_wrong_m / directions.uncertain_m,
                                   uncertain.front()->where.x, uncertain.front()->where.y, decides));
    }
    if (auto const second = doubts_of(directions, "second_outlet"); !second.empty()) {
        said.push_back(fmt::format("{} may have a second outlet, the likeliest at ({:.0f}, {:.0f}): {}.{}",
                                   groups(second.size()), second.front()->where.x, second.front()->where.y,
                                   second.front()->text, decides));
    }
    for (char const* const kind : {"conflicting_direction", "contradicted_direction"}) {
        if (auto const doubts = doubts_of(directions, kind); !doubts.empty()) {
            std::string const more = doubts.size() == 1 ? "" : fmt::format(" (and {} more)", doubts.size() - 1);
            said.push_back(fmt::format("{}{}.{}", doubts.front()->text, more,
                                       by_rule.empty() ? "" : fmt::format(" {} decides.", by_rule)));
        }
    }
    return said;
}

} // namespace thalweg::pipeline
