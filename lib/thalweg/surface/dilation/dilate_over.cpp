// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/dilate_over.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/surface/dilation/internal/flat_share.hpp>

#include <cmath>
#include <utility>

namespace thalweg::surface {

namespace {

/// The same valley at height 0: what is dilated from it is H(d) alone.
Valley levelled(Valley const& valley, Raster<float> const& base) {
    if (base.grid() != valley.z.grid()) {
        throw BadInput("surface.dilate_over: the base has another frame than the valley; lay it on the valley's grid");
    }
    Valley level = valley;
    for (float& z : level.z.values()) {
        z = std::isnan(z) ? z : 0.0F;
    }
    return level;
}

Dilated on_base(Dilated rise, Valley const& valley, Raster<float> const& base, Run const& run) {
    for (std::int64_t i = 0; i < base.cells(); ++i) {
        float const river = valley.z[i];
        rise.dem[i] = std::isnan(river) || std::isnan(rise.dem[i]) ? base[i] + rise.dem[i] : river;
    }
    rise.flat_share = flat_share(valley, rise.dem, run);
    return rise;
}

} // namespace

Dilated dilate_over(Valley const& valley, Raster<float> const& base, DilateParams const& params, Run const& run) {
    return on_base(dilate(levelled(valley, base), params, run), valley, base, run);
}

Dilated dilate_over(Valley const& valley, Raster<float> const& base, Mask const& inside, DilateParams const& params,
                    Run const& run) {
    return on_base(dilate(levelled(valley, base), inside, params, run), valley, base, run);
}

} // namespace thalweg::surface
