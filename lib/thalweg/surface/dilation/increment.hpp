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
    bool allow_negative = false;         ///< without it increments below 0 count as 0
    std::function<double(double x)> function = {}; ///< of the caller, instead of a name or an expression: a pure
                                                   ///< function, called for x >= 1, by one thread at a time
};

/// The increment dh(x) of the x-th dilation, x = 1 .. levels, as values[x - 1], in the units of Cao, Long and Lü.
/// \param levels number of dilations
/// \param params options, each with its default, unit and range
/// \return Table 1 of Cao, Long and Lü 2009 for the three names; an expression or a function rounded to 2^-32 (from 16
/// up, to 36 significant bits), the same on every machine: a function gives the bytes of the expression it computes.
/// \throws BadParameter not a name (did you mean ...) and not an expression; a value that is not finite; what the
/// function throws
///
/// Source: \cite cao2009, Table 1.
std::vector<double> increments(std::int64_t levels, IncrementParams const& params = {});

/// A place where increments jump.
struct IncrementJump {
    double x = 0.0;    ///< dilations
    double from = 0.0; ///< increment before it, in the units of Cao, Long and Lü
    double to = 0.0;   ///< and behind it
};

/// Where dh(x) is not continuous between 1 and levels: slopes break there on every hillside at once.
/// \param levels as increments()
/// \param params options, each with its default, unit and range
/// \return jumps of more than a hundredth of the greatest increment that no bisection of x makes less, ascending; none
/// for the names of Table 1.
/// \throws Error as increments()
///
/// Source: \cite cao2009, Table 1, whose increments in two parts meet where they change.
std::vector<IncrementJump> increment_jumps(std::int64_t levels, IncrementParams const& params = {});

/// \return the increments that have a name, in the order of messages.
std::vector<std::string> increment_names();

/// \param increments [m] dh(x) of x = 1, 2, ...
/// \return sums H(d) = dh(1) + ... + dh(d), d = 0 .. levels.
std::vector<double> heights_above_valley(std::vector<double> const& increments);

} // namespace thalweg::surface
