// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/internal/netcdf_axes.hpp>

#include <cmath>
#include <vector>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace thalweg::io {
namespace {

/// A coordinate variable's first value and step.
struct Axis {
    double first = 0.0;
    double step = 0.0;
};

std::optional<Axis> axis_in(Dataset const& data, std::string const& file, char const* variable, int count) {
    Driver const driver; // a missing variable is not an error
    Dataset const axis = open_part(data, fmt::format("NETCDF:\"{}\":{}", file, variable));
    if (axis == nullptr || count < 2 || axis->GetRasterXSize() != count || axis->GetRasterYSize() != 1) {
        return std::nullopt;
    }
    std::vector<double> places(static_cast<std::size_t>(count));
    if (axis->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, count, 1, places.data(), count, 1, GDT_Float64, 0, 0,
                                         nullptr) != CE_None) {
        return std::nullopt;
    }
    Axis const found{places.front(), (places.back() - places.front()) / (count - 1)};
    constexpr double most_off = 0.01; // [cells]
    for (std::size_t i = 0; i < places.size(); ++i) {
        double const off = places[i] - found.first - static_cast<double>(i) * found.step;
        if (!(std::fabs(off) <= most_off * std::fabs(found.step))) {
            return std::nullopt;
        }
    }
    return found.step != 0.0 ? std::optional(found) : std::nullopt;
}

} // namespace

std::optional<std::array<double, 6>> frame_of_variables(Dataset const& data) {
    if (data->GetDriver() == nullptr || !EQUAL(data->GetDriver()->GetDescription(), "netCDF")) {
        return std::nullopt;
    }
    std::string const part = file_of_part(data->GetDescription());
    std::string const file = part.empty() ? data->GetDescription() : part;
    auto const x = axis_in(data, file, "x", data->GetRasterXSize());
    auto const y = axis_in(data, file, "y", data->GetRasterYSize());
    if (!x || !y) {
        return std::nullopt;
    }
    // GDAL gives the rows of such a variable in reverse.
    double const last = y->first + (data->GetRasterYSize() - 1) * y->step;
    return std::array<double, 6>{x->first - 0.5 * x->step, x->step, 0.0, last + 0.5 * y->step, 0.0, -y->step};
}

std::string unit_of_axis(GDALDataset& data, std::string_view axis) {
    std::string const standard = fmt::format("#standard_name=projection_{}_coordinate", axis);
    for (CSLConstList line = data.GetMetadata(); line != nullptr && *line != nullptr; ++line) {
        std::string const text = *line;
        std::string const variable = text.substr(0, text.find('#'));
        if (simple_name(variable) == axis || text == variable + standard) {
            char const* const unit = data.GetMetadataItem((variable + "#units").c_str());
            return unit == nullptr ? "" : unit;
        }
    }
    return "";
}

} // namespace thalweg::io
