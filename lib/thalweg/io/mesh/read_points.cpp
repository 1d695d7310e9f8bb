// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
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
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/mesh/internal/read_cloud.hpp>
#include <thalweg/io/mesh/internal/read_las.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/raster/internal/undeclared_nodata.hpp>

namespace thalweg::io {
namespace {

[[noreturn]] void refuse_points(std::string const& text) {
    throw BadInput("io.read_points", text);
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

std::optional<double> number_of_text(std::string_view text) {
    text = text.starts_with('+') ? text.substr(1) : text;
    double value = 0.0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool const whole = error == std::errc() && end == text.data() + text.size();
    return whole ? std::optional(value) : std::nullopt;
}

/// Columns of x, y and z, from 0.
using PointColumns = std::array<std::size_t, 3>;

std::string lowered_text(std::string_view text) {
    std::string small(text);
    std::ranges::transform(small, small.begin(), lowered);
    return small;
}

/// Parses text of points.
class PointText {
public:
    PointText(ReadPointsParams const& params, std::string const& name)
        : name_(name), wanted_(params.heights == PointHeights::wanted ? 3 : 2), offered_(params.columns.has_value()),
          height_(lowered_text(params.height_column.value_or(""))) {
        std::string const columns = params.columns.value_or("");
        if (columns.empty()) {
            return;
        }
        if (lowered_text(columns) == "pnezd") {
            names_ = {"3", "2", "4"};
        } else {
            for (std::string_view const column : split_fields(columns)) {
                names_.emplace_back(lowered_text(column));
            }
        }
        bool const is_right = names_.size() == 3 || names_.size() == wanted_;
        refuse_if<BadParameter>(
            !is_right || std::ranges::any_of(names_, &std::string::empty), "io.read_points",
            "'{}' does not name the columns of x, y and z: give three names or numbers, such as 3,2,4, or pnezd",
            columns);
    }

    /// Reads the first line.
    /// \return whether it has names
    bool begin(std::vector<std::string_view> const& fields) {
        bool const has_names = names_.empty() ? begin_unnamed(fields) : begin_named(fields);
        if (!height_.empty()) {
            columns_[2] = column_of(height_, fields);
        }
        return has_names;
    }

    Vec3 point(std::vector<std::string_view> const& fields, std::int64_t line) const {
        std::array<double, 3> values{};
        for (std::size_t k = 0; k < wanted_; ++k) {
            if (columns_[k] >= fields.size()) {
                refuse_points(
                    fmt::format("{}, line {}: {} of the columns, {} is missing", name_, line, fields.size(), "xyz"[k]));
            }
            auto const value = number_of_text(fields[columns_[k]]);
            if (!value || !std::isfinite(*value)) {
                refuse_points(fmt::format("{}, line {}: {} is '{}': a finite number is required", name_, line, "xyz"[k],
                                          fields[columns_[k]]));
            }
            values[k] = *value;
        }
        if (is_bare_ && fields.size() > 3) {
            refuse_points(fmt::format("{}, line {}: {} columns without names: which of them are x, y and z? Name them "
                                      "in a first line{}",
                                      name_, line, fields.size(), offer()));
        }
        return {values[0], values[1], values[2]};
    }

private:
    std::size_t column_of(std::string const& word, std::vector<std::string_view> const& fields) const {
        auto const at = std::ranges::find_if(fields, [&](std::string_view f) { return lowered_text(f) == word; });
        if (at == fields.end()) {
            refuse_points(fmt::format("{}, first line: no column '{}' ({})", name_, word, fmt::join(fields, ", ")));
        }
        return static_cast<std::size_t>(at - fields.begin());
    }

    std::string offer() const {
        return offered_ ? ", or by number (--columns 3,2,4; --columns pnezd for number, northing, easting, height, "
                          "description)"
                        : "";
    }

    bool begin_unnamed(std::vector<std::string_view> const& names) {
        if (std::ranges::all_of(names, [](std::string_view f) { return number_of_text(f).has_value(); })) {
            is_bare_ = true;
            return false;
        }
        for (std::size_t k = 0; k < (height_.empty() ? wanted_ : 2); ++k) {
            auto const is_it = [&](std::string_view f) { return f.size() == 1 && lowered(f[0]) == "xyz"[k]; };
            auto const at = std::ranges::find_if(names, is_it);
            if (at == names.end()) {
                refuse_points(
                    fmt::format("{}, first line: no column '{}'; name them x, y and z, or begin with three numbers{}",
                                name_, "xyz"[k], offer()));
            }
            columns_[k] = static_cast<std::size_t>(at - names.begin());
        }
        return true;
    }

    bool begin_named(std::vector<std::string_view> const& fields) {
        bool by_name = false;
        for (std::size_t k = 0; k < names_.size(); ++k) {
            std::size_t number = 0;
            std::string const& word = names_[k];
            auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
            if (error == std::errc() && end == word.data() + word.size() && number > 0) {
                columns_[k] = number - 1;
                continue;
            }
            columns_[k] = column_of(word, fields);
            by_name = true;
        }
        // If columns are given as numbers, a first line may still have names.
        return by_name ||
               std::ranges::none_of(columns_.begin(), columns_.begin() + static_cast<int>(wanted_), [&](std::size_t c) {
                   return c < fields.size() && number_of_text(fields[c]).has_value();
               });
    }

    std::string const& name_;
    std::size_t wanted_;
    bool offered_;
    std::string height_; ///< name of the column of heights; "": none is named
    std::vector<std::string> names_;
    PointColumns columns_{0, 1, 2};
    bool is_bare_ = false; ///< columns are neither named nor numbered
};

std::vector<Vec3> parse(std::string const& text, ReadPointsParams const& params, std::string const& name,
                        Run const& run) {
    PointText reader(params, name);
    std::vector<Vec3> points;
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
        bool const may_be_names = is_first;
        is_first = false;
        if (!may_be_names || !reader.begin(fields)) {
            points.push_back(reader.point(fields, line));
        }
    }
    return points;
}

/// Whether coordinates can only be longitudes and latitudes.
bool are_degrees(std::vector<Vec3> const& points) {
    return !points.empty() && std::ranges::all_of(points, [](Vec3 const& p) {
        bool const has_fraction = p.x != std::floor(p.x) || p.y != std::floor(p.y);
        return has_fraction && std::fabs(p.x) <= 180.0 && std::fabs(p.y) <= 90.0;
    });
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

void add(OGRGeometry const& geometry, double field_z, std::int64_t feature, std::string const& name, bool by_field,
         std::vector<Vec3>& points) {
    auto const flat = wkbFlatten(geometry.getGeometryType());
    if (flat == wkbMultiPoint) {
        for (auto const* const part : *geometry.toMultiPoint()) {
            add(*part, field_z, feature, name, by_field, points);
        }
        return;
    }
    if (flat != wkbPoint || geometry.IsEmpty() != 0) {
        refuse_points(fmt::format("feature {} of {} is {}, not a point", feature, name,
                                  geometry.IsEmpty() != 0 ? "empty" : OGRGeometryTypeToName(flat)));
    }
    auto const& p = *geometry.toPoint();
    double const z = p.Is3D() != 0 && !by_field ? p.getZ() : field_z;
    if (!std::isfinite(p.getX()) || !std::isfinite(p.getY()) || !std::isfinite(z)) {
        refuse_points(fmt::format("feature {} of {} lies at ({}, {}, {}): finite coordinates and a height are required",
                                  feature, name, p.getX(), p.getY(), z));
    }
    points.push_back({p.getX(), p.getY(), z});
}

/// The fields of a layer that hold numbers, whole or not.
std::vector<std::string> number_fields(OGRLayer& layer) {
    std::vector<std::string> names;
    for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i) {
        OGRFieldDefn const& field = *layer.GetLayerDefn()->GetFieldDefn(i);
        if (field.GetType() == OFTReal || field.GetType() == OFTInteger || field.GetType() == OFTInteger64) {
            names.emplace_back(field.GetNameRef());
        }
    }
    return names;
}

/// How to name a column of heights, where a user can and there is one; "": not.
std::string offered_columns(OGRLayer& layer, ReadPointsParams const& params) {
    std::vector<std::string> const names = number_fields(layer);
    return !params.height_column || names.empty() ? ""
                                                  : fmt::format("; if one of its fields holds heights, name it: {}{}",
                                                                params.height_option, fmt::join(names, " or "));
}

std::vector<Vec3> take(OGRLayer& layer, ReadPointsParams const& params, std::string const& name, Run const& run) {
    std::string const column = params.height_column.value_or("");
    std::string const& z_field = column.empty() ? params.z_field : column;
    bool const in_plan = params.heights == PointHeights::passed_over;
    int const field = in_plan ? -1 : layer.GetLayerDefn()->GetFieldIndex(z_field.c_str());
    if (!column.empty() && field < 0) {
        std::vector<std::string> const names = number_fields(layer);
        refuse_points(fmt::format("layer {} of {} has no field '{}'.{} (Fields with numbers: {})", layer.GetName(),
                                  name, column, did_you_mean(column, names), fmt::join(names, ", ")));
    }
    std::vector<Vec3> points;
    std::int64_t number = 0; // of the feature, from 1, as in other files: numbers of some formats begin with 0
    for (auto const& feature : layer) {
        run.check();
        ++number;
        auto const* const geometry = feature->GetGeometryRef();
        if (geometry == nullptr) {
            refuse_points(fmt::format("feature {} of {} has no point; remove it", number, name));
        }
        bool const has_field = field >= 0 && feature->IsFieldSetAndNotNull(field) != 0;
        if (!has_field && !in_plan && (geometry->Is3D() == 0 || !column.empty())) {
            refuse_points(column.empty()
                              ? fmt::format("feature {} of {} has no height: neither Z nor a field '{}'{}", number,
                                            name, z_field, offered_columns(layer, params))
                              : fmt::format("feature {} of {} has no value in its field '{}'", number, name, column));
        }
        std::optional<double> field_z = 0.0;
        if (has_field) {
            field_z = number_of_text(trimmed(feature->GetFieldAsString(field)));
            if (layer.GetLayerDefn()->GetFieldDefn(field)->GetType() == OFTReal) {
                field_z = feature->GetFieldAsDouble(field); // its text would be rounded
            }
        }
        if (!field_z) {
            refuse_points(fmt::format("feature {} of {}: {} is '{}', not a number", number, name, z_field,
                                      feature->GetFieldAsString(field)));
        }
        add(*geometry, *field_z, number, name, !column.empty(), points);
    }
    bool const all_zero = std::ranges::all_of(points, [](Vec3 const& p) { return p.z == 0.0; });
    if (std::string const offer = offered_columns(layer, params);
        !in_plan && column.empty() && all_zero && !offer.empty()) {
        refuse_points(fmt::format("all heights of layer {} of {} are 0{}", layer.GetName(), name, offer));
    }
    return points;
}

/// A height that stands for no data in other files, and no point near it: nothing, or where it is first.
std::optional<std::size_t> sentinel_among(std::vector<Vec3> const& points) {
    constexpr double coast_m = 300.0; // heights continue up to it, else
    for (double const sentinel : no_terrain) {
        auto const first = std::ranges::find(points, sentinel, &Vec3::z);
        bool const is_alone = first != points.end() && std::ranges::none_of(points, [&](Vec3 const& p) {
                                  return p.z != sentinel && std::fabs(p.z - sentinel) <= coast_m;
                              });
        if (is_alone) {
            return static_cast<std::size_t>(first - points.begin());
        }
    }
    auto const huge = std::ranges::find_if(points, [](Vec3 const& p) { return std::fabs(p.z) > 1e30; });
    return huge == points.end() ? std::nullopt : std::optional(static_cast<std::size_t>(huge - points.begin()));
}

void refuse_nodata(std::vector<Vec3> const& points, ReadPointsParams const& params, std::string const& name) {
    if (params.nodata || params.heights == PointHeights::passed_over) {
        return;
    }
    if (auto const at = sentinel_among(points)) {
        double const z = points[*at].z;
        refuse_points(fmt::format(
            "{} of {} points of {} have the height {:.9g}, the first at ({:.10g}, {:.10g}), and "
            "none is near it: does it stand for no data? {}",
            std::ranges::count(points, z, &Vec3::z), points.size(), name, z, points[*at].x, points[*at].y,
            params.height_column
                ? fmt::format("{}{:.9g} leaves them out{}", params.nodata_option, z,
                              params.nodata_option.starts_with("--nodata") ? ", --nodata nan keeps them" : "")
                : "Remove these points"));
    }
}

/// Leaves out the points whose height, as it is in the file, stands for no data.
std::vector<Vec3> without_nodata(std::vector<Vec3> points, ReadPointsParams const& params, std::string const& name,
                                 std::int64_t& left_out) {
    refuse_nodata(points, params, name);
    std::size_t const all = points.size();
    if (params.nodata && params.heights == PointHeights::wanted) {
        std::erase_if(points, [&](Vec3 const& p) { return stands_for(p.z, *params.nodata); });
    }
    left_out = static_cast<std::int64_t>(all - points.size());
    refuse_if<BadInput>(all > 0 && points.empty(), "io.read_points",
                        "all points of {} have the height {:.9g} of --nodata", name, params.nodata.value_or(0.0));
    return points;
}

FileBox extent_of(std::vector<Vec3> const& points) {
    FilePlaces places;
    for (Vec3 const p : points) {
        places.add(p.x, p.y);
    }
    return places.box();
}

/// Reprojects points from their CRS.
void reproject_points(FeaturePoints& read, OGRSpatialReference const& own, std::string const& wanted,
                      std::string const& name, Driver const& driver) {
    IntoMetres const metres(own, wanted, extent_of(read.points), name);
    read.crs = metres.crs();
    auto const done = metres.apply(read.points);
    for (std::size_t i = 0; i < done.size(); ++i) {
        if (done[i] == 0) {
            refuse_points(fmt::format("point {} of {}, ({}, {}), cannot be reprojected to {}: {}", i + 1, name,
                                      read.points[i].x, read.points[i].y, read.crs, driver.take()));
        }
        read.points[i].z *= metres.height_unit_m();
    }
}

FeaturePoints read_layer(ReadPointsParams const& params, std::string const& name, Run const& run) {
    Driver const driver;
    Dataset const data = open_file(params.path, GDAL_OF_VECTOR, {"io.read_points", params.path.path});
    OGRLayer& layer = choose_layer(*data, params.layer, name);
    FeaturePoints read;
    read.points = without_nodata(take(layer, params, name, run), params, name, read.left_out);
    driver.check("io.read_points", params.path.path);
    if (read.points.empty()) {
        return read;
    }
    OGRSpatialReference const own = crs_of_layer(layer.GetSpatialRef(), params.source_crs.value_or(""));
    if (own.IsEmpty() == 0) {
        reproject_points(read, own, params.crs, name, driver);
        return read;
    }
    if (params.crs.empty()) {
        refuse_points(fmt::format("layer {} of {} has no CRS; assign one (ogr2ogr -a_srs EPSG:n){}", layer.GetName(),
                                  name, params.source_crs ? " or name it (--source-crs EPSG:n)" : ""));
    }
    read.crs = projected_crs(params.crs);
    return read;
}

/// Brings points of a file that may have no CRS into metres.
void place_points(FeaturePoints& read, OGRSpatialReference const& own, ReadPointsParams const& params,
                  std::string const& name, Driver const& driver) {
    if (own.IsEmpty() == 0 && !read.points.empty()) {
        reproject_points(read, own, params.crs, name, driver);
        return;
    }
    if (params.source_crs && params.crs.empty() && are_degrees(read.points)) {
        refuse_points(fmt::format("the numbers of {} are longitudes and latitudes, by their size; name their CRS: "
                                  "--source-crs EPSG:4326. If they are metres, name it by --crs EPSG:n",
                                  name));
    }
    read.crs = params.crs.empty() ? "" : projected_crs(params.crs);
}

FeaturePoints read_point_text(ReadPointsParams const& params, std::string const& name, Run const& run) {
    constexpr std::int64_t most_bytes = std::int64_t{1} << 34;
    Driver const driver;
    FeaturePoints read;
    read.points =
        without_nodata(parse(read_text(params.path.path, most_bytes), params, name, run), params, name, read.left_out);
    place_points(read, crs_of_layer(nullptr, params.source_crs.value_or("")), params, name, driver);
    return read;
}

/// What becomes of the heights of a point cloud; nothing: they are in metres.
std::optional<Finding> heights_of_cloud(OGRSpatialReference const& own, std::string const& name) {
    bool const has_unit = has_vertical_unit(&own);
    OGRSpatialReference plan(own);
    double const height_m = has_unit ? plan.GetTargetLinearUnits("VERT_CS") : 1.0;
    plan.StripVertical();
    double const plan_m = plan.IsProjected() != 0 ? plan.GetLinearUnits() : 1.0;
    double const unit_m = has_unit ? height_m : plan_m;
    if (own.IsEmpty() != 0 || std::fabs(unit_m - 1.0) < 1e-9) {
        return std::nullopt;
    }
    return Finding{
        .kind = "heights_in_metres",
        .amount = height_m,
        .text = has_unit ? fmt::format("heights of {} in {} are converted into metres", name, words_for_unit(height_m))
                         : fmt::format("{} names no unit of its heights: they count as metres, and "
                                       "coordinates are in {}",
                                       name, words_for_unit(plan_m)),
        .layer = name};
}

FeaturePoints read_cloud_points(ReadPointsParams const& params, std::string const& name, Run const& run) {
    std::string const& path = params.path.path;
    if (cloud_format(path) == CloudFormat::e57) {
        refuse_e57(path, "io.read_points");
    }
    LasHeader const header = read_las_header(path);
    Driver const driver;
    OGRSpatialReference const file_crs = crs_of_las(header);
    OGRSpatialReference const own = crs_of_layer(&file_crs, params.source_crs.value_or(""));
    Cloud cloud = read_cloud(header, params, own, run);
    refuse_nodata(cloud.points, params, name);
    FeaturePoints read;
    read.points = std::move(cloud.points);
    read.findings = std::move(cloud.findings);
    read.left_out = cloud.left_out;
    if (auto heights = heights_of_cloud(own, name); heights && params.heights == PointHeights::wanted) {
        read.findings.push_back(*std::move(heights));
    }
    place_points(read, own, params, name, driver);
    return read;
}

/// Points at one position in plan, by number from 0.
using SamePlace = std::vector<std::size_t>;

/// The positions where points have different heights, in the order of their first points.
std::vector<SamePlace> places_of_two_heights(std::vector<Vec3> const& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(points[a].x, points[a].y, a) < std::tie(points[b].x, points[b].y, b);
    });
    std::vector<SamePlace> places;
    for (auto first = order.begin(); first != order.end();) {
        auto const last = std::find_if(first, order.end(),
                                       [&](std::size_t i) { return in_plan(points[i]) != in_plan(points[*first]); });
        if (std::any_of(first, last, [&](std::size_t i) { return points[i].z != points[*first].z; })) {
            places.emplace_back(first, last);
        }
        first = last;
    }
    std::ranges::sort(places, {}, [](SamePlace const& place) { return place.front(); });
    return places;
}

