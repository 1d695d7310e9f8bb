// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/plain_copy.hpp>

#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/gdal/internal/watch.hpp>
#include <thalweg/io/network/internal/layer_writer.hpp>

namespace thalweg::io {

namespace {

Dataset copy_raster(GDALDataset& source, std::string const& path, Watch& watch) {
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("BIGTIFF", "IF_SAFER");
    return Dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(path.c_str(), &source, FALSE,
                                                                                options.List(), &Watch::step, &watch));
}

Dataset copy_layers(GDALDataset& source, std::string const& layer, std::string const& path, Watch& watch) {
    CPLStringList words;
    // The names of the columns for numbers and shapes shall not meet one of the source's.
    for (char const* const word : {"-f", "GPKG", "-lco", "FID=thalweg_fid", "-lco", "GEOMETRY_NAME=thalweg_shape"}) {
        words.AddString(word);
    }
    if (!layer.empty()) {
        words.AddString(layer.c_str());
    }
    std::unique_ptr<GDALVectorTranslateOptions, decltype(&GDALVectorTranslateOptionsFree)> const options(
        GDALVectorTranslateOptionsNew(words.List(), nullptr), &GDALVectorTranslateOptionsFree);
    GDALVectorTranslateOptionsSetProgress(options.get(), &Watch::step, &watch);
    GDALDatasetH from = GDALDataset::ToHandle(&source);
    int wrong_use = FALSE;
    return Dataset(
        GDALDataset::FromHandle(GDALVectorTranslate(path.c_str(), nullptr, 1, &from, options.get(), &wrong_use)));
}

std::string stem_of(std::string const& source, std::string const& layer) {
    std::string stem = names_connection(source) ? layer : std::filesystem::path(source).stem().string();
    for (char& c : stem) {
        c = c == '/' ? '_' : c;
    }
    return stem.empty() ? "input" : stem;
}

} // namespace

std::string plain_copy(std::string const& source, std::string const& layer, std::string const& folder, Run const& run) {
    Driver const driver;
    FixedDate const date;
    Dataset const data = open_undisturbed(source, GDAL_OF_RASTER | GDAL_OF_VECTOR);
    if (!data) {
        throw BadInput(fmt::format("io.plain_copy: {} cannot be read: {}", source, driver.take()));
    }
    MemoryFile const raster;
    bool const is_raster = data->GetRasterCount() > 0 && data->GetLayerCount() == 0;
    std::string const path =
        (std::filesystem::path(folder) / (stem_of(source, layer) + (is_raster ? ".tif" : ".gpkg"))).string();
    Watch watch(run, "copy");
    Dataset copy = is_raster ? copy_raster(*data, raster.path(), watch) : copy_layers(*data, layer, path, watch);
    watch.settle();
    bool const done = copy != nullptr;
    copy.reset();
    if (std::string const words = driver.take(); !done || !words.empty()) {
        throw BadInput(fmt::format("io.plain_copy: {} cannot be copied: {}", source, words));
    }
    if (is_raster) {
        write_text(path, raster.bytes());
    }
    return path;
}

} // namespace thalweg::io
