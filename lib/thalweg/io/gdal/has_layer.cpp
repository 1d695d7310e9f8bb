// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/gdal/has_layer.hpp>

#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <system_error>

namespace thalweg::io {

bool has_layer(std::string const& path, std::string const& layer) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return false;
    }
    Driver const driver;
    return open_file(path, GDAL_OF_VECTOR, "io.has_layer")->GetLayerByName(layer.c_str()) != nullptr;
}

} // namespace thalweg::io
