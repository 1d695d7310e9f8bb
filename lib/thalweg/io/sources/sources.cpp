// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/sources/sources.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/crs/internal/units.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/mesh/internal/read_las.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/network/internal/read_network.hpp>
#include <thalweg/io/raster/internal/height_bands.hpp>
#include <thalweg/io/raster/internal/heightmap_files.hpp>
#include <thalweg/io/tables/internal/layers.hpp>

namespace thalweg::io {
namespace {

// For a layer of any geometry type the first feature decides, of a collection its first part.
OGRwkbGeometryType shape_of(OGRLayer& layer) {
    auto const type = wkbFlatten(layer.GetGeomType());
    if (type != wkbUnknown && type != wkbGeometryCollection) {
        return type;
    }
    OGRFeatureUniquePtr const first(layer.GetNextFeature());
    layer.ResetReading();
    OGRGeometry const* shape = first ? first->GetGeometryRef() : nullptr;
    if (shape != nullptr && wkbFlatten(shape->getGeometryType()) == wkbGeometryCollection && shape->IsEmpty() == 0) {
        shape = shape->toGeometryCollection()->getGeometryRef(0);
    }
    return shape == nullptr ? type : wkbFlatten(shape->getGeometryType());
}

bool is_of_lines(OGRwkbGeometryType type) {
    return OGR_GT_IsSubClassOf(type, wkbCurve) != 0 || OGR_GT_IsSubClassOf(type, wkbMultiCurve) != 0;
}

/// Whether a text has a column of lines, as well-known text.
bool holds_lines(Source const& source) {
    if (lower_case(std::filesystem::path(source.path).extension().string()) != ".csv") {
        return false;
    }
    Driver const driver;
    Dataset const data = open_unchanged(source, GDAL_OF_VECTOR);
    bool const holds = data != nullptr && data->GetLayerCount() == 1 &&
                       data->GetLayer(0)->GetLayerDefn()->GetGeomFieldCount() > 0 &&
                       is_of_lines(shape_of(*data->GetLayer(0)));
    driver.take();
    return holds;
}

struct Units {
    OGRSpatialReference crs;
    double height_m = 1.0;
    bool names_height = false; ///< the file specifies the unit of its heights
    bool has_heights = false;
    std::optional<FileBox> box; ///< of data that have positions
};

std::optional<FileBox> placed_box(GDALDataset& data) {
    std::array<double, 6> place{};
    if (data.GetGeoTransform(place.data()) != CE_None) {
        return std::nullopt;
    }
    double const east = place[0] + data.GetRasterXSize() * place[1];
    double const south = place[3] + data.GetRasterYSize() * place[5];
    return FileBox{{std::min(place[0], east), std::min(place[3], south)},
                   {std::max(place[0], east), std::max(place[3], south)}};
}

std::optional<FileBox> placed_box(OGRLayer& layer) {
    OGREnvelope box;
    return layer.GetExtent(&box) == OGRERR_NONE ? std::optional(FileBox{{box.MinX, box.MinY}, {box.MaxX, box.MaxY}})
                                                : std::nullopt;
}

OGRLayer* layer_of(GDALDataset& data, std::string const& wanted, std::string const& path) {
    try {
        return rivers_layers(data, wanted, {"io.conversions_of", path}).front();
    } catch (BadInput const&) { // it has points or polygons
        return data.GetLayerCount() > 0 ? data.GetLayer(0) : nullptr;
    }
}

Units units_of(GDALDataset& data, std::string const& wanted, std::string const& path, std::string const& source_crs) {
    Units units;
    if (data.GetRasterCount() > 0) {
        units.crs = crs_of_layer(data.GetSpatialRef(), ""); // its heights: findings of read_dem_file()
        units.box = placed_box(data);
    } else if (OGRLayer* const layer = layer_of(data, wanted, path)) {
        units.crs = crs_of_layer(layer->GetSpatialRef(), source_crs);
        units.height_m = height_unit_of(*layer, source_crs);
        units.names_height = layer->GetLayerDefn()->GetFieldIndex("z_unit") >= 0;
        units.has_heights = OGR_GT_HasZ(layer->GetGeomType()) != 0;
        units.box = placed_box(*layer);
    }
    units.names_height = units.names_height || has_vertical_unit(&units.crs);
    return units;
}

std::string unit_in_plan(OGRSpatialReference const& crs, std::optional<FileBox> const& box) {
    if (box && is_distorted(crs, *box)) {
        Vec2 const middle{0.5 * (box->low.x + box->high.x), 0.5 * (box->low.y + box->high.y)};
        auto const scale = GroundScale(crs).at(middle);
        return scale ? fmt::format("metres of {:.3g} m on the ground", scale->side_m) : "metres";
    }
    return crs.IsGeographic() != 0 ? "degrees" : words_for_unit(crs.GetLinearUnits());
}

Dataset copy_raster(GDALDataset& source, std::string const& path, GdalProgress& gdal_progress) {
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("BIGTIFF", "IF_SAFER");
    return Dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
        path.c_str(), &source, FALSE, options.List(), &GdalProgress::step, &gdal_progress));
}