[[noreturn]] void refuse_two_heights(std::vector<SamePlace> const& places, std::vector<Vec3> const& points,
                                     std::string const& name) {
    constexpr std::size_t listed = 5;
    std::string list;
    for (std::size_t k = 0; k < std::min(listed, places.size()); ++k) {
        Vec3 const& p = points[places[k].front()];
        std::size_t const other = *std::ranges::find_if(places[k], [&](std::size_t i) { return points[i].z != p.z; });
        list += fmt::format("{}points {} and {} of {} lie both at ({:.10g}, {:.10g}), at heights of {:.10g} and "
                            "{:.10g} m",
                            k == 0 ? "" : "; ", places[k].front() + 1, other + 1, name, p.x, p.y, p.z, points[other].z);
    }
    refuse_points(places.size() == 1
                      ? list + "; keep one of them"
                      : fmt::format("{} has {} places where points have unequal heights; keep one point at each. The "
                                    "first are: {}",
                                    name, places.size(), list));
}

/// Gives every position one height.
void settle_duplicates(FeaturePoints& read, DuplicatePoints duplicates, std::string const& name) {
    std::vector<SamePlace> const places = places_of_two_heights(read.points);
    if (places.empty()) {
        return;
    }
    if (duplicates == DuplicatePoints::refused) {
        refuse_two_heights(places, read.points, name);
    }
    for (SamePlace const& place : places) {
        double sum = 0.0;
        double low = read.points[place.front()].z;
        double high = low;
        for (std::size_t const i : place) {
            sum += read.points[i].z;
            low = std::min(low, read.points[i].z);
            high = std::max(high, read.points[i].z);
        }
        for (std::size_t const i : place) {
            read.points[i].z = sum / static_cast<double>(place.size());
        }
        read.averaged_dz_m = std::max(read.averaged_dz_m, high - low);
    }
    read.averaged = static_cast<std::int64_t>(places.size());
}

