// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/field_params.hpp>

#include <cmath>

#include <thalweg/core/run/range.hpp>

namespace thalweg::skeleton {

void check(FieldParams const& params, char const* stage) {
    require_in(stage, "mean height", params.mean, Range::finite(), "m");
    require_in(stage, "deviation", params.std, Range::at_least(0.0), "m");
    for (double const length : {params.lx_cells, params.ly_cells}) {
        require_in(stage, "correlation length", length, Range::above(0.0), "cells");
    }
}

} // namespace thalweg::skeleton
