// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/lattice_files.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/files/internal/files.hpp>
#include <thalweg/io/mesh/internal/las_ply.hpp>

namespace thalweg::io {
namespace {

void require_finite(LatticeMesh const& mesh, About const& about) {
    refuse_if<BadInput>(mesh.triangles.empty(), about.where, "{}: the mesh has no triangles", about.name);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        refuse_if<BadInput>(!is_finite(mesh.vertices[i]), about.where, "{}: vertex {} is not finite", about.name,
                            i + 1);
    }
}

/// Writes a large file part by part.
class MeshBytes {
public:
    MeshBytes(std::string const& path, About const& about, Run const& run) : file_(path, about), run_(run) {}

    std::string& bytes() { return bytes_; }
    void end_of_item(std::size_t item, std::size_t items) {
        if (bytes_.size() > part) {
            file_.append(bytes_);
            bytes_.clear();
            run_.at(static_cast<double>(item) / static_cast<double>(items), "write");
        }
    }
    void close() {
        file_.append(bytes_);
        file_.close();
    }

private:
    static constexpr std::size_t part = 1 << 22;
    NewFile file_;
    Run const& run_;
    std::string bytes_;
};

} // namespace

void write_stl(LatticeMesh const& mesh, std::string const& path, Run const& run, std::string const& unit) {
    About const about{"io.write_stl", path};
    require_finite(mesh, about);
    refuse_if<BadInput>(mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max(), about.where,
                        "{}: {} triangles: STL holds at most 2^32 - 1", about.name, mesh.triangles.size());
    MeshBytes out(path, about, run);
    std::string header = "thalweg, " + unit + ", Z up"; // must not begin with "solid": that would be text
    header.resize(80, ' ');
    out.bytes() += header;
    put_number(out.bytes(), static_cast<std::uint32_t>(mesh.triangles.size()));
    auto const put = [&](Vec3 v) {
        for (double const c : {v.x, v.y, v.z}) {
            put_number(out.bytes(), static_cast<float>(c));
        }
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        auto const& t = mesh.triangles[i];
        Vec3 const a = mesh.vertices[t[0]];
        Vec3 const b = mesh.vertices[t[1]];
        Vec3 const c = mesh.vertices[t[2]];
        Vec3 const normal = cross(b - a, c - a);
        double const length = norm(normal);
        put(length > 0.0 ? (1.0 / length) * normal : Vec3{});
        put(a);
        put(b);
        put(c);
        put_number(out.bytes(), std::uint16_t{0});
        out.end_of_item(i, mesh.triangles.size());
    }
    out.close();
}

void write_textured_obj(LatticeMesh const& mesh, std::string const& path, ObjNames const& names, Run const& run) {
    About const about{"io.write_textured_obj", path};
    require_finite(mesh, about);
    refuse_if<BadInput>(mesh.places.size() != mesh.vertices.size(), about.where,
                        "{}: the mesh has no places in a picture", about.name);
    MeshBytes out(path, about, run);
    auto const text = [&]<class... Values>(fmt::format_string<Values...> words, Values&&... values) {
        fmt::format_to(std::back_inserter(out.bytes()), words, std::forward<Values>(values)...);
    };
    text("# thalweg; metres, Y up: x eastwards, y height, z southwards\n");
    if (!names.crs.empty()) {
        text("# crs {}\n", one_line(names.crs));
    }
    text("# origin {} {} {} (east, north, height)\n", mesh.origin.x, mesh.origin.y, mesh.origin.z);
    if (names.exaggeration != 1.0) {
        text("# exaggeration {} (of heights above the origin)\n", names.exaggeration);
    }
    text("mtllib {}\nusemtl {}\n", names.library, names.material);
    std::size_t const items = 2 * mesh.vertices.size() + mesh.triangles.size();
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        Vec3 const& v = mesh.vertices[i];
        // as 32-bit floats: readers keep no more
        text("v {} {} {}\n", static_cast<float>(v.x), static_cast<float>(v.z), static_cast<float>(-v.y) + 0.0F);
        out.end_of_item(i, items);
    }
    for (std::size_t i = 0; i < mesh.places.size(); ++i) {
        Vec2 const& p = mesh.places[i];
        text("vt {} {}\n", static_cast<float>(p.x), static_cast<float>(1.0 - p.y));
        out.end_of_item(mesh.vertices.size() + i, items);
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        auto const& t = mesh.triangles[i];
        text("f {0}/{0} {1}/{1} {2}/{2}\n", t[0] + std::size_t{1}, t[1] + std::size_t{1}, t[2] + std::size_t{1});
        out.end_of_item(2 * mesh.vertices.size() + i, items);
    }
    out.close();
}

} // namespace thalweg::io
