// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <thalweg/measure/laws/network_laws.hpp>
#include <thalweg/measure/relief/relief.hpp>

namespace thalweg::pipeline {

/// A law's figure as report.json and the page tell it.
struct LawRow {
    std::string_view key;
    std::string_view name;
    std::string_view unit;
    std::optional<double> value;                              ///< none where the network is too small to tell
    std::vector<std::pair<std::string_view, double>> details; ///< how it was found: r2, error, counts; NaN for unknown
    measure::NaturalRange const* nature = nullptr;            ///< null where no range was published
};

/// \param laws the laws
/// \return the laws one by one, always the same rows in the same order.
std::vector<LawRow> law_rows(measure::NetworkLaws const& laws);

} // namespace thalweg::pipeline