/// Refuses options that do not apply to the file.
void refuse_unfit(ReadPointsParams const& params, bool is_cloud, std::string const& name) {
    refuse_if<BadParameter>(!params.columns.value_or("").empty() && !is_text_of_points(params.path.path),
                            "io.read_points", "{} is not text of points (.csv, .txt, .xyz): it has no columns to name",
                            name);
    refuse_if<BadParameter>(is_cloud && !params.height_column.value_or("").empty(), "io.read_points",
                            "{} is a point cloud: it has no column '{}' of heights", name,
                            params.height_column.value_or(""));
    refuse_if<BadParameter>(!is_cloud && !params.classes.value_or("").empty(), "io.read_points",
                            "{} is not a point cloud (LAS, LAZ): it has no classes", name);
    refuse_if<BadParameter>(!is_cloud && params.thin_m, "io.read_points",
                            "{} is not a point cloud (LAS, LAZ): other points are not thinned", name);
}

} // namespace

bool is_text_of_points(std::string const& path) {
    std::string const ending = lower_extension(path);
    return ending == ".csv" || ending == ".txt" || ending == ".xyz";
}

FeaturePoints read_points(ReadPointsParams const& params, Run const& run) {
    auto const name = std::filesystem::path(params.path.path).filename().string();
    bool const is_text = is_text_of_points(params.path.path);
    bool const is_cloud = !is_text && is_point_cloud(params.path.path);
    refuse_unfit(params, is_cloud, name);
    if (params.source_crs && !params.crs.empty() && read_reference(params.crs).IsGeographic() != 0) {
        refuse_points(fmt::format("{0} is in degrees, and the result lies in metres: if {1} is in it, name it by "
                                  "--source-crs {0}; --crs names the CRS of the result",
                                  params.crs, name));
    }
    if (is_text || is_cloud) {
        require_allowed(params.path);
    }
    FeaturePoints read = is_text    ? read_point_text(params, name, run)
                         : is_cloud ? read_cloud_points(params, name, run)
                                    : read_layer(params, name, run);
    if (read.points.empty()) {
        refuse_points(name + " holds no points");
    }
    if (params.heights == PointHeights::passed_over) {
        for (Vec3& p : read.points) {
            p.z = 0.0;
        }
    }
    settle_duplicates(read, params.duplicates, name);
    return read;
}

} // namespace thalweg::io
