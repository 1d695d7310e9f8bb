// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/parameters.hpp>

#include <cmath>
#include <string>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg {
namespace {

std::string in_words(Range const& range) {
    bool const from = std::isfinite(range.low);
    bool const to = std::isfinite(range.high);
    if (from && to && range.has_low && range.has_high) {
        return fmt::format("between {} and {}", range.low, range.high);
    }
    std::string const low = from ? fmt::format("{} {}", range.has_low ? "at least" : "greater than", range.low) : "";
    std::string const high = to ? fmt::format("{} {}", range.has_high ? "at most" : "less than", range.high) : "";
    if (from && to) {
        return fmt::format("{} and {}", low, high);
    }
    return from || to ? low + high : "a finite number";
}

template <class Number>
void require_number_in(std::string_view function, std::string_view name, Number value, Range const& range,
                       std::string_view unit) {
    if (!range.contains(static_cast<double>(value))) {
        throw BadParameter(std::string(function), fmt::format("{} is {}{}{}; it must be {}", name, value,
                                                              unit.empty() ? "" : " ", unit, in_words(range)));
    }
}

} // namespace

void require_in(std::string_view function, std::string_view name, double value, Range const& range,
                std::string_view unit) {
    require_number_in(function, name, value, range, unit);
}

void require_in(std::string_view function, std::string_view name, std::int64_t value, Range const& range,
                std::string_view unit) {
    require_number_in(function, name, value, range, unit);
}

} // namespace thalweg
