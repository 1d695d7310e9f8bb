// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/write_tin.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/files.hpp>
#include <thalweg/io/table.hpp>

namespace thalweg::io {
namespace {

// Appends to the bytes of a file.
class Bytes {
public:
    template <class... Values> void text(fmt::format_string<Values...> words, Values&&... values) {
        fmt::format_to(std::back_inserter(bytes_), words, std::forward<Values>(values)...);
    }
    // Little-endian.
    template <class T> void number(T value) {
        std::array<char, sizeof(T)> raw{};
        std::memcpy(raw.data(), &value, sizeof(T));
        if constexpr (std::endian::native == std::endian::big) {
            std::reverse(raw.begin(), raw.end());
        }
        bytes_.append(raw.data(), raw.size());
    }
    // A field of so many bytes, filled with zeros.
    void field(std::string_view words, std::size_t size) {
        bytes_.append(words.substr(0, size));
        bytes_.append(size - std::min(size, words.size()), '\0');
    }
    std::string const& str() const { return bytes_; }

private:
    std::string bytes_;
};

void require_whole(Tin const& tin, std::string const& what) {
    if (tin.vertices.empty()) {
        throw BadInput(what + ": the TIN has no vertices");
    }
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (tin.vertices.size() > most || tin.triangles.size() > most) {
        throw BadInput(fmt::format("{}: {} vertices and {} triangles: files number at most {}", what,
                                   tin.vertices.size(), tin.triangles.size(), most));
    }
    for (std::size_t i = 0; i < tin.vertices.size(); ++i) {
        Vec3 const& v = tin.vertices[i];
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
            throw BadInput(fmt::format("{}: vertex {} is not finite: ({}, {}, {})", what, i + 1, v.x, v.y, v.z));
        }
    }
    for (std::size_t i = 0; i < tin.triangles.size(); ++i) {
        auto const& t = tin.triangles[i];
        if (std::max({t[0], t[1], t[2]}) >= tin.vertices.size()) {
            throw BadInput(fmt::format("{}: triangle {} has vertex {} of {}", what, i + 1,
                                       std::max({t[0], t[1], t[2]}) + 1, tin.vertices.size()));
        }
    }
}

// The code of "EPSG:n", 0 for any other CRS.
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

// A comment must end where its line does.
std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return text;
}

void write_2dm(Bytes& out, Tin const& tin) {
    out.text("MESH2D\nMESHNAME \"tin\"\n");
    for (std::size_t i = 0; auto const& t : tin.triangles) {
        out.text("E3T {} {} {} {} 1\n", ++i, t[0] + std::size_t{1}, t[1] + std::size_t{1}, t[2] + std::size_t{1});
    }
    for (std::size_t i = 0; auto const& v : tin.vertices) {
        out.text("ND {} {} {} {}\n", ++i, v.x, v.y, v.z);
    }
}

void write_ply(Bytes& out, Tin const& tin, std::string const& crs, bool faces) {
    out.text("ply\nformat binary_little_endian 1.0\ncomment thalweg\n");
    if (!crs.empty()) {
        out.text("comment crs {}\n", one_line(crs));
    }
    out.text("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", tin.vertices.size());
    if (faces) {
        out.text("element face {}\nproperty list uchar int vertex_indices\n", tin.triangles.size());
    }
    out.text("end_header\n");
    for (auto const& v : tin.vertices) {
        out.number(v.x);
        out.number(v.y);
        out.number(v.z);
    }
    if (faces) {
        for (auto const& t : tin.triangles) {
            out.number(std::uint8_t{3});
            for (std::uint32_t const v : t) {
                out.number(static_cast<std::int32_t>(v));
            }
        }
    }
}

void write_obj(Bytes& out, Tin const& tin, std::string const& crs) {
    out.text("# thalweg\n");
    if (!crs.empty()) {
        out.text("# crs {}\n", one_line(crs));
    }
    for (auto const& v : tin.vertices) {
        out.text("v {} {} {}\n", v.x, v.y, v.z);
    }
    for (auto const& t : tin.triangles) {
        out.text("f {} {} {}\n", t[0] + std::size_t{1}, t[1] + std::size_t{1}, t[2] + std::size_t{1});
    }
}

void write_off(Bytes& out, Tin const& tin, std::string const& crs) {
    out.text("OFF\n");
    if (!crs.empty()) {
        out.text("# crs {}\n", one_line(crs));
    }
    out.text("{} {} 0\n", tin.vertices.size(), tin.triangles.size());
    for (auto const& v : tin.vertices) {
        out.text("{} {} {}\n", v.x, v.y, v.z);
    }
    for (auto const& t : tin.triangles) {
        out.text("3 {} {} {}\n", t[0], t[1], t[2]);
    }
}

std::string escaped(std::string const& text) {
    std::string safe;
    for (char const c : text) {
        safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    }
    return safe;
}

