// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/internal/ply.hpp>

#include <fmt/format.h>

#include <thalweg/io/files/internal/little_endian.hpp>
#include <thalweg/io/frame/internal/crs_text.hpp>

namespace thalweg::io {

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

} // namespace thalweg::io
