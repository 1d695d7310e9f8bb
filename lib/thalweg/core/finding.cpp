// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/finding.hpp>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg {

FindingKind FindingKind::named(std::string_view kind) {
    FindingRow const* const row = find(kind);
    refuse_if<BadParameter>(row == nullptr, "core.FindingKind", "unknown kind of finding '{}'", kind);
    return FindingKind(row);
}

std::string remedy_of(Finding const& finding) {
    if (!finding.remedy.empty()) {
        return finding.remedy;
    }
    std::string_view const usual = finding.kind.row().remedy;
    return std::string(usual.substr(0, usual.find_last_not_of('.') + 1));
}

std::string line_of(Finding const& finding) {
    if (finding.severity() == Severity::note) {
        return fmt::format("{:<10} {}", finding.kind.name(), finding.text);
    }
    std::string const remedy = remedy_of(finding);
    return fmt::format("{}: {}. {}[{}]", name_of(finding.severity()), finding.text, remedy.empty() ? "" : remedy + ". ",
                       finding.kind.name());
}

std::vector<std::string> texts_of(std::vector<Finding> const& findings) {
    std::vector<std::string> texts;
    std::ranges::transform(findings, std::back_inserter(texts), &Finding::text);
    return texts;
}

std::int64_t warnings_in(std::vector<Finding> const& findings) {
    return std::ranges::count(findings, Severity::warning, &Finding::severity);
}

} // namespace thalweg
