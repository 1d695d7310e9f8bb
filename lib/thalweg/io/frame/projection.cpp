// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/projection.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/frame/internal/crs_text.hpp>
#include <thalweg/io/frame/internal/spatial_reference.hpp>

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

std::optional<int> utm_number(std::string const& crs) {
    int const code = epsg_code(crs);
    int const zone = code - (code > 32700 ? 32700 : 32600);
    return zone >= 1 && zone <= 60 ? std::optional(zone) : std::nullopt;
}

double utm_stretch(std::string const& crs, DegreeBox const& box) {
    auto const zone = utm_number(crs);
    if (!zone) {
        return 0.0;
    }
    constexpr double scale = 0.9996; // on the central meridian
    constexpr double radian = portable::pi / 180.0;
    double const central = 6.0 * *zone - 183.0;
    // Farthest from the central meridian, nearest to the equator.
    double const latitude =
        box.south <= 0.0 && box.north >= 0.0 ? 0.0 : std::min(std::fabs(box.south), std::fabs(box.north));
    double stretch = 0.0;
    for (double const side : {box.west, box.east}) {
        double const off = std::fabs(std::remainder(side - central, 360.0));
        double const sine = portable::cos(latitude * radian) * portable::sin(std::min(off, 90.0) * radian);
        double const length =
            off >= 90.0 || sine >= 1.0 ? std::numeric_limits<double>::infinity() : scale / std::sqrt(1.0 - sine * sine);
        stretch = std::max(stretch, length - 1.0);
    }
    return stretch;
}

} // namespace thalweg::io
