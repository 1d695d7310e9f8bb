// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/finding.hpp>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/run.hpp>

#include "golden.hpp"

namespace finding_test {

using namespace thalweg;

Finding warning() {
    return {.kind = "filled_heights", .feature = 7, .amount = 2.0, .text = "2 of 3 lines lack heights"};
}

TEST(FindingKinds, AreSnakeCaseUniqueAndExplained) {
    std::regex const snake_case("[a-z][a-z0-9]*(_[a-z0-9]+)*");
    for (FindingRow const& row : finding_rows) {
        std::string const kind(row.kind);
        EXPECT_TRUE(std::regex_match(kind, snake_case)) << kind;
        EXPECT_EQ(std::ranges::count(finding_rows, row.kind, &FindingRow::kind), 1) << kind;
        EXPECT_TRUE(row.meaning.ends_with('.') && row.meaning.size() > 10) << kind;
        EXPECT_TRUE(row.remedy.empty() || row.remedy.ends_with('.')) << kind;
        EXPECT_TRUE(row.severity != Severity::error || row.printed == Printed::verbose)
            << kind << ": checks count these";
        EXPECT_TRUE(row.severity != Severity::warning || row.printed == Printed::always) << kind;
        EXPECT_EQ(FindingKind::named(row.kind), row.kind);
    }
    EXPECT_THROW(FindingKind::named("no_such_kind"), BadParameter);
}

TEST(Findings, AsLines) {
    EXPECT_EQ(line_of(warning()), "warning: 2 of 3 lines lack heights. Give every vertex a height, or set "
                                  "network.heights. [filled_heights]");
    Finding with_remedy = warning();
    with_remedy.remedy = "--dem FILE gives them some";
    EXPECT_EQ(line_of(with_remedy), "warning: 2 of 3 lines lack heights. --dem FILE gives them some. [filled_heights]");
    EXPECT_EQ(remedy_of(with_remedy), "--dem FILE gives them some");
    EXPECT_EQ(line_of({.kind = "texture_missed", .text = "too smooth"}), "warning: too smooth. [texture_missed]");
    EXPECT_EQ(line_of({.kind = "grid", .text = "3x3 cells of 10 m"}), "grid       3x3 cells of 10 m");
    EXPECT_EQ(line_of({.kind = "crossing", .text = "arc 1"}).substr(0, 13), "error: arc 1.");
}

TEST(Findings, WarningsAreCounted) {
    EXPECT_EQ(warnings_in({}), 0);
    EXPECT_EQ(warnings_in({warning(), {.kind = "grid"}, {.kind = "crossing"}, warning()}), 2);
}

// Who does not listen for findings gets lines of those that are printed always; who listens gets all, and no lines.
TEST(Findings, AreReportedOnce) {
    std::vector<Finding> const findings{
        warning(), {.kind = "snapped", .text = "moved"}, {.kind = "grid", .text = "3x3"}};
    std::vector<std::string> lines;
    std::vector<std::string> kinds;
    thalweg::Run run;
    run.report(findings); // nobody listens
    run.log = [&](std::string_view line) { lines.emplace_back(line); };
    run.report(findings);
    EXPECT_EQ(lines, (std::vector{line_of(findings[0]), line_of(findings[2])}));
    run.found = [&](Finding const& finding) { kinds.emplace_back(finding.kind.name()); };
    run.report(findings);
    EXPECT_EQ(lines.size(), 2U);
    EXPECT_EQ(kinds, (std::vector<std::string>{"filled_heights", "snapped", "grid"}));
}

std::string rows_of(Severity severity) {
    std::string text = "| kind | amount | meaning | what to do |\n|---|---|---|---|\n";
    for (FindingRow const& row : finding_rows) {
        if (row.severity == severity) {
            text += fmt::format("| `{}` | {} | {} | {} |\n", row.kind, row.unit, row.meaning, row.remedy);
        }
    }
    return text;
}

TEST(Findings, DocsListEveryKind) {
    std::string const page = R"(# Findings

A finding is what thalweg finds wrong, doubts or changes: a kind, a severity, a place (a feature or
arc, x and y, a key of the recipe, a file or layer), an amount with its unit, a sentence with
numbers, and what to do. All commands share the kinds. The same findings are in report.json
(`findings`), in report.html, in the object that `--json` prints, on the terminal (`[kind]` ends a
warning), in the studio, in table.csv of an ensemble (their number), in QGIS, and in Python
(`terrain.findings`, `thalweg.TerrainWarning`). With `--progress` each is a line
`{"finding": {...}}` on stderr.

The terminal prints warnings and some notes; with `-v` also errors, and notes on single features.

## Warnings
The result may not be what was meant.

)" + rows_of(Severity::warning) +
                             R"(
## Errors
Faults that make a check fail.

)" + rows_of(Severity::error) +
                             R"(
## Notes
What was done, and facts.

)" + rows_of(Severity::note);
    expect_golden("../../docs/findings.md", page);
}

} // namespace finding_test
