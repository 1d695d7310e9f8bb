// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/conditioning/condition.hpp>

#include <utility>

#include <thalweg/flow/conditioning/internal/carve.hpp>
#include <thalweg/flow/conditioning/internal/confine_channels.hpp>
#include <thalweg/flow/conditioning/internal/fill.hpp>
#include <thalweg/flow/conditioning/internal/flood.hpp>

namespace thalweg::flow {

ConditionedDem condition(Raster<float> dem, Valley const& valley, ConditionParams const& params, Run const& run) {
    ConditionedDem out;
    if (params.method == Conditioning::none) {
        out.dem = std::move(dem);
        return out;
    }
    check_drainable(dem, valley);
    Banks const banks = confine_channels(dem, valley, {}, run);
    out.dem =
        params.method == Conditioning::fill ? fill(banks.dem, valley, run) : carve(banks.dem, valley, banks.least, run);
    out.banks = change_between(dem, banks.dem);
    out.depressions = change_between(banks.dem, out.dem);
    return out;
}

} // namespace thalweg::flow