/// \param more options of ogr2ogr
Dataset copy_layers(GDALDataset& source, std::vector<std::string> const& layers, std::string const& path,
                    GdalProgress& gdal_progress, std::vector<std::string> const& more = {}) {
    CPLStringList words;
    for (std::string const& word : more) {
        words.AddString(word.c_str());
    }
    // The columns for ids and geometries must not collide with the source's.
    for (char const* const word : {"-f", "GPKG", "-lco", "FID=thalweg_fid", "-lco", "GEOMETRY_NAME=thalweg_shape"}) {
        words.AddString(word);
    }
    for (std::string const& name : layers) {
        words.AddString(name.c_str());
    }
    std::unique_ptr<GDALVectorTranslateOptions, decltype(&GDALVectorTranslateOptionsFree)> const options(
        GDALVectorTranslateOptionsNew(words.List(), nullptr), &GDALVectorTranslateOptionsFree);
    GDALVectorTranslateOptionsSetProgress(options.get(), &GdalProgress::step, &gdal_progress);
    GDALDatasetH from = GDALDataset::ToHandle(&source);
    int wrong_use = FALSE;
    return Dataset(
        GDALDataset::FromHandle(GDALVectorTranslate(path.c_str(), nullptr, 1, &from, options.get(), &wrong_use)));
}

/// The names of the layers to copy; none: all.
std::vector<std::string> names_to_copy(GDALDataset& source, std::string const& wanted, std::string const& path) {
    if (wanted.empty()) {
        return {};
    }
    bool const is_one = source.GetLayerByName(wanted.c_str()) != nullptr;
    std::vector<std::string> names =
        is_one ? std::vector{wanted} : layer_names(rivers_layers(source, wanted, {"io.plain_copy", path}));
    for (OGRLayer* const layer : layers_of(source)) { // rivers run on through them
        bool const is_there = std::ranges::find(names, layer->GetName()) != names.end();
        if (!is_there && may_hold_lakes(*layer)) {
            names.emplace_back(layer->GetName());
        }
    }
    return names;
}

/// Adds the lakes of OpenStreetMap to a copy of its ways. Of its layers one is read at a time.
bool append_osm_lakes(std::string const& source, std::string const& path, GdalProgress& gdal_progress) {
    Dataset const data = open_unchanged(source, GDAL_OF_VECTOR);
    if (!data) {
        return false;
    }
    read_osm_layer(*data, "multipolygons");
    return copy_layers(*data, {"multipolygons"}, path, gdal_progress,
                       {"-update", "-where", "natural = 'water' OR landuse = 'reservoir'"}) != nullptr;
}

