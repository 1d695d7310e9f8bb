// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/field_params.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>

namespace thalweg::skeleton {

void check(FieldParams const& params, char const* stage) {
    if (!std::isfinite(params.mean)) {
        throw BadParameter(fmt::format("{}: a mean height of {} m; it must be a number", stage, params.mean));
    }
    if (!(params.std >= 0.0 && std::isfinite(params.std))) {
        throw BadParameter(fmt::format("{}: a deviation of {} m; it must be at least 0", stage, params.std));
    }
    for (double const length : {params.lx_cells, params.ly_cells}) {
        if (!(length > 0.0 && std::isfinite(length))) {
            throw BadParameter(
                fmt::format("{}: a correlation length of {} cells; it must be greater than 0", stage, length));
        }
    }
}

} // namespace thalweg::skeleton
