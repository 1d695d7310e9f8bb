// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/drainage/drain.hpp>

#include <utility>

#include <thalweg/surface/drainage/internal/carve.hpp>
#include <thalweg/surface/drainage/internal/fill.hpp>
#include <thalweg/surface/drainage/internal/flood.hpp>
#include <thalweg/surface/drainage/internal/raise_banks.hpp>

namespace thalweg::surface {

DrainedLand drain(Raster<float> dem, Valley const& valley, DrainParams const& params, Run const& run) {
    DrainedLand out;
    if (params.method == Drain::none) {
        out.dem = std::move(dem);
        return out;
    }
    check_drainable(dem, valley);
    Banks const banks = raise_banks(dem, valley, {}, run);
    out.dem = params.method == Drain::fill ? fill(banks.dem, valley, run) : carve(banks.dem, valley, banks.least, run);
    out.banks = change_between(dem, banks.dem);
    out.depressions = change_between(banks.dem, out.dem);
    return out;
}

} // namespace thalweg::surface
