// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/crs/crs.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/access.hpp>

namespace thalweg::io {
namespace {

// GDAL reads a code's digits and ignores everything after them.
bool is_mistyped_code(std::string const& text) {
    return EQUALN(text.c_str(), "EPSG:", 5) && text.find_first_not_of("0123456789+", 5) != std::string::npos;
}

/// Whether PROJ finds its tables: checks a code that all of them contain.
bool has_database() {
    return OGRSpatialReference().importFromEPSG(4326) == OGRERR_NONE;
}

/// Longitudes and latitudes of the body that a CRS belongs to: of the Earth WGS 84.
OGRSpatialReference globe_of(OGRSpatialReference const& reference) {
    std::unique_ptr<OGRSpatialReference> const own(is_on_earth(reference) ? nullptr : reference.CloneGeogCS());
    OGRSpatialReference globe = own ? *own : read_reference("EPSG:4326");
    globe.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return globe;
}

double side_of_geographic(Grid const& grid, OGRSpatialReference const& reference) {
    double const unit = reference.GetAngularUnits(nullptr);
    double const latitude = 0.5 * (grid.north + grid.south()) * unit;
    if (!(std::fabs(latitude) < portable::pi / 2.0)) {
        throw BadInput("io.ground_cell", fmt::format("the middle of the grid lies at latitude {:.3f} degrees, not "
                                                     "between the poles; give the grid its true place",
                                                     latitude * 180.0 / portable::pi));
    }
    double const flattening = reference.GetInvFlattening() > 0.0 ? 1.0 / reference.GetInvFlattening() : 0.0;
    double const eccentricity_2 = flattening * (2.0 - flattening);
    double const sine = portable::sin(latitude);
    // Geometric mean of the radii of curvature along and across the meridian.
    double const radius =
        reference.GetSemiMajor() * std::sqrt(1.0 - eccentricity_2) / (1.0 - eccentricity_2 * sine * sine);
    return grid.cell_m * unit * radius * std::sqrt(portable::cos(latitude));
}

std::optional<std::string> crs_instead_of(OGRSpatialReference const& reference, Grid const& grid) {
    Driver const driver;
    return less_distorted(reference, {{grid.west, grid.south()}, {grid.east(), grid.north}}, "the grid");
}

// East may exceed 180, but not west + 360.
DegreeBox box_of(Grid const& grid, About const& about) {
    Driver const driver;
    OGRSpatialReference const from = read_reference(grid.crs);
    OGRSpatialReference const globe = globe_of(from);
    std::unique_ptr<OGRCoordinateTransformation> const turn(OGRCreateCoordinateTransformation(&from, &globe));
    DegreeBox box;
    constexpr int points_a_side = 21;
    if (!turn || turn->TransformBounds(grid.west, grid.south(), grid.east(), grid.north, &box.west, &box.south,
                                       &box.east, &box.north, points_a_side) == 0) {
        throw BadInput(about.where,
                       fmt::format("{} lies where its CRS has no longitude and latitude; check its position: {}",
                                   about.name, driver.take()));
    }
    if (box.east < box.west) {
        box.east += 360.0; // across the antimeridian
    }
    if (from.IsGeographic() != 0) { // a globe and half a cell is no strip at the antimeridian
        box.east = box.west + (grid.east() - grid.west) * from.GetAngularUnits(nullptr) * 180.0 / portable::pi;
    }
    return box;
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
        throw_refusal(take_refusal(), {"io.read_reference", "the CRS"});
        auto const words = driver.take();
        if (words.find("proj.db") != std::string::npos || !has_database()) {
            throw IoError("io.read_reference",
                          fmt::format("the CRS {} cannot be looked up: PROJ does not open its database ({}); memory is "
                                      "short, or proj-data is not installed",
                                      text.substr(0, 60), words));
        }
        throw BadInput("io.read_reference",
                       fmt::format("'{}' is not a coordinate system{}; give a code such as EPSG:32633, or WKT",
                                   text.substr(0, 60), words.empty() ? "" : " (" + words + ")"));
    }
    throw_refusal(take_refusal(), {"io.read_reference", "the CRS"});
    reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return reference;
}

OGRSpatialReference equal_area_around(double longitude_deg, double latitude_deg, OGRSpatialReference const* globe) {
    OGRSpatialReference centred;
    centred.SetProjCS(fmt::format("Equal area around {:.0f}, {:.0f}", longitude_deg, latitude_deg).c_str());
    if (globe != nullptr) {
        centred.CopyGeogCSFrom(globe);
    } else {
        centred.SetWellKnownGeogCS("WGS84");
    }
    centred.SetLAEA(latitude_deg, longitude_deg, 0.0, 0.0);
    centred.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return centred;
}

std::string metric_crs_around(OGRSpatialReference const& own, Vec2 middle_deg, double wide_deg) {
    constexpr double widest_zone_deg = 12.0;
    if (is_on_earth(own) && wide_deg <= widest_zone_deg && middle_deg.y >= -80.0 && middle_deg.y < 84.0) {
        return utm_zone(middle_deg.x, middle_deg.y);
    }
    OGRSpatialReference const globe = globe_of(own);
    return name_of(
        equal_area_around(std::round(middle_deg.x), std::round(middle_deg.y), is_on_earth(own) ? nullptr : &globe));
}

void require_half_a_globe(double west_deg, double east_deg, About const& about) {
    refuse_if<BadInput>(east_deg - west_deg > 180.0, about.where,
                        "{} reaches over {:.0f} degrees of longitude, from {:.4g} to {:.4g}: no projection in metres "
                        "serves all of it. Cut a part out (gdal_translate -projwin, ogr2ogr -clipsrc), or name a CRS "
                        "(--crs) where the command has that option",
                        about.name, east_deg - west_deg, west_deg, east_deg);
}

bool is_on_earth(OGRSpatialReference const& reference) {
    constexpr double least_m = 6.3e6;
    constexpr double most_m = 6.4e6;
    double const radius_m = reference.GetSemiMajor();
    return radius_m > least_m && radius_m < most_m;
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
    Driver const driver; // an unidentified CRS is not an error
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

std::string in_message(std::string const& crs) {
    constexpr std::size_t most = 60;
    return crs.empty()          ? "no CRS"
           : crs.size() <= most ? crs
                                : fmt::format("{}...", std::string_view(crs).substr(0, most));
}

int epsg_code(std::string const& crs) {
    constexpr std::string_view prefix = "EPSG:";
    if (!crs.starts_with(prefix) || crs.size() > prefix.size() + 6) {
        return 0;
    }
    int code = 0;
    for (char const digit : crs.substr(prefix.size())) {
        if (digit < '0' || digit > '9') {
            return 0;
        }
        code = 10 * code + (digit - '0');
    }
    return code;
}

std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return text;
}

std::string projected_crs(std::string const& text) {
    OGRSpatialReference reference = read_reference(text);
    reference.StripVertical();
    if (!is_projected_in_metres(reference)) {
        char const* unit = nullptr;
        reference.GetLinearUnits(&unit);
        throw BadInput("io.projected_crs",
                       fmt::format("{} is {}; give a projected one in metres, such as a UTM zone (EPSG:32633)",
                                   in_message(text),
                                   reference.IsGeographic() != 0  ? "geographic: its cells would not be square"
                                   : reference.IsProjected() != 0 ? fmt::format("in '{}'", unit)
                                                                  : "not projected"));
    }
    return name_of(reference);
}

std::string crs_in_words(std::string const& crs) {
    if (crs.empty()) {
        return "";
    }
    char const* const name = read_reference(crs).GetName();
    return name == nullptr || std::string_view(name) == "unnamed" || std::string_view(name) == "unknown" ? "" : name;
}

std::string utm_zone(double longitude_deg, double latitude_deg) {
    // Written so that NaN is rejected.
    refuse_if<BadInput>(!(std::fabs(longitude_deg) <= 360.0 && latitude_deg >= -80.0 && latitude_deg <= 84.0),
                        "io.utm_zone", "no UTM zone covers longitude {}, latitude {}; give the CRS of the grid",
                        longitude_deg, latitude_deg);
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
    // The position farthest from the central meridian and closest to the equator.
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

bool is_same_crs(std::string const& a, std::string const& b, About const& of_a, std::string const& of_b) {
    if (a.empty() != b.empty()) {
        throw BadInput(of_a.where,
                       fmt::format("{} has {}, {} has {}: assign the missing one (gdal_edit.py or ogr2ogr -a_srs "
                                   "EPSG:n)",
                                   of_a.name, in_message(a), of_b, in_message(b)));
    }
    if (a == b) {
        return true;
    }
    OGRSpatialReference first = read_reference(a);
    OGRSpatialReference second = read_reference(b);
    first.StripVertical();
    second.StripVertical();
    return first.IsSame(&second) != 0;
}

bool same_crs(std::string const& a, std::string const& b, std::string const& of_a, std::string const& of_b) {
    return is_same_crs(a, b, {"io.same_crs", of_a}, of_b);
}

bool same_size(Grid const& a, Grid const& b) {
    return std::fabs(a.cell_m - b.cell_m) <= 1e-6 * b.cell_m;
}

bool same_lattice(Grid const& a, Grid const& b) {
    constexpr double most_cells = 0.01;
    auto const is_whole = [&](double m) { return std::fabs(m / a.cell_m - std::round(m / a.cell_m)) <= most_cells; };
    return same_size(a, b) && is_whole(a.west - b.west) && is_whole(a.north - b.north);
}

bool same_cells(Grid const& a, Grid const& b) {
    double const most = 0.01 * a.cell_m;
    return a.width == b.width && a.height == b.height && std::fabs(a.west - b.west) <= most &&
           std::fabs(a.north - b.north) <= most && std::fabs(a.east() - b.east()) <= most &&
           std::fabs(a.south() - b.south()) <= most;
}

GroundCell ground_cell(Grid const& grid) {
    if (grid.crs.empty()) {
        return {GridUnit::unknown, grid.cell_m, ""};
    }
    OGRSpatialReference reference = read_reference(grid.crs);
    reference.StripVertical();
    if (reference.IsGeographic() != 0) {
        return {GridUnit::degrees, side_of_geographic(grid, reference), ""};
    }
    if (is_projected_in_metres(reference)) {
        if (auto other = crs_instead_of(reference, grid)) {
            Driver const driver;
            auto const middle =
                GroundScale(reference).at({0.5 * (grid.west + grid.east()), 0.5 * (grid.south() + grid.north)});
            return {GridUnit::distorted, grid.cell_m * (middle ? middle->side_m : 1.0), std::move(*other)};
        }
        return {GridUnit::metres, grid.cell_m, name_of(reference)};
    }
    return {GridUnit::other, grid.cell_m * reference.GetLinearUnits(), ""};
}

bool is_distorted(Grid const& grid) {
    if (grid.crs.empty()) {
        return false;
    }
    OGRSpatialReference reference = read_reference(grid.crs);
    reference.StripVertical();
    return is_projected_in_metres(reference) && crs_instead_of(reference, grid).has_value();
}

bool overlap_on_earth(Grid const& a, Grid const& b, std::string const& of_a, std::string const& of_b) {
    DegreeBox const p = box_of(a, {"io.overlap_on_earth", of_a});
    DegreeBox const q = box_of(b, {"io.overlap_on_earth", of_b});
    bool overlaps = false;
    for (double const turn : {-360.0, 0.0, 360.0}) {
        overlaps = overlaps || (p.west < q.east + turn && q.west + turn < p.east);
    }
    return overlaps && p.south < q.north && q.south < p.north;
}

double zone_stretch(Grid const& grid) {
    if (!utm_number(grid.crs)) {
        return 0.0;
    }
    try {
        return utm_stretch(grid.crs, box_of(grid, {"io.zone_stretch", "the grid"}));
    } catch (BadInput const&) { // too far away to be transformed
        return std::numeric_limits<double>::infinity();
    }
}

std::string metric_crs(Grid const& grid, std::string const& what) {
    if (is_projected_in_metres(read_reference(grid.crs))) {
        GroundCell const ground = ground_cell(grid);
        return ground.unit == GridUnit::distorted ? ground.crs : grid.crs;
    }
    About const about{"io.metric_crs", what};
    DegreeBox const box = box_of(grid, about);
    require_half_a_globe(box.west, box.east, about);
    return metric_crs_around(read_reference(grid.crs), {0.5 * (box.west + box.east), 0.5 * (box.south + box.north)},
                             box.east - box.west);
}

} // namespace thalweg::io
