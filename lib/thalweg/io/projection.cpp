// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/projection.hpp>

#include <cmath>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/crs_text.hpp>
#include <thalweg/io/spatial_reference.hpp>

namespace thalweg::io {
std::string projected_crs(std::string const& text) {
    OGRSpatialReference reference = read_reference(text);
    reference.StripVertical();
    if (!is_projected_in_metres(reference)) {
        char const* unit = nullptr;
        reference.GetLinearUnits(&unit);
        throw BadInput(fmt::format("io.projected_crs: {} is {}; give a projected one in metres, such as a UTM zone "
                                   "(EPSG:32633)",
                                   in_message(text),
                                   reference.IsGeographic() != 0  ? "geographic: its cells would not be square"
                                   : reference.IsProjected() != 0 ? fmt::format("in '{}'", unit)
                                                                  : "not projected"));
    }
    return name_of(reference);
}

std::string utm_zone(double longitude_deg, double latitude_deg) {
    // Written so that NaN is refused.
    if (!(std::fabs(longitude_deg) <= 360.0 && latitude_deg >= -80.0 && latitude_deg <= 84.0)) {
        throw BadInput(
            fmt::format("io.utm_zone: no UTM zone covers longitude {}, latitude {}; give the CRS of the grid",
                        longitude_deg, latitude_deg));
    }
    auto const zone = static_cast<int>(std::floor((longitude_deg + 180.0) / 6.0));
    return fmt::format("EPSG:{}", (latitude_deg < 0.0 ? 32701 : 32601) + ((zone % 60) + 60) % 60);
}

} // namespace thalweg::io
