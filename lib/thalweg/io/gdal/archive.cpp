// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/internal/archive.hpp>

#include <filesystem>
#include <string_view>
#include <system_error>

#include <cpl_string.h>
#include <cpl_vsi.h>

namespace thalweg::io {

std::string inside_archive(std::string const& path) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    std::string const ending = fs::path(path).extension().string();
    if ((ending != ".zip" && ending != ".ZIP") || !fs::is_regular_file(path, ignored)) {
        return path;
    }
    std::string inside = "/vsizip/{" + path + "}";
    constexpr int deepest = 4;
    for (int level = 0; level < deepest; ++level) {
        CPLStringList const entries(VSIReadDir(inside.c_str()), TRUE);
        VSIStatBufL status;
        if (entries.size() != 1 || VSIStatL((inside + "/" + entries[0]).c_str(), &status) != 0) {
            break;
        }
        inside += std::string("/") + entries[0];
        if (VSI_ISDIR(status.st_mode) == 0) {
            break;
        }
    }
    return inside;
}

} // namespace thalweg::io
