// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/frame/internal/spatial_reference.hpp>

#include <cmath>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/gdal_guard.hpp>

namespace thalweg::io {

namespace {

// GDAL reads the digits of a code and passes over what follows them.
bool is_mistyped_code(std::string const& text) {
    return EQUALN(text.c_str(), "EPSG:", 5) && text.find_first_not_of("0123456789+", 5) != std::string::npos;
}

/// Whether PROJ finds its tables: a code that each of them has is known.
bool has_database() {
    return OGRSpatialReference().importFromEPSG(4326) == OGRERR_NONE;
}

} // namespace

OGRSpatialReference read_reference(std::string const& text) {
    Driver const driver;
    CPLStringList options;
    options.SetNameValue("ALLOW_NETWORK_ACCESS", "NO");
    options.SetNameValue("ALLOW_FILE_ACCESS", "NO");
    OGRSpatialReference reference;
    take_refusal();
    if (text.empty() || is_mistyped_code(text) ||
        reference.SetFromUserInput(text.c_str(), options.List()) != OGRERR_NONE) {
        throw_refusal(take_refusal(), "io.read_reference: the CRS");
        auto const words = driver.take();
        if (words.find("proj.db") != std::string::npos || !has_database()) {
            throw IoError(
                fmt::format("io.read_reference: the CRS {} cannot be looked up: PROJ does not open its database "
                            "({}); memory is short, or proj-data is not installed",
                            text.substr(0, 60), words));
        }
        throw BadInput(
            fmt::format("io.read_reference: '{}' is not a coordinate system{}; give a code such as EPSG:32633, "
                        "or WKT",
                        text.substr(0, 60), words.empty() ? "" : " (" + words + ")"));
    }
    throw_refusal(take_refusal(), "io.read_reference: the CRS");
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return reference;
}

OGRSpatialReference equal_area_around(double longitude_deg, double latitude_deg) {
    OGRSpatialReference centred;
    centred.SetProjCS(fmt::format("Equal area around {:.0f}, {:.0f}", longitude_deg, latitude_deg).c_str());
    centred.SetWellKnownGeogCS("WGS84");
    centred.SetLAEA(latitude_deg, longitude_deg, 0.0, 0.0);
    centred.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return centred;
}

std::string name_of(OGRSpatialReference const& reference) {
    auto const code_of = [](OGRSpatialReference const& r) -> std::string {
        char const* const authority = r.GetAuthorityName(nullptr);
        char const* const code = r.GetAuthorityCode(nullptr);
        return authority != nullptr && code != nullptr && std::string(authority) == "EPSG" ? std::string("EPSG:") + code
                                                                                           : std::string();
    };
    if (auto code = code_of(reference); !code.empty()) {
        return code;
    }
    Driver const driver; // that it is not identified is no error
    OGRSpatialReference identified(reference);
    if (identified.AutoIdentifyEPSG() == OGRERR_NONE) {
        if (auto code = code_of(identified); !code.empty()) {
            return code;
        }
    }
    CPLStringList options;
    options.SetNameValue("FORMAT", "WKT2_2019");
    char* text = nullptr;
    reference.exportToWkt(&text, options.List());
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

bool is_projected_in_metres(OGRSpatialReference const& reference) {
    return reference.IsProjected() != 0 && std::fabs(reference.GetLinearUnits() - 1.0) < 1e-12;
}

} // namespace thalweg::io