std::string stem_of(std::string const& source, std::string const& layer) {
    std::string stem = names_connection(source) ? layer : std::filesystem::path(source).stem().string();
    for (char& c : stem) {
        c = c == '/' ? '_' : c;
    }
    return stem.empty() ? "input" : stem;
}

} // namespace

FileContent content_of(Source const& source) {
    std::string const& path = source.path;
    FileContent content;
    std::error_code ignored;
    auto const network = std::filesystem::path(path) / "network.gpkg";
    bool const is_geodatabase = lower_case(std::filesystem::path(path).extension().string()) == ".gdb";
    bool const is_folder =
        std::filesystem::is_directory(path, ignored) && !(is_geodatabase && !std::filesystem::exists(network, ignored));
    content.path = is_folder ? network.string() : path;
    About const about{"io.content_of", content.path};
    if (is_text_of_points(content.path) && std::filesystem::exists(content.path, ignored) && !holds_lines(source)) {
        content.kind = FileContent::Kind::points;
        return content;
    }
    if (CloudFormat const cloud = cloud_format(content.path); cloud != CloudFormat::none) {
        if (cloud == CloudFormat::e57) {
            refuse_e57(content.path, "io.content_of");
        }
        require_allowed({content.path, source.access});
        content.kind = FileContent::Kind::points;
        return content;
    }
    Driver const driver;
    if (is_heightmap({content.path, source.access})) {
        return content;
    }
    Dataset const data = open_file({content.path, source.access}, GDAL_OF_RASTER | GDAL_OF_VECTOR, about);
    bool const has_variables = data->GetLayerCount() == 0 && data->GetMetadata("SUBDATASETS") != nullptr;
    if (data->GetRasterCount() > 0 || has_variables) {
        return content;
    }
    forget_archive(content.path, driver);
    bool has_points = false;
    bool has_lines = false;
    for (auto* const layer : data->GetLayers()) {
        auto const type = shape_of(*layer);
        driver.check(about.where, fmt::format("{}, layer {}", about.name, layer->GetName()));
        bool const is_line = is_of_lines(type);
        has_lines = has_lines || is_line;
        has_points = has_points || type == wkbPoint || type == wkbMultiPoint;
        if (is_line && std::string(layer->GetName()) == "arcs") {
            content.layer = "arcs";
        }
    }
    refuse_if<BadInput>(!has_lines && !has_points, about.where, "{} holds neither heights, nor points, nor lines",
                        about.name);
    content.kind = has_lines ? FileContent::Kind::lines : FileContent::Kind::points;
    return content;
}

bool has_layer(Source const& source, std::string const& layer) {
    std::error_code ignored;
    if (!std::filesystem::exists(source.path, ignored)) {
        return false;
    }
    Driver const driver;
    return open_file(source, GDAL_OF_VECTOR, {"io.has_layer", "io.has_layer"})->GetLayerByName(layer.c_str()) !=
           nullptr;
}

