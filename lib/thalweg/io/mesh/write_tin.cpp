// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/mesh/internal/las_ply.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/tables/table.hpp>

namespace thalweg::io {
namespace {

// Appends to the bytes of a file.
class Bytes {
public:
    template <class... Values> void text(fmt::format_string<Values...> words, Values&&... values) {
        fmt::format_to(std::back_inserter(bytes_), words, std::forward<Values>(values)...);
    }
    std::string& bytes() { return bytes_; }
    std::string const& str() const { return bytes_; }

private:
    std::string bytes_;
};

void require_whole(Tin const& tin, About const& about) {
    refuse_if<BadInput>(tin.vertices.empty(), about.where, "{}: the TIN has no vertices", about.name);
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    refuse_if<BadInput>(tin.vertices.size() > most || tin.triangles.size() > most, about.where,
                        "{}: {} vertices and {} triangles: files number at most {}", about.name, tin.vertices.size(),
                        tin.triangles.size(), most);
    for (std::size_t i = 0; i < tin.vertices.size(); ++i) {
        Vec3 const& v = tin.vertices[i];
        refuse_if<BadInput>(!is_finite(v), about.where, "{}: vertex {} is not finite: ({}, {}, {})", about.name, i + 1,
                            v.x, v.y, v.z);
    }
    for (std::size_t i = 0; i < tin.triangles.size(); ++i) {
        auto const& t = tin.triangles[i];
        if (std::max({t[0], t[1], t[2]}) >= tin.vertices.size()) {
            throw BadInput(about.where, fmt::format("{}: triangle {} has vertex {} of {}", about.name, i + 1,
                                                    std::max({t[0], t[1], t[2]}) + 1, tin.vertices.size()));
        }
    }
}

/// "heights in ft" after some words; empty for metres.
std::string unit_after(std::string const& before, HeightUnit unit, char const* after) {
    return unit == HeightUnit::metre ? "" : fmt::format("{}heights in {}{}", before, name_of(unit), after);
}

void write_2dm(Bytes& out, Tin const& tin, HeightUnit unit) {
    out.text("MESH2D\nMESHNAME \"tin{}\"\n", unit_after(", ", unit, ""));
    for (std::size_t i = 0; auto const& t : tin.triangles) {
        out.text("E3T {} {} {} {} 1\n", ++i, t[0] + std::size_t{1}, t[1] + std::size_t{1}, t[2] + std::size_t{1});
    }
    for (std::size_t i = 0; auto const& v : tin.vertices) {
        out.text("ND {} {} {} {}\n", ++i, v.x, v.y, v.z);
    }
}

void write_ply(Bytes& out, Tin const& tin, std::string const& crs, bool faces, HeightUnit unit) {
    put_ply_header(out.bytes(), crs, tin.vertices.size(),
                   faces ? std::optional<std::uint64_t>(tin.triangles.size()) : std::nullopt, unit);
    for (Vec3 const& v : tin.vertices) {
        put_ply_vertex(out.bytes(), v);
    }
    if (faces) {
        for (auto const& t : tin.triangles) {
            put_number(out.bytes(), std::uint8_t{3});
            for (std::uint32_t const v : t) {
                put_number(out.bytes(), static_cast<std::int32_t>(v));
            }
        }
    }
}

void write_obj(Bytes& out, Tin const& tin, std::string const& crs, HeightUnit unit) {
    out.text("# thalweg; Z up: x eastwards, y northwards, z height\n");
    if (!crs.empty()) {
        out.text("# crs {}\n", one_line(crs));
    }
    out.text("{}", unit_after("# ", unit, "\n"));
    for (auto const& v : tin.vertices) {
        out.text("v {} {} {}\n", v.x, v.y, v.z);
    }
    for (auto const& t : tin.triangles) {
        out.text("f {} {} {}\n", t[0] + std::size_t{1}, t[1] + std::size_t{1}, t[2] + std::size_t{1});
    }
}

void write_off(Bytes& out, Tin const& tin, std::string const& crs, HeightUnit unit) {
    out.text("OFF\n");
    if (!crs.empty()) {
        out.text("# crs {}\n", one_line(crs));
    }
    out.text("{}", unit_after("# ", unit, "\n"));
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

void write_las(Bytes& out, Tin const& tin, std::string const& crs) {
    PointExtent extent;
    for (Vec3 const& p : tin.vertices) {
        extent.add(p);
    }
    LasFrame const frame = las_frame(extent, static_cast<std::uint32_t>(tin.vertices.size()), 1.0);
    constexpr std::uint8_t ground = 2;
    put_las_header(out.bytes(), frame, crs);
    for (Vec3 const& p : tin.vertices) {
        put_las_point(out.bytes(), frame, p, ground);
    }
}

// The rows of layer faces; the TIN must outlive it.
Table faces_table(Tin const& tin) {
    auto const triangle = [&tin](std::size_t row) { return tin.triangles[row]; };
    auto const corner = [&tin, triangle](std::size_t row, std::size_t k) { return tin.vertices[triangle(row)[k]]; };
    // Twice the area vector.
    auto const normal = [corner](std::size_t row) {
        Vec3 const a = corner(row, 0);
        Vec3 const b = corner(row, 1);
        Vec3 const c = corner(row, 2);
        return Vec3{(b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y),
                    (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z),
                    (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)};
    };
    auto const vertex = [triangle](std::size_t k) {
        return [triangle, k](std::size_t row) { return std::int64_t{triangle(row)[k]} + 1; };
    };
    using Kind = Column::Kind;
    return {"faces",
            Table::Shape::polygon,
            tin.triangles.size(),
            {{"face_id", Kind::wide_integer, 0, [](std::int64_t row) { return row + 1; }},
             {"v1", Kind::wide_integer, 0, vertex(0)},
             {"v2", Kind::wide_integer, 0, vertex(1)},
             {"v3", Kind::wide_integer, 0, vertex(2)},
             {"area", Kind::real, 6, [normal](std::size_t row) { return 0.5 * normal(row).z; }},
             {"slope", Kind::real, 15,
              [normal](std::size_t row) {
                  Vec3 const n = normal(row);
                  return n.z > 0.0 ? std::sqrt(n.x * n.x + n.y * n.y) / n.z : 0.0;
              }}},
            [corner](std::size_t row) {
                return std::vector<Vec3>{corner(row, 0), corner(row, 1), corner(row, 2), corner(row, 0)};
            },
            {},
            polygon_style()};
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
    return format_of(tin_formats(), name, path, "io.write_tin");
}

void write_tin(Tin const& tin, std::string const& crs, std::string const& path, TinFormat format, HeightUnit unit,
               Run const& run) {
    require_whole(tin, {"io.write_tin", path});
    bool const keeps_unit = format == TinFormat::mesh_2dm || format == TinFormat::ply ||
                            format == TinFormat::ply_points || format == TinFormat::obj || format == TinFormat::off;
    if (unit != HeightUnit::metre && !keeps_unit) {
        throw BadParameter("io.write_tin",
                           fmt::format("{}: this format holds heights in metres, not in {}", path, name_of(unit)));
    }
    run.check();
    Bytes out;
    switch (format) {
    case TinFormat::mesh_2dm: write_2dm(out, tin, unit); break;
    case TinFormat::ply: write_ply(out, tin, crs, true, unit); break;
    case TinFormat::geopackage: write_tables({faces_table(tin)}, crs, path, run); return;
    case TinFormat::obj: write_obj(out, tin, crs, unit); break;
    case TinFormat::off: write_off(out, tin, crs, unit); break;
    case TinFormat::landxml: write_landxml(out, tin, crs); break;
    case TinFormat::las: write_las(out, tin, crs); break;
    case TinFormat::ply_points: write_ply(out, tin, crs, false, unit); break;
    case TinFormat::xyz: write_xyz(out, tin); break;
    }
    write_text(path, out.str());
}

} // namespace thalweg::io
