// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg::skeleton {

/// What a random terrain is like in expectation; one realisation departs from it.
struct FieldParams {
    double mean = 0.0;      ///< [m]
    double std = 1.0;       ///< [m] >= 0
    double lx_cells = 20.0; ///< [cells] > 0, correlation length along rows
    double ly_cells = 20.0; ///< [cells] > 0, correlation length along columns
    std::uint64_t seed = 0;
};

/// \param params options, each with its default, unit and range
/// \param stage the name of the stage that asks, for the message
/// \throws BadParameter when a field is out of range or not finite
void check(FieldParams const& params, char const* stage);

} // namespace thalweg::skeleton
