// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <string_view>

namespace thalweg {

/// An interval of numbers. NaN lies in none.
struct Range {
    /// \return every finite number
    static constexpr Range finite();
    /// \param low low
    /// \return finite numbers greater than low
    static constexpr Range above(double low);
    /// \param low low
    /// \return finite numbers from low
    static constexpr Range at_least(double low);
    /// \param low low
    /// \param high high
    /// \return numbers from low to high
    static constexpr Range between(double low, double high);
    /// \param low low
    /// \param high high
    /// \return numbers greater than low and less than high
    static constexpr Range inside(double low, double high);

    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool has_low = false;  ///< low itself belongs to the range
    bool has_high = false; ///< high itself belongs to the range

    constexpr bool contains(double value) const noexcept {
        return (value > low && value < high) || (has_low && value == low) || (has_high && value == high);
    }

    /// \return the same with infinity, for parameters where it means "no limit".
    constexpr Range or_infinite() const noexcept { return {low, high, has_low, true}; }
};

constexpr Range Range::finite() {
    return {};
}
constexpr Range Range::above(double low) {
    return {low, std::numeric_limits<double>::infinity(), false, false};
}
constexpr Range Range::at_least(double low) {
    return {low, std::numeric_limits<double>::infinity(), true, false};
}
constexpr Range Range::between(double low, double high) {
    return {low, high, true, true};
}
constexpr Range Range::inside(double low, double high) {
    return {low, high, false, false};
}

/// Checks one parameter. Takes the function that checks ("module.function"), the parameter's name for users, its value
/// and its unit ("" for a number without).
/// \param function the function that checks, "module.function"
/// \param name the parameter's name for users
/// \param value the value
/// \param range the range
/// \param unit its unit; "": none
/// \throws BadParameter "module.function: NAME is VALUE UNIT; it must be RANGE", unless the range contains the value
void require_in(std::string_view function, std::string_view name, double value, Range const& range,
                std::string_view unit = {});

void require_in(std::string_view function, std::string_view name, std::int64_t value, Range const& range,
                std::string_view unit = {});

template <std::integral Whole>
void require_in(std::string_view function, std::string_view name, Whole value, Range const& range,
                std::string_view unit = {}) {
    require_in(function, name, static_cast<std::int64_t>(value), range, unit);
}

} // namespace thalweg