void write_landxml(Bytes& out, Tin const& tin, std::string const& crs) {
    out.text("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\" "
             "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
             "xsi:schemaLocation=\"http://www.landxml.org/schema/LandXML-1.2 "
             "http://www.landxml.org/schema/LandXML-1.2/LandXML-1.2.xsd\" "
             "date=\"2000-01-01\" time=\"00:00:00\" version=\"1.2\" language=\"English\" readOnly=\"false\">\n"
             "<Units><Metric areaUnit=\"squareMeter\" linearUnit=\"meter\" volumeUnit=\"cubicMeter\" "
             "temperatureUnit=\"celsius\" pressureUnit=\"HPA\"/></Units>\n");
    if (int const code = epsg_code(crs); code > 0) {
        out.text("<CoordinateSystem epsgCode=\"{}\"/>\n", code);
    } else if (!crs.empty()) {
        out.text("<CoordinateSystem ogcWktCode=\"{}\"/>\n", escaped(crs));
    }
    auto const [low, high] = std::ranges::minmax_element(tin.vertices, {}, &Vec3::z);
    out.text("<Application name=\"thalweg\"/>\n<Surfaces><Surface name=\"tin\">\n"
             "<Definition surfType=\"TIN\" elevMax=\"{}\" elevMin=\"{}\">\n<Pnts>\n",
             high->z, low->z);
    for (std::size_t i = 0; auto const& v : tin.vertices) {
        out.text("<P id=\"{}\">{} {} {}</P>\n", ++i, v.y, v.x, v.z);
    }
    out.text("</Pnts>\n<Faces>\n");
    for (auto const& t : tin.triangles) {
        out.text("<F>{} {} {}</F>\n", t[0] + std::size_t{1}, t[1] + std::size_t{1}, t[2] + std::size_t{1});
    }
    out.text("</Faces>\n</Definition>\n</Surface></Surfaces>\n</LandXML>\n");
}

void write_xyz(Bytes& out, Tin const& tin) {
    for (auto const& v : tin.vertices) {
        out.text("{} {} {}\n", v.x, v.y, v.z);
    }
}

// One axis of a LAS file: whole multiples of scale above offset.
struct Axis {
    double scale = 0.001;
    double offset = 0.0;
    double lowest = std::numeric_limits<double>::infinity(); // of what the file says, not of what was handed in
    double highest = -std::numeric_limits<double>::infinity();

    Axis(std::vector<Vec3> const& points, double Vec3::*part) {
        auto const [low, high] = std::ranges::minmax_element(points, {}, part);
        double const middle = 0.5 * ((*low).*part) + 0.5 * ((*high).*part);
        offset = std::floor(middle);
        constexpr double most = 2147483000.0;
        while (std::max((*high).*part - offset, offset - (*low).*part) / scale > most) {
            scale *= 10.0;
        }
        for (Vec3 const& p : points) {
            double const there = read(of(p.*part));
            lowest = std::min(lowest, there);
            highest = std::max(highest, there);
        }
    }
    std::int32_t of(double v) const { return static_cast<std::int32_t>(std::floor((v - offset) / scale + 0.5)); }
    double read(std::int32_t whole) const { return static_cast<double>(whole) * scale + offset; }
};

void write_las(Bytes& out, Tin const& tin, std::string const& crs) {
    constexpr std::uint16_t header_size = 227;
    constexpr std::uint32_t record_header_size = 54;
    constexpr std::uint16_t keys_size = 4 * 4 * 2; // a header and three keys of four shorts
    int const code = epsg_code(crs);
    bool const has_keys = code > 0 && code <= 32767;
    auto const count = static_cast<std::uint32_t>(tin.vertices.size());
    Axis const x(tin.vertices, &Vec3::x);
    Axis const y(tin.vertices, &Vec3::y);
    Axis const z(tin.vertices, &Vec3::z);
    out.field("LASF", 4);
    out.number(std::uint16_t{0}); // file source
    out.number(std::uint16_t{0}); // global encoding
    out.field("", 16);            // project
    out.number(std::uint8_t{1});
    out.number(std::uint8_t{2});
    out.field("EXTRACTION", 32);
    out.field("thalweg", 32);
    out.number(std::uint16_t{1}); // day and year: fixed, so that the bytes are
    out.number(std::uint16_t{2000});
    out.number(header_size);
    out.number(header_size + (has_keys ? record_header_size + keys_size : 0U));
    out.number(std::uint32_t{has_keys ? 1U : 0U});
    out.number(std::uint8_t{0}); // point format
    out.number(std::uint16_t{20});
    out.number(count);
    out.number(count); // by return: all are first
    for (int i = 0; i < 4; ++i) {
        out.number(std::uint32_t{0});
    }
    for (double const v : {x.scale, y.scale, z.scale, x.offset, y.offset, z.offset, x.highest, x.lowest, y.highest,
                           y.lowest, z.highest, z.lowest}) {
        out.number(v);
    }
    if (has_keys) {
        out.number(std::uint16_t{0});
        out.field("LASF_Projection", 16);
        out.number(std::uint16_t{34735}); // GeoKeyDirectoryTag
        out.number(keys_size);
        out.field("GeoTIFF keys", 32);
        constexpr std::uint16_t model_type = 1024;
        constexpr std::uint16_t projected_crs = 3072;
        constexpr std::uint16_t linear_units = 3076;
        constexpr std::uint16_t metre = 9001;
        for (std::uint16_t const key :
             {std::uint16_t{1}, std::uint16_t{1}, std::uint16_t{0}, std::uint16_t{3}, //
              model_type, std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{1},       //
              projected_crs, std::uint16_t{0}, std::uint16_t{1}, static_cast<std::uint16_t>(code), linear_units,
              std::uint16_t{0}, std::uint16_t{1}, metre}) {
            out.number(key);
        }
    }
    for (Vec3 const& p : tin.vertices) {
        out.number(x.of(p.x));
        out.number(y.of(p.y));
        out.number(z.of(p.z));
        out.number(std::uint16_t{0});   // intensity
        out.number(std::uint8_t{0x09}); // return 1 of 1
        out.number(std::uint8_t{2});    // ground
        out.number(std::uint8_t{0});    // scan angle
        out.number(std::uint8_t{0});    // user data
        out.number(std::uint16_t{0});   // source
    }
}

