// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/print.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include <thalweg/report/report.hpp>

namespace thalweg::tools {

void print_result(Session const& session, nlohmann::ordered_json const& json, std::vector<std::string> const& files,
                  int indent) {
    if (session.json) {
        nlohmann::ordered_json whole = json;
        if (!whole.contains("findings")) {
            whole["findings"] = nlohmann::ordered_json::parse(report::findings_json(session.findings));
        }
        fmt::print("{}\n", whole.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
        return;
    }
    for (std::string const& file : files) {
        fmt::print("{}\n", file);
    }
}

std::string limit_in_words(Check const& check) {
    return fmt::format("{} {:.6g}", check.bound == Bound::at_least ? "at least" : "at most", check.limit);
}

std::string in_words(Check const& check) {
    return fmt::format("{} {:.6g} ({})", check.name, check.value, limit_in_words(check));
}

std::string verdict(std::string const& of, std::vector<Check> const& checks) {
    auto const failed = std::count_if(checks.begin(), checks.end(), [](Check const& c) { return !c.ok; });
    std::string const count = fmt::format("{} check{}", checks.size(), checks.size() == 1 ? "" : "s");
    return failed == 0 ? fmt::format("{}: ok, {}", of, count) : fmt::format("{}: FAILED, {} of {}", of, failed, count);
}

} // namespace thalweg::tools
