// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/read_network.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/error.hpp>
#include <thalweg/io/dataset.hpp>
#include <thalweg/io/driver.hpp>

namespace thalweg::io {

namespace fs = std::filesystem;

namespace {

// The files of a network: a GeoPackage is both.
struct Place {
    fs::path arcs;
    fs::path nodes;
};

bool is_shapefile(fs::path const& path) {
    return path.extension() == ".shp" || path.extension() == ".SHP";
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

Place pair_of(fs::path const& path) {
    if (ends_as(path, "arcs")) {
        return {path, counterpart(path, "arcs", "nodes")};
    }
    if (ends_as(path, "nodes")) {
        return {counterpart(path, "nodes", "arcs"), path};
    }
    throw BadInput(fmt::format("io.read_network: {} is neither NAME_arcs.shp nor NAME_nodes.shp", path.string()));
}

Place find(fs::path const& path) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
        return is_shapefile(path) ? pair_of(path) : Place{path, path};
    }
    if (fs::path const whole = path / "network.gpkg"; fs::exists(whole, error)) {
        return {whole, whole};
    }
    std::vector<fs::path> found;
    for (auto const& entry : fs::directory_iterator(path, error)) {
        if (is_shapefile(entry.path()) && ends_as(entry.path(), "arcs")) {
            found.push_back(entry.path());
        }
    }
    if (error) {
        throw IoError(fmt::format("io.read_network: {}: {}", path.string(), error.message()));
    }
    if (found.size() != 1) {
        throw BadInput(
            fmt::format("io.read_network: {} holds {} files NAME_arcs.shp and no network.gpkg: name the file",
                        path.string(), found.size()));
    }
    return pair_of(found.front());
}

class Layer {
public:
    Layer(fs::path const& path, char const* name, std::vector<char const*> const& fields)
        : what_("io.read_network: " + path.string()) {
        std::array<char const*, 3> constexpr drivers{"GPKG", "ESRI Shapefile", nullptr};
        dataset_ = open_file(path.string(), GDAL_OF_VECTOR, drivers.data(), what_);
        layer_ = is_shapefile(path) ? dataset_->GetLayer(0) : dataset_->GetLayerByName(name);
        if (layer_ == nullptr) {
            throw BadInput(fmt::format("{} has no layer {}", what_, name));
        }
        what_ += fmt::format(", layer {}", name);
        std::vector<std::string> missing;
        for (char const* const field : fields) {
            int const index = layer_->GetLayerDefn()->GetFieldIndex(field);
            columns_.push_back(index);
            if (index < 0) {
                missing.emplace_back(field);
                continue;
            }
            OGRFieldType const type = layer_->GetLayerDefn()->GetFieldDefn(index)->GetType();
            if (type != OFTInteger && type != OFTInteger64 && type != OFTReal) {
                throw BadInput(fmt::format("{}: field {} does not hold numbers", what_, field));
            }
        }
        if (!missing.empty()) {
            throw BadInput(fmt::format("{}: no field {}", what_, fmt::join(missing, ", ")));
        }
    }

    // Calls body(feature) for each feature of the layer, as many as its file announces.
    template <class Body> void each(Driver const& driver, Run const& run, Body const& body) {
        GIntBig const announced = layer_->GetFeatureCount();
        GIntBig read = 0;
        for (auto const& feature : *layer_) {
            run.check();
            body(*feature);
            ++read;
        }
        driver.check(what_);
        if (read != announced) {
            throw IoError(
                fmt::format("{}: {} of {} features could be read: the file is damaged", what_, read, announced));
        }
    }

    // A whole number from the field that was named k-th.
    std::int64_t number(OGRFeature const& feature, std::size_t k) const {
        int const field = columns_[k];
        char const* const name = feature.GetFieldDefnRef(field)->GetNameRef();
        if (!feature.IsFieldSetAndNotNull(field)) {
            refuse(feature, fmt::format("has no {}", name));
        }
        if (feature.GetFieldDefnRef(field)->GetType() == OFTReal) {
            double const value = feature.GetFieldAsDouble(field);
            constexpr double exact = 9007199254740992.0; // whole doubles are exact below 2^53
            if (!(std::fabs(value) < exact) || value != std::floor(value)) {
                refuse(feature, fmt::format("has {} {}, not a whole number", name, value));
            }
        }
        return feature.GetFieldAsInteger64(field);
    }

    Vec3 point(OGRFeature const& feature) const {
        auto const* const shape = feature.GetGeometryRef();
        if (shape == nullptr || wkbFlatten(shape->getGeometryType()) != wkbPoint || shape->IsEmpty()) {
            refuse(feature, "is not a point");
        }
        require_z(feature, *shape);
        OGRPoint const& p = *shape->toPoint();
        return {p.getX(), p.getY(), p.getZ()};
    }

    std::vector<Vec3> line(OGRFeature const& feature) const {
        auto const* shape = feature.GetGeometryRef();
        if (shape == nullptr) {
            return {};
        }
        if (wkbFlatten(shape->getGeometryType()) == wkbMultiLineString) {
            auto const& parts = *shape->toMultiLineString();
            if (parts.getNumGeometries() > 1) {
                refuse(feature, fmt::format("has {} parts: an arc is one line", parts.getNumGeometries()));
            }
            if (parts.IsEmpty()) {
                return {};
            }
            shape = parts.getGeometryRef(0);
        }
        if (wkbFlatten(shape->getGeometryType()) != wkbLineString) {
            refuse(feature, "is not a line");
        }
        if (!shape->IsEmpty()) {
            require_z(feature, *shape);
        }
        std::vector<Vec3> vertices;
        for (OGRPoint const& p : *shape->toLineString()) {
            vertices.push_back({p.getX(), p.getY(), p.getZ()});
        }
        return vertices;
    }

private:
    [[noreturn]] void refuse(OGRFeature const& feature, std::string const& why) const {
        throw BadInput(fmt::format("{}: feature {} {}", what_, feature.GetFID(), why));
    }
    void require_z(OGRFeature const& feature, OGRGeometry const& shape) const {
        if (shape.Is3D() == FALSE) {
            refuse(feature, "has no heights (Z)");
        }
    }

    std::string what_;
    Dataset dataset_;
    OGRLayer* layer_ = nullptr;
    std::vector<int> columns_;
};

} // namespace

NetworkFile read_network(std::string const& path, Run const& run) {
    Driver const driver;
    Place const place = find(path);
    NetworkFile file;
    Layer nodes(place.nodes, "nodes", {"node_id"});
    nodes.each(driver, run, [&](OGRFeature const& feature) {
        file.nodes.push_back({nodes.number(feature, 0), nodes.point(feature)});
    });
    Layer arcs(place.arcs, "arcs", {"arc_id", "from_node", "to_node", "ds_arc", "strahler", "shreve", "basin_id"});
    arcs.each(driver, run, [&](OGRFeature const& feature) {
        auto const number = [&](std::size_t k) { return arcs.number(feature, k); };
        file.arcs.push_back(
            {number(0), number(1), number(2), number(3), number(4), number(5), number(6), arcs.line(feature)});
    });
    return file;
}

} // namespace thalweg::io
