// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/find_rivers.hpp>

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/network/internal/rivers_layer.hpp>

namespace thalweg::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(std::string const& text) {
    throw BadInput("io.find_rivers: " + text);
}

/// The file with the rivers of a folder that thalweg wrote; "" where it is no such folder.
std::string network_in(fs::path const& folder) {
    if (fs::path const file = folder / "network.gpkg"; fs::exists(file)) {
        return file.string();
    }
    std::vector<fs::path> arcs;
    std::vector<fs::path> packages;
    for (auto const& entry : fs::directory_iterator(folder)) {
        std::string const ending = entry.path().extension().string();
        bool const of_layers = ending == ".shp" || ending == ".fgb" || ending == ".geojson";
        if (of_layers && entry.path().stem().string().ends_with("_arcs")) {
            arcs.push_back(entry.path());
        } else if (ending == ".gpkg") {
            packages.push_back(entry.path());
        }
    }
    if (arcs.empty() && !fs::exists(folder / "recipe.toml")) { // whose only package would hold contours
        arcs = std::move(packages);
    }
    return arcs.size() == 1 ? arcs.front().string() : "";
}

/// Why a folder that GDAL does not open holds no rivers.
std::string why_not(fs::path const& folder) {
    if (fs::is_empty(folder)) {
        return "the folder is empty";
    }
    if (fs::exists(folder / "recipe.toml")) {
        return "its terrain has no rivers; to make it again, give its recipe.toml";
    }
    return "it holds neither network.gpkg, nor one other GeoPackage, nor shapefiles; name a file in it";
}

bool names_database(std::string const& path) {
    return path.starts_with("PG:") || path.starts_with("postgresql:");
}

} // namespace

RiverSource find_rivers(std::string const& path) {
    std::error_code ignored;
    RiverSource source{path, ""};
    while (source.path.size() > 1 && source.path.ends_with('/')) {
        source.path.pop_back();
    }
    bool const is_file = !names_database(path) && !path.starts_with("/vsi");
    if (is_file && !fs::exists(path, ignored)) {
        refuse(fmt::format("{} does not exist", path));
    }
    bool const is_folder = is_file && fs::is_directory(path, ignored);
    if (is_file && !is_folder && fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) == 0) {
        refuse(path + " is empty");
    }
    if (is_folder) {
        if (std::string const network = network_in(source.path); !network.empty()) {
            source.path = network;
        }
    }
    Driver const driver;
    Dataset const data = open_undisturbed(source.path, GDAL_OF_VECTOR | GDAL_OF_RASTER);
    if (!data) {
        std::string const words = driver.take();
        refuse(is_folder && source.path.size() <= path.size()
                   ? fmt::format("{} holds no rivers: {}", path, why_not(path))
                   : fmt::format("{} is not a file with lines that GDAL can read{}", source.path,
                                 words.empty() ? "" : " (" + words + ")"));
    }
    if (data->GetLayerCount() == 0 && data->GetRasterCount() > 0) {
        refuse(fmt::format("{} is a raster, not river lines", source.path));
    }
    require_lines(*data, source.path, "io.find_rivers");
    source.layer = data->GetLayerByName("arcs") != nullptr ? "arcs" : "";
    return source;
}

} // namespace thalweg::io
