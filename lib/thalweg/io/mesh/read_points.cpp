// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/read_points.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/frame/internal/into_metres.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

namespace thalweg::io {
namespace {

[[noreturn]] void refuse_points(std::string const& text) {
    throw BadInput("io.read_points: " + text);
}

char lowered(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blank = " \t\r\"";
    auto const first = text.find_first_not_of(blank);
    return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> split_fields(std::string_view line) {
    char const mark = line.find(';') != std::string_view::npos   ? ';'
                      : line.find(',') != std::string_view::npos ? ','
                                                                 : ' ';
    std::vector<std::string_view> fields;
    while (!line.empty()) {
        auto const end = mark == ' ' ? line.find_first_of(" \t") : line.find(mark);
        auto const field = trimmed(line.substr(0, end));
        if (mark != ' ' || !field.empty()) {
            fields.push_back(field);
        }
        line = end == std::string_view::npos ? "" : line.substr(end + 1);
    }
    return fields;
}

std::optional<double> number(std::string_view text) {
    text = text.starts_with('+') ? text.substr(1) : text;
    double value = 0.0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool const whole = error == std::errc() && end == text.data() + text.size();
    return whole ? std::optional(value) : std::nullopt;
}

// Where x, y and z stand in a first line of names; nothing when it is one of numbers.
std::optional<std::array<std::size_t, 3>> columns_of(std::vector<std::string_view> const& names, std::size_t wanted,
                                                     std::string const& name) {
    if (std::ranges::all_of(names, [](std::string_view f) { return number(f).has_value(); })) {
        return std::nullopt;
    }
    std::array<std::size_t, 3> columns{};
    for (std::size_t k = 0; k < wanted; ++k) {
        auto const is_it = [&](std::string_view f) { return f.size() == 1 && lowered(f[0]) == "xyz"[k]; };
        auto const at = std::ranges::find_if(names, is_it);
        if (at == names.end()) {
            refuse_points(fmt::format(
                "{}, first line: no column '{}'; name them x, y and z, or begin with three numbers", name, "xyz"[k]));
        }
        columns[k] = static_cast<std::size_t>(at - names.begin());
    }
    return columns;
}

std::vector<Vec3> parse(std::string const& text, PointHeights heights, std::string const& name, Run const& run) {
    std::size_t const wanted = heights == PointHeights::wanted ? 3 : 2;
    std::vector<Vec3> points;
    std::array<std::size_t, 3> columns{0, 1, 2};
    std::string_view rest = text;
    rest = rest.starts_with("\xEF\xBB\xBF") ? rest.substr(3) : rest;
    bool is_first = true;
    for (std::int64_t line = 1; !rest.empty(); ++line) {
        if ((line & 0xffff) == 0) {
            run.check();
        }
        auto const end = rest.find('\n');
        auto const words = trimmed(rest.substr(0, end));
        rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
        if (words.empty() || words.front() == '#') {
            continue;
        }
        auto const fields = split_fields(words);
        if (is_first) {
            is_first = false;
            if (auto const named = columns_of(fields, wanted, name)) {
                columns = *named;
                continue;
            }
        }
        std::array<double, 3> values{};
        for (std::size_t k = 0; k < wanted; ++k) {
            if (columns[k] >= fields.size()) {
                refuse_points(
                    fmt::format("{}, line {}: {} of the columns, {} is missing", name, line, fields.size(), "xyz"[k]));
            }
            auto const value = number(fields[columns[k]]);
            if (!value || !std::isfinite(*value)) {
                refuse_points(fmt::format("{}, line {}: {} is '{}': a finite number is required", name, line, "xyz"[k],
                                          fields[columns[k]]));
            }
            values[k] = *value;
        }
        points.push_back({values[0], values[1], values[2]});
    }
    return points;
}

bool may_hold_points(OGRwkbGeometryType type) {
    auto const flat = wkbFlatten(type);
    return flat == wkbUnknown || flat == wkbPoint || flat == wkbMultiPoint;
}

OGRLayer& choose_layer(GDALDataset& data, std::string const& wanted, std::string const& name) {
    std::vector<OGRLayer*> found;
    std::string names;
    for (auto* const layer : data.GetLayers()) {
        names += (names.empty() ? "" : ", ") + std::string(layer->GetName());
        if (may_hold_points(layer->GetGeomType()) && (wanted.empty() || wanted == layer->GetName())) {
            found.push_back(layer);
        }
    }
    if (found.size() != 1) {
        refuse_points(found.empty() ? fmt::format("{} has no layer of points{} ({})", name,
                                                  wanted.empty() ? "" : " named '" + wanted + "'", names)
                                    : fmt::format("{} has {} layers of points; name one of them ({})", name,
                                                  found.size(), names));
    }
    return *found.front();
}

void add(OGRGeometry const& geometry, double field_z, std::int64_t feature, std::string const& name,
         std::vector<Vec3>& points) {
    auto const flat = wkbFlatten(geometry.getGeometryType());
    if (flat == wkbMultiPoint) {
        for (auto const* const part : *geometry.toMultiPoint()) {
            add(*part, field_z, feature, name, points);
        }
        return;
    }
    if (flat != wkbPoint || geometry.IsEmpty() != 0) {
        refuse_points(fmt::format("feature {} of {} is {}, not a point", feature, name,
                                  geometry.IsEmpty() != 0 ? "empty" : OGRGeometryTypeToName(flat)));
    }
    auto const& p = *geometry.toPoint();
    double const z = p.Is3D() != 0 ? p.getZ() : field_z;
    if (!std::isfinite(p.getX()) || !std::isfinite(p.getY()) || !std::isfinite(z)) {
        refuse_points(fmt::format("feature {} of {} lies at ({}, {}, {}): finite coordinates and a height are required",
                                  feature, name, p.getX(), p.getY(), z));
    }
    points.push_back({p.getX(), p.getY(), z});
}

std::vector<Vec3> take(OGRLayer& layer, ReadPointsParams const& params, std::string const& name, Run const& run) {
    std::string const& z_field = params.z_field;
    bool const in_plan = params.heights == PointHeights::passed_over;
    int const field = in_plan ? -1 : layer.GetLayerDefn()->GetFieldIndex(z_field.c_str());
    std::vector<Vec3> points;
    for (auto const& feature : layer) {
        run.check();
        auto const* const geometry = feature->GetGeometryRef();
        if (geometry == nullptr) {
            refuse_points(fmt::format("feature {} of {} has no point; remove it", feature->GetFID(), name));
        }
        bool const has_field = field >= 0 && feature->IsFieldSetAndNotNull(field) != 0;
        if (!has_field && !in_plan && geometry->Is3D() == 0) {
            refuse_points(fmt::format("feature {} of {} has no height: neither Z nor a field '{}'", feature->GetFID(),
                                      name, z_field));
        }
        std::optional<double> field_z = 0.0;
        if (has_field) {
            field_z = number(trimmed(feature->GetFieldAsString(field)));
            if (layer.GetLayerDefn()->GetFieldDefn(field)->GetType() == OFTReal) {
                field_z = feature->GetFieldAsDouble(field); // its text is rounded
            }
        }
        if (!field_z) {
            refuse_points(fmt::format("feature {} of {}: {} is '{}', not a number", feature->GetFID(), name, z_field,
                                      feature->GetFieldAsString(field)));
        }
        add(*geometry, *field_z, feature->GetFID(), name, points);
    }
    return points;
}

FileBox extent_of(std::vector<Vec3> const& points) {
    auto const [west, east] = std::ranges::minmax_element(points, {}, &Vec3::x);
    auto const [south, north] = std::ranges::minmax_element(points, {}, &Vec3::y);
    return {{west->x, south->y}, {east->x, north->y}};
}

FeaturePoints read_layer(ReadPointsParams const& params, std::string const& name, Run const& run) {
    Driver const driver;
    Dataset const data = open_file(params.path, GDAL_OF_VECTOR, "io.read_points: " + params.path);
    OGRLayer& layer = choose_layer(*data, params.layer, name);
    FeaturePoints read;
    read.points = take(layer, params, name, run);
    driver.check("io.read_points: " + params.path);
    if (read.points.empty()) {
        return read;
    }
    OGRSpatialReference const* const own = layer.GetSpatialRef();
    if (is_missing(own)) {
        if (params.crs.empty()) {
            refuse_points(
                fmt::format("layer {} of {} has no CRS; assign one (ogr2ogr -a_srs EPSG:n)", layer.GetName(), name));
        }
        read.crs = projected_crs(params.crs);
        return read;
    }
    IntoMetres const metres(*own, params.crs, extent_of(read.points), name);
    read.crs = metres.crs();
    auto const done = metres.apply(read.points);
    for (std::size_t i = 0; i < done.size(); ++i) {
        if (done[i] == 0) {
            refuse_points(fmt::format("point {} of {}, ({}, {}), cannot be reprojected to {}: {}", i + 1, name,
                                      read.points[i].x, read.points[i].y, read.crs, driver.take()));
        }
        read.points[i].z *= metres.height_unit_m();
    }
    return read;
}

/// One place has one height.
void refuse_two_heights(std::vector<Vec3> const& points, std::string const& name) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(points[a].x, points[a].y, a) < std::tie(points[b].x, points[b].y, b);
    });
    for (std::size_t k = 1; k < order.size(); ++k) {
        Vec3 const& p = points[order[k - 1]];
        Vec3 const& q = points[order[k]];
        if (plan(p) == plan(q) && p.z != q.z) {
            refuse_points(
                fmt::format("points {} and {} of {} lie both at ({:.10g}, {:.10g}), at heights of {:.10g} and "
                            "{:.10g} m; keep one of them",
                            order[k - 1] + 1, order[k] + 1, name, p.x, p.y, p.z, q.z));
        }
    }
}

} // namespace

bool is_text_of_points(std::string const& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::ranges::transform(ending, ending.begin(), lowered);
    return ending == ".csv" || ending == ".txt" || ending == ".xyz";
}

FeaturePoints read_points(ReadPointsParams const& params, Run const& run) {
    auto const name = std::filesystem::path(params.path).filename().string();
    FeaturePoints read;
    if (is_text_of_points(params.path)) {
        require_allowed(params.path);
        constexpr std::int64_t most_bytes = std::int64_t{1} << 34;
        read.points = parse(read_text(params.path, most_bytes), params.heights, name, run);
        read.crs = params.crs.empty() ? "" : projected_crs(params.crs);
    } else {
        read = read_layer(params, name, run);
    }
    if (read.points.empty()) {
        refuse_points(name + " holds no points");
    }
    if (params.heights == PointHeights::passed_over) {
        for (Vec3& p : read.points) {
            p.z = 0.0;
        }
    }
    refuse_two_heights(read.points, name);
    return read;
}

} // namespace thalweg::io
