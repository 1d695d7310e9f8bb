// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/spatial_reference.hpp>

#include <array>

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/error.hpp>

namespace thalweg::io {

void set_reference(OGRSpatialReference& reference, std::string const& crs) {
    reference.Clear();
    if (crs.empty()) {
        return;
    }
    // PROJ stays silent about a text it cannot read when only the return value is asked.
    std::array<char const*, 3> constexpr options{"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
    if (reference.SetFromUserInput(crs.c_str(), options.data()) != OGRERR_NONE) {
        throw BadInput(fmt::format("io.set_reference: '{}' is not a coordinate system: give EPSG:n or WKT", crs));
    }
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
}

std::string text_of(OGRSpatialReference const* reference) {
    if (reference == nullptr || reference->IsEmpty()) {
        return "";
    }
    char const* const name = reference->GetAuthorityName(nullptr);
    char const* const code = reference->GetAuthorityCode(nullptr);
    if (name != nullptr && code != nullptr) {
        return fmt::format("{}:{}", name, code);
    }
    char* wkt = nullptr;
    std::array<char const*, 2> constexpr options{"FORMAT=WKT2", nullptr};
    reference->exportToWkt(&wkt, options.data());
    std::string const text = wkt == nullptr ? "" : wkt;
    CPLFree(wkt);
    return text;
}

} // namespace thalweg::io