std::vector<std::string> dataset_files(Source const& source) {
    Driver const driver;
    if (is_heightmap(source)) {
        return heightmap_files(source);
    }
    Dataset const data = open_unchanged(source, GDAL_OF_RASTER | GDAL_OF_VECTOR);
    if (!data) {
        throw BadInput("io.dataset_files", source.path + " is not a vector or raster source");
    }
    if (inside_archive(source.path) != source.path) {
        return {source.path};
    }
    CPLStringList const list(data->GetFileList(), TRUE);
    std::vector<std::string> files;
    for (int i = 0; i < list.size(); ++i) {
        // GDAL 3.7 also lists files named by companions, wherever they are.
        if (VSIStatBufL status; VSIStatL(list[i], &status) == 0) {
            files.emplace_back(list[i]);
        }
    }
    if (!files.empty() && data->GetDescription() != source.path) { // it was read elsewhere: see UnchangedFile
        files = {source.path};
        if (std::error_code ignored; std::filesystem::exists(source.path + "-wal", ignored)) {
            files.push_back(source.path + "-wal");
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::string> conversions_of(Source const& source, std::string const& layer, std::string const& crs,
                                        std::string const& source_crs) {
    if (is_text_of_points(source.path) || is_point_cloud(source.path) || crs.empty()) {
        return {};
    }
    Driver const driver;
    Dataset const data = open_unchanged(source, GDAL_OF_RASTER | GDAL_OF_VECTOR);
    std::string const ignored = driver.take();
    if (!data) {
        return {};
    }
    Units const units = units_of(*data, layer, source.name(), source_crs);
    std::string const name = std::filesystem::path(source.name()).filename().string();
    std::vector<std::string> said;
    bool in_feet = false;
    if (units.crs.IsEmpty() == 0 && units.crs.IsLocal() == 0) {
        OGRSpatialReference plan(units.crs);
        plan.StripVertical();
        in_feet = plan.IsProjected() != 0 && std::fabs(plan.GetLinearUnits() - 1.0) > 1e-9;
        OGRSpatialReference target = read_reference(crs);
        target.StripVertical();
        if (name_of(plan) != name_of(target) && plan.IsSame(&target) == 0) {
            bool const is_code = crs.size() < 40; // EPSG:32631; otherwise the whole WKT
            said.push_back(fmt::format("{}: coordinates in {} ({}) are reprojected into {}", name,
                                       plan.GetName() == nullptr ? "its CRS" : plan.GetName(),
                                       unit_in_plan(plan, units.box),
                                       is_code || target.GetName() == nullptr ? crs : target.GetName()));
        }
    }
    if (std::fabs(units.height_m - 1.0) > 1e-9 && units.has_heights) {
        said.push_back(
            fmt::format("{}: heights in {} are converted into metres", name, words_for_unit(units.height_m)));
    } else if (in_feet && units.has_heights && !units.names_height) {
        said.push_back(fmt::format("{}: heights are treated as metres: no vertical CRS or unit says otherwise", name));
    }
    return said;
}

std::string plain_copy(std::string const& source, std::string const& layer, std::string const& folder, Run const& run) {
    Driver const driver;
    CPLConfigOptionSetter const date(date_option, fixed_date, false);
    unsigned const kinds = GDAL_OF_RASTER | GDAL_OF_VECTOR;
    std::string const file = file_of_part(source);
    Dataset data = file.empty() ? open_unchanged(source, kinds) : open_file(source, kinds, {"io.plain_copy", source});
    if (!data) {
        refuse_folder(source, {"io.plain_copy", source});
        throw BadInput("io.plain_copy", fmt::format("{} cannot be read: {}", source, driver.take()));
    }
    if (data->GetRasterCount() == 0 && data->GetLayerCount() == 0) {
        data = variable_of_heights(data, {"io.plain_copy", source});
    }
    MemoryFile const raster;
    bool const is_raster = data->GetRasterCount() > 0 && data->GetLayerCount() == 0;
    std::vector<std::string> const names = is_raster ? std::vector<std::string>() : names_to_copy(*data, layer, source);
    std::string const path = (std::filesystem::path(folder) /
                              (stem_of(file.empty() ? source : file, layer) + (is_raster ? ".tif" : ".gpkg")))
                                 .string();
    GdalProgress gdal_progress(run, "copy");
    Dataset copy =
        is_raster ? copy_raster(*data, raster.path(), gdal_progress) : copy_layers(*data, names, path, gdal_progress);
    gdal_progress.settle();
    bool done = copy != nullptr;
    copy.reset();
    if (done && layer == "lines" && is_osm_file(*data)) {
        done = append_osm_lakes(source, path, gdal_progress);
    }
    if (std::string const words = driver.take(); !done || !words.empty()) {
        throw BadInput("io.plain_copy", fmt::format("{} cannot be copied: {}", source, words));
    }
    if (is_raster) {
        write_text(path, raster.bytes());
    }
    return path;
}

} // namespace thalweg::io
