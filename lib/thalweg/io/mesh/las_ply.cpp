// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/internal/las_ply.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/io/crs/internal/crs.hpp>

namespace thalweg::io {
namespace {

// Appends a field of this many bytes, padded with zeros.
void put_field(std::string& bytes, std::string_view words, std::size_t size) {
    bytes.append(words.substr(0, size));
    bytes.append(size - std::min(size, words.size()), '\0');
}

LasAxis axis_of(double low, double high, double scale) {
    LasAxis axis{scale, std::floor(0.5 * low + 0.5 * high)};
    constexpr double most = 2147483000.0;
    while (std::max(high - axis.offset, axis.offset - low) / axis.scale > most) {
        axis.scale *= 10.0;
    }
    return axis;
}

double scale_for(double short_way) {
    double steps = 1000.0; // per metre; a power of ten, so that the scale is the double nearest to one
    while (steps * short_way < 1000.0 && steps < 1e15) {
        steps *= 10.0;
    }
    return 1.0 / steps;
}

} // namespace

void put_ply_header(std::string& bytes, std::string const& crs, std::uint64_t vertices,
                    std::optional<std::uint64_t> faces, HeightUnit unit) {
    bytes += "ply\nformat binary_little_endian 1.0\ncomment thalweg\n";
    if (!crs.empty()) {
        bytes += fmt::format("comment crs {}\n", one_line(crs));
    }
    if (unit != HeightUnit::metre) {
        bytes += fmt::format("comment heights in {}\n", name_of(unit));
    }
    bytes += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", vertices);
    if (faces) {
        bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", *faces);
    }
    bytes += "end_header\n";
}

void put_ply_vertex(std::string& bytes, Vec3 vertex) {
    put_number(bytes, vertex.x);
    put_number(bytes, vertex.y);
    put_number(bytes, vertex.z);
}

std::int32_t LasAxis::whole(double v) const {
    return static_cast<std::int32_t>(std::floor((v - offset) / scale + 0.5));
}

LasFrame las_frame(PointExtent const& extent, std::uint32_t count, double short_way) {
    double const scale = scale_for(short_way);
    LasFrame frame{axis_of(extent.low.x, extent.high.x, scale),
                   axis_of(extent.low.y, extent.high.y, scale),
                   axis_of(extent.low.z, extent.high.z, scale),
                   {},
                   count};
    for (Vec3 const p : {extent.low, extent.high}) {
        frame.extent.add(
            {frame.x.read(frame.x.whole(p.x)), frame.y.read(frame.y.whole(p.y)), frame.z.read(frame.z.whole(p.z))});
    }
    return frame;
}

void put_las_header(std::string& bytes, LasFrame const& frame, std::string const& crs) {
    constexpr std::uint16_t header_size = 227;
    constexpr std::uint32_t record_header_size = 54;
    constexpr std::uint16_t keys_size = 4 * 4 * 2; // a header and three keys of four shorts
    int const code = epsg_code(crs);
    bool const has_keys = code > 0 && code <= 32767;
    put_field(bytes, "LASF", 4);
    put_number(bytes, std::uint16_t{0}); // file source
    put_number(bytes, std::uint16_t{0}); // global encoding
    put_field(bytes, "", 16);            // project
    put_number(bytes, std::uint8_t{1});
    put_number(bytes, std::uint8_t{2});
    put_field(bytes, "EXTRACTION", 32);
    put_field(bytes, "thalweg", 32);
    put_number(bytes, std::uint16_t{1}); // day and year: fixed, so that files are reproducible
    put_number(bytes, std::uint16_t{2000});
    put_number(bytes, header_size);
    put_number(bytes, header_size + (has_keys ? record_header_size + keys_size : 0U));
    put_number(bytes, std::uint32_t{has_keys ? 1U : 0U});
    put_number(bytes, std::uint8_t{0}); // point format
    put_number(bytes, std::uint16_t{20});
    put_number(bytes, frame.count);
    put_number(bytes, frame.count); // by return: all are first returns
    for (int i = 0; i < 4; ++i) {
        put_number(bytes, std::uint32_t{0});
    }
    Vec3 const low = frame.extent.low;
    Vec3 const high = frame.extent.high;
    for (double const v : {frame.x.scale, frame.y.scale, frame.z.scale, frame.x.offset, frame.y.offset, frame.z.offset,
                           high.x, low.x, high.y, low.y, high.z, low.z}) {
        put_number(bytes, v);
    }
    if (has_keys) {
        put_number(bytes, std::uint16_t{0});
        put_field(bytes, "LASF_Projection", 16);
        put_number(bytes, std::uint16_t{34735}); // GeoKeyDirectoryTag
        put_number(bytes, keys_size);
        put_field(bytes, "GeoTIFF keys", 32);
        constexpr std::uint16_t model_type = 1024;
        constexpr std::uint16_t projected_crs = 3072;
        constexpr std::uint16_t linear_units = 3076;
        constexpr std::uint16_t metre = 9001;
        for (std::uint16_t const key :
             {std::uint16_t{1}, std::uint16_t{1}, std::uint16_t{0}, std::uint16_t{3}, //
              model_type, std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{1},       //
              projected_crs, std::uint16_t{0}, std::uint16_t{1}, static_cast<std::uint16_t>(code), linear_units,
              std::uint16_t{0}, std::uint16_t{1}, metre}) {
            put_number(bytes, key);
        }
    }
}

void put_las_point(std::string& bytes, LasFrame const& frame, Vec3 point, std::uint8_t classification) {
    put_number(bytes, frame.x.whole(point.x));
    put_number(bytes, frame.y.whole(point.y));
    put_number(bytes, frame.z.whole(point.z));
    put_number(bytes, std::uint16_t{0});   // intensity
    put_number(bytes, std::uint8_t{0x09}); // return 1 of 1
    put_number(bytes, classification);
    put_number(bytes, std::uint8_t{0});  // scan angle
    put_number(bytes, std::uint8_t{0});  // user data
    put_number(bytes, std::uint16_t{0}); // source
}

} // namespace thalweg::io
