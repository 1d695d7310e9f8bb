// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding_kinds.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// A number of a finding besides its amount.
struct FindingNumber {
    std::string name; ///< snake_case
    double value = 0.0;
    std::string unit = {}; ///< "": a count or text number
};

/// What a stage or a check found: a fault, a doubt, or what was done to the input.
struct Finding {
    FindingKind kind;
    std::int64_t feature = 0; ///< id in the file or arc_id; 0: none
    Vec2 where = nowhere;     ///< [m]
    double amount = 0.0;      ///< in the unit of the kind
    std::string text = {};    ///< one sentence without its full stop
    std::string remedy = {};  ///< likewise, what to do in this case; "": as the kind says
    std::string key = {};     ///< of the recipe, "surface.edge"
    std::string layer = {};   ///< name of the file, or of the file and its layer
    std::vector<FindingNumber> numbers = {};

    /// \return that of its kind
    Severity severity() const { return kind.row().severity; }
};

/// \return what to do: the finding's own remedy, or that of its kind, without its full stop; "": nothing
std::string remedy_of(Finding const& finding);

/// Formats a finding for people.
/// \return one line: "grid       512x512 cells of 30 m"; "warning: 2 lines lack heights. Give every vertex a height
/// [filled_heights]"
std::string line_of(Finding const& finding);

/// \return the texts of findings, in order
std::vector<std::string> texts_of(std::vector<Finding> const& findings);

/// Counts the warnings.
/// \return >= 0
std::int64_t warnings_in(std::vector<Finding> const& findings);

/// The direction of a limit.
enum class Bound : std::uint8_t { at_most, at_least };

constexpr char const* word_of(Bound bound) {
    return bound == Bound::at_least ? "at_least" : "at_most";
}

/// One entry of `checks` in report.json.
struct Check {
    std::string name;
    double value = 0.0;
    double limit = 0.0;
    bool ok = false;
    Bound bound = Bound::at_most;
};

} // namespace thalweg
