// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace thalweg::skeleton {

/// The statistics of a random terrain in expectation; a realisation departs from them.
struct FieldParams {
    double mean = 0.0;      ///< [m]
    double std = 1.0;       ///< [m] >= 0
    double lx_cells = 20.0; ///< [cells] > 0, correlation length along rows
    double ly_cells = 20.0; ///< [cells] > 0, correlation length along columns
    std::uint64_t seed = 0;
};

/// Checks the statistics of a random terrain.
/// \param params any values
/// \param stage name of the stage, for messages
/// \throws BadParameter when a field is outside its range or not finite
void check(FieldParams const& params, char const* stage);

} // namespace thalweg::skeleton
