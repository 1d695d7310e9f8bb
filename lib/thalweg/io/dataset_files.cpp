// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/dataset_files.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/io/driver.hpp>

#include <cpl_string.h>
#include <gdal_priv.h>

#include <algorithm>

namespace thalweg::io {

std::vector<std::string> dataset_files(std::string const& path) {
    Driver const driver;
    GDALDatasetUniquePtr const source(
        GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR | GDAL_OF_READONLY));
    if (!source) {
        throw BadInput("io.dataset_files: " + path + " is no vector or raster source");
    }
    CPLStringList const list(source->GetFileList(), TRUE);
    std::vector<std::string> files;
    for (int i = 0; i < list.size(); ++i) {
        files.emplace_back(list[i]);
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace thalweg::io
