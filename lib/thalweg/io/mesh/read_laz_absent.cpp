// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled instead of read_laz.cpp where LASzip is not installed.
#include <filesystem>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/io/mesh/internal/read_las.hpp>

namespace thalweg::io {

std::unique_ptr<LasRecords> open_laz(LasHeader const& header) {
    std::string const plain = std::filesystem::path(header.path).replace_extension(".plain.las").string();
    throw BadInput(
        "io.read_points",
        fmt::format("{} is compressed (LAZ), and this thalweg was built without LASzip; decompress it: pdal translate "
                    "{} {}, or laszip -i {} -o {}; or install liblaszip-dev (Debian 13) and build again",
                    header.name, for_shell(header.path), for_shell(plain), for_shell(header.path), for_shell(plain)));
}

} // namespace thalweg::io
