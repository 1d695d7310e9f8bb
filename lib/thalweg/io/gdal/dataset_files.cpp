// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/dataset_files.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/archive.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>

namespace thalweg::io {

std::vector<std::string> dataset_files(std::string const& path) {
    Driver const driver;
    Dataset const source = open_undisturbed(path, GDAL_OF_RASTER | GDAL_OF_VECTOR);
    if (!source) {
        throw BadInput("io.dataset_files: " + path + " is not a vector or raster source");
    }
    if (inside_archive(path) != path) {
        return {path};
    }
    CPLStringList const list(source->GetFileList(), TRUE);
    std::vector<std::string> files;
    for (int i = 0; i < list.size(); ++i) {
        // GDAL 3.7 lists what companions name, too, wherever it lies.
        if (VSIStatBufL status; VSIStatL(list[i], &status) == 0) {
            files.emplace_back(list[i]);
        }
    }
    if (!files.empty() && source->GetDescription() != path) { // a copy was read, because changes stand beside the file
        files = {path, path + "-wal"};
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace thalweg::io
