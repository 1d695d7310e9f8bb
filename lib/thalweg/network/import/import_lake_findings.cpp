// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/internal/lake_findings.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace thalweg::network::import_steps {
namespace {

Finding lakes_without_outflow(std::vector<LakeWithoutOutflow> const& closed) {
    std::int64_t rivers = 0;
    for (LakeWithoutOutflow const& lake : closed) {
        rivers += lake.rivers;
    }
    auto const near = std::ranges::min_element(closed, {}, &LakeWithoutOutflow::next_m);
    bool const has_next = std::isfinite(near->next_m);
    return {.kind = "lake_without_outflow",
            .feature = near->lake,
            .where = near->at,
            .amount = static_cast<double>(closed.size()),
            .text = fmt::format(
                "{} at the shore of {} that no river leaves, such as lake {}{}{}",
                rivers == 1 ? "1 river ends" : fmt::format("{} rivers end", rivers),
                closed.size() == 1 ? "a lake" : fmt::format("{} lakes", closed.size()), near->lake,
                has_next ? fmt::format(": the nearest one begins {:.0f} m from its shore, at ({:.0f}, {:.0f})",
                                       near->next_m, near->next.x, near->next.y)
                         : "",
                is_finite(near->out)
                    ? fmt::format("{} its water leaves it at ({:.0f}, {:.0f}), where its shore is nearest to the "
                                  "border",
                                  has_next ? ";" : ":", near->out.x, near->out.y)
                    : ""),
            .remedy = has_next ? fmt::format("If it should leave the lake: --set network.lines.snap={:.0f}, or draw "
                                             "it to the shore; if the water stays in the lake: --set "
                                             "network.inland=sink",
                                             std::ceil(near->next_m))
                               : "If the water stays in the lake: --set network.inland=sink; else draw its "
                                 "outflow, or turn it round",
            .key = has_next ? "network.lines.snap" : "network.inland",
            .numbers = {{"rivers", static_cast<double>(rivers)}}};
}

Finding rivers_below_lakes(std::vector<RiverBelowLake> const& low) {
    RiverBelowLake const& most = *std::ranges::max_element(low, {}, &RiverBelowLake::by_m);
    return {.kind = "below_lake",
            .feature = most.river,
            .where = most.at,
            .amount = most.by_m,
            .text = fmt::format("{} below a lake and {} not led through it: river {} by {:.1f} m, at ({:.0f}, "
                                "{:.0f})",
                                low.size() == 1 ? "1 river ends" : fmt::format("{} rivers end", low.size()),
                                low.size() == 1 ? "is" : "are", most.river, most.by_m, most.at.x, most.at.y),
            .remedy = "Correct its heights, or leave those of the file out: --set network.heights=graded",
            .key = "network.heights",
            .numbers = {{"rivers", static_cast<double>(low.size())}}};
}

Finding second_outflows(std::vector<SecondOutflow> const& second) {
    SecondOutflow const& one = second.front();
    return {.kind = "lake_outflows",
            .feature = one.lake,
            .where = one.at,
            .amount = static_cast<double>(second.size()),
            .text = fmt::format("{} a lake that another one leaves too, by the drawn direction alone: river {} at "
                                "lake {}, at ({:.0f}, {:.0f})",
                                second.size() == 1 ? "1 river leaves" : fmt::format("{} rivers leave", second.size()),
                                one.river, one.lake, one.at.x, one.at.y),
            .remedy = "Turn it round in the file if it flows into the lake",
            .key = "network.lines.orientation"};
}

} // namespace

std::vector<Finding> findings_of_lakes(std::vector<LakeWithoutOutflow> const& closed,
                                       std::vector<RiverBelowLake> const& low,
                                       std::vector<SecondOutflow> const& second) {
    std::vector<Finding> findings;
    if (!closed.empty()) {
        findings.push_back(lakes_without_outflow(closed));
    }
    if (!low.empty()) {
        findings.push_back(rivers_below_lakes(low));
    }
    if (!second.empty()) {
        findings.push_back(second_outflows(second));
    }
    return findings;
}

} // namespace thalweg::network::import_steps
