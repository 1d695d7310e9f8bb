// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <concepts>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

namespace thalweg {

/// An interval of numbers. It never contains NaN.
struct Range {
    /// Every finite number.
    /// \return (-infinity, infinity)
    static constexpr Range finite();
    /// Finite numbers above a limit.
    /// \param low excluded
    /// \return (low, infinity)
    static constexpr Range above(double low);
    /// Finite numbers from a limit.
    /// \param low included
    /// \return [low, infinity)
    static constexpr Range at_least(double low);
    /// A closed interval.
    /// \param low,high included
    /// \return [low, high]
    static constexpr Range between(double low, double high);
    /// An open interval.
    /// \param low,high excluded
    /// \return (low, high)
    static constexpr Range inside(double low, double high);

    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool has_low = false;  ///< low is included
    bool has_high = false; ///< high is included

    constexpr bool contains(double value) const noexcept {
        return (value > low && value < high) || (has_low && value == low) || (has_high && value == high);
    }

    /// Adds infinity, for parameters where it means "no limit".
    /// \return the same range, its upper end included
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

/// Checks that a parameter lies in its range.
/// \param function "module.function" that checks
/// \param name the parameter's name for users
/// \param value the parameter's value
/// \param range allowed values
/// \param unit "": none
/// \throws BadParameter "NAME is VALUE UNIT; it must be RANGE" unless the range contains the value
void require_in(std::string_view function, std::string_view name, double value, Range const& range,
                std::string_view unit = {});

void require_in(std::string_view function, std::string_view name, std::int64_t value, Range const& range,
                std::string_view unit = {});

template <std::integral Whole>
void require_in(std::string_view function, std::string_view name, Whole value, Range const& range,
                std::string_view unit = {}) {
    require_in(function, name, static_cast<std::int64_t>(value), range, unit);
}

/// A parameter without a default: code that leaves it out does not compile. Converts to its value.
template <class T> class Required {
public:
    constexpr Required(T value) : value_(std::move(value)) {} // implicit: {.cell_m = 30.0}
    constexpr operator T const&() const noexcept { return value_; }

private:
    T value_;
};

} // namespace thalweg
