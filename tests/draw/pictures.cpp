// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <cpl_minixml.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>

#include "pictures.hpp"

namespace test {

Pixels decode(std::string const& png) {
    GDALAllRegister();
    char const* const name = "/vsimem/picture.png";
    std::string bytes = png;
    VSIFCloseL(VSIFileFromMemBuffer(name, reinterpret_cast<GByte*>(bytes.data()), bytes.size(), FALSE));
    Pixels pixels;
    {
        GDALDatasetUniquePtr const data(GDALDataset::Open(name, GDAL_OF_RASTER | GDAL_OF_READONLY));
        if (data && data->GetRasterCount() >= 3) {
            int const width = data->GetRasterXSize();
            int const height = data->GetRasterYSize();
            std::vector<unsigned char> rgb(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
            if (data->RasterIO(GF_Read, 0, 0, width, height, rgb.data(), width, height, GDT_Byte, 3, nullptr, 3,
                               3 * static_cast<GSpacing>(width), 1, nullptr) == CE_None) {
                pixels = {static_cast<std::size_t>(width), static_cast<std::size_t>(height), std::move(rgb)};
            }
        }
    }
    VSIUnlink(name);
    return pixels;
}

std::size_t river_pixels(Pixels const& pixels) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < pixels.rgb.size(); i += 3) {
        count += pixels.rgb[i + 2] >= pixels.rgb[i] + 60 && pixels.rgb[i + 2] >= pixels.rgb[i + 1] + 25;
    }
    return count;
}

bool is_xml(std::string const& text) {
    CPLXMLNode* const tree = CPLParseXMLString(text.c_str());
    bool const good = tree != nullptr;
    CPLDestroyXMLNode(tree);
    return good;
}

} // namespace test