// The rows of layer faces; the TIN must outlive it.
Table faces_table(Tin const& tin) {
    auto const triangle = [&tin](std::int64_t row) { return tin.triangles[static_cast<std::size_t>(row)]; };
    auto const corner = [&tin, triangle](std::int64_t row, std::size_t k) { return tin.vertices[triangle(row)[k]]; };
    // Twice the area and the height's differences along both axes times it.
    auto const normal = [corner](std::int64_t row) {
        Vec3 const a = corner(row, 0);
        Vec3 const b = corner(row, 1);
        Vec3 const c = corner(row, 2);
        return Vec3{(b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y),
                    (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z),
                    (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)};
    };
    auto const vertex = [triangle](std::size_t k) {
        return [triangle, k](std::int64_t row) { return std::int64_t{triangle(row)[k]} + 1; };
    };
    using Kind = Column::Kind;
    return {"faces",
            Table::Shape::polygon,
            static_cast<std::int64_t>(tin.triangles.size()),
            {{"face_id", Kind::wide_integer, 0, [](std::int64_t row) { return row + 1; }},
             {"v1", Kind::wide_integer, 0, vertex(0)},
             {"v2", Kind::wide_integer, 0, vertex(1)},
             {"v3", Kind::wide_integer, 0, vertex(2)},
             {"area", Kind::real, 6, [normal](std::int64_t row) { return 0.5 * normal(row).z; }},
             {"slope", Kind::real, 15,
              [normal](std::int64_t row) {
                  Vec3 const n = normal(row);
                  return n.z > 0.0 ? std::sqrt(n.x * n.x + n.y * n.y) / n.z : 0.0;
              }}},
            [corner](std::int64_t row) {
                return std::vector<Vec3>{corner(row, 0), corner(row, 1), corner(row, 2), corner(row, 0)};
            }};
}

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

} // namespace

std::vector<TinFormatName> const& tin_formats() {
    static std::vector<TinFormatName> const formats{
        {TinFormat::mesh_2dm, "2dm", ".2dm"},      {TinFormat::ply, "ply", ".ply"},
        {TinFormat::geopackage, "gpkg", ".gpkg"},  {TinFormat::obj, "obj", ".obj"},
        {TinFormat::off, "off", ".off"},           {TinFormat::landxml, "landxml", ".xml"},
        {TinFormat::las, "las", ".las"},           {TinFormat::xyz, "xyz", ".xyz"},
        {TinFormat::ply_points, "ply-points", ""},
    };
    return formats;
}

TinFormat tin_format(std::string const& name, std::string const& path) {
    std::string known;
    for (TinFormatName const& f : tin_formats()) {
        bool const fits = name.empty() ? *f.ending != '\0' && lowered(path).ends_with(f.ending) : name == f.name;
        if (fits) {
            return f.format;
        }
        known += (known.empty() ? "" : ", ") + std::string(f.name);
    }
    throw BadParameter(name.empty()
                           ? fmt::format("io.write_tin: the name of {} says no format; name one of {}", path, known)
                           : fmt::format("io.write_tin: '{}' is no format; there are {}", name, known));
}

void write_tin(Tin const& tin, std::string const& crs, std::string const& path, TinFormat format, Run const& run) {
    require_whole(tin, "io.write_tin: " + path);
    run.check();
    Bytes out;
    switch (format) {
    case TinFormat::mesh_2dm: write_2dm(out, tin); break;
    case TinFormat::ply: write_ply(out, tin, crs, true); break;
    case TinFormat::geopackage: write_tables({faces_table(tin)}, crs, path, run); return;
    case TinFormat::obj: write_obj(out, tin, crs); break;
    case TinFormat::off: write_off(out, tin, crs); break;
    case TinFormat::landxml: write_landxml(out, tin, crs); break;
    case TinFormat::las: write_las(out, tin, crs); break;
    case TinFormat::ply_points: write_ply(out, tin, crs, false); break;
    case TinFormat::xyz: write_xyz(out, tin); break;
    }
    write_text(path, out.str());
}

} // namespace thalweg::io
