// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace thalweg::surface {

/// Options of increments().
struct IncrementParams {
    std::string increment = "rise_fall"; ///< uniform | decreasing | rise_fall | an expression in x such as 3-0.01*x
    bool allow_negative = false;         ///< false: increments below 0 count as 0
    /// replaces a name or expression: a pure function, called with x >= 1 by one thread at a time
    std::function<double(double x)> function = {};
};

/// Evaluates the increments dh(x) of the dilations x = 1 ... levels.
/// \param levels [0, ...] number of dilations
/// \return by x - 1, in the units of \cite cao2009 (Table 1 for its three names); an expression or function is rounded
/// to 2^-32 (from 16 up, to 36 significant bits), the same on every machine
/// \throws BadParameter for an unknown name that is not an expression, or a value that is not finite; what the function
/// throws
///
/// Source: \cite cao2009, Table 1.
std::vector<double> increments(std::int64_t levels, IncrementParams const& params = {});

/// A jump of dh(x).
struct IncrementJump {
    double x = 0.0;    ///< [dilations]
    double from = 0.0; ///< [unit of Cao, Long and Lü] increment before it
    double to = 0.0;   ///< [unit of Cao, Long and Lü] increment after it
};

/// Finds the jumps of dh(x) between 1 and levels: slopes break there on every hillside at once.
/// \param levels [0, ...] number of dilations
/// \return ascending; jumps of more than a hundredth of the largest increment that bisection of x does not reduce; none
/// for the names of Table 1
/// \throws Error as increments()
///
/// Source: \cite cao2009, Table 1, whose increments in two parts meet where they change.
std::vector<IncrementJump> increment_jumps(std::int64_t levels, IncrementParams const& params = {});

/// The names of built-in increments.
/// \return in the order of messages
std::vector<std::string> increment_names();

/// Sums increments to heights above the valley.
/// \param increments [m] dh(x), x = 1, 2, ...
/// \return [m] by d = 0 ... levels: H(d) = dh(1) + ... + dh(d)
std::vector<double> heights_above_valley(std::vector<double> const& increments);

} // namespace thalweg::surface
