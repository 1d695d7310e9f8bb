// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network_source.hpp>

#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/printable.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

bool is_shapefile(fs::path const& path) {
    return path.extension() == ".shp" || path.extension() == ".SHP";
}

bool is_database(std::string const& path) {
    return path.starts_with("PG:") || path.starts_with("postgresql:");
}

// "NAME_arcs" and "arcs" end in "arcs" and have their counterpart in "NAME_nodes" and "nodes".
bool ends_as(fs::path const& path, std::string_view layer) {
    std::string const stem = path.stem().string();
    return stem == layer || stem.ends_with(fmt::format("_{}", layer));
}

fs::path counterpart(fs::path const& path, std::string_view layer, std::string_view other) {
    std::string const stem = path.stem().string();
    return path.parent_path() /
           fmt::format("{}{}{}", stem.substr(0, stem.size() - layer.size()), other, path.extension().string());
}

NetworkPlace pair_of(fs::path const& path, bool whole) {
    std::error_code ignored;
    if (ends_as(path, "arcs")) {
        fs::path const nodes = counterpart(path, "arcs", "nodes");
        return {path.string(), whole || fs::exists(nodes, ignored) ? nodes.string() : ""};
    }
    if (ends_as(path, "nodes")) {
        return {counterpart(path, "nodes", "arcs").string(), path.string()};
    }
    if (whole) {
        throw BadInput(fmt::format("io.read_network: {} is neither NAME_arcs.shp nor NAME_nodes.shp", path.string()));
    }
    return {path.string(), ""};
}

// A line of GDAL's that says what is the matter with a database file, in our words.
[[noreturn]] void refuse(std::string const& what, std::string const& words) {
    auto const say = [&](std::string_view part) { return words.find(part) != std::string::npos; };
    if (say("database is locked")) {
        throw IoError(what + " is locked by another program; close it there and try again");
    }
    if (say("readonly database")) {
        throw IoError(what + " was left in the middle of a change (there is a -journal beside it); open it once with "
                             "the program that wrote it");
    }
    throw BadInput(fmt::format("{} cannot be read: {}", what, words));
}

Dataset open(std::string const& path, std::string const& what, Driver const& driver) {
    bool const database = is_database(path);
    if (std::error_code ignored; !database && !fs::exists(path, ignored)) {
        throw BadInput(what + " does not exist");
    }
    Dataset dataset = open_undisturbed(path, GDAL_OF_VECTOR);
    if (dataset == nullptr) {
        refuse(what, driver.take());
    }
    return dataset;
}

} // namespace

NetworkPlace find_network(std::string const& path, bool whole) {
    std::error_code error;
    if (is_database(path)) {
        return {path, path};
    }
    fs::path const file = path;
    if (!fs::is_directory(file, error) || file.extension() == ".gdb") {
        bool const in_pairs = is_shapefile(file) || (!whole && (ends_as(file, "arcs") || ends_as(file, "nodes")));
        return in_pairs ? pair_of(file, whole) : NetworkPlace{path, path};
    }
    if (fs::path const gpkg = file / "network.gpkg"; fs::exists(gpkg, error)) {
        return {gpkg.string(), gpkg.string()};
    }
    std::vector<fs::path> found;
    for (auto const& entry : fs::directory_iterator(file, error)) {
        if (is_shapefile(entry.path()) && ends_as(entry.path(), "arcs")) {
            found.push_back(entry.path());
        }
    }
    if (error) {
        throw IoError(fmt::format("io.read_network: {}: {}", path, error.message()));
    }
    if (found.size() != 1) {
        throw BadInput(fmt::format(
            "io.read_network: {} holds {} files NAME_arcs.shp and no network.gpkg: name the file", path, found.size()));
    }
    return pair_of(found.front(), true);
}

NetworkSource::NetworkSource(std::string const& path, Driver const& driver)
    : what_("io.read_network: " + without_passwords(path)), dataset_(open(path, what_, driver)) {}

OGRLayer* NetworkSource::layer(std::string const& name) const {
    return dataset_->GetLayerByName(name.c_str());
}

std::vector<OGRLayer*> NetworkSource::layers() const {
    std::vector<OGRLayer*> found;
    for (OGRLayer* const layer : dataset_->GetLayers()) {
        found.push_back(layer);
    }
    return found;
}

bool may_hold_lines(OGRLayer& layer) {
    auto const flat = wkbFlatten(layer.GetGeomType());
    return flat == wkbUnknown || flat == wkbGeometryCollection || OGR_GT_IsSubClassOf(flat, wkbCurve) != 0 ||
           OGR_GT_IsSubClassOf(flat, wkbMultiCurve) != 0;
}

} // namespace thalweg::io
