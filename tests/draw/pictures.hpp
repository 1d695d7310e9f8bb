// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace test {

/// A decoded PNG: three bytes a pixel.
struct Pixels {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<unsigned char> rgb;
    unsigned char at(std::size_t x, std::size_t y, std::size_t band) const { return rgb[3 * (y * width + x) + band]; }
};

/// Decoded by GDAL; empty where it is no PNG.
Pixels decode(std::string const& png);

/// Pixels that are clearly river: blue over red by 60 and over green by 25.
std::size_t river_pixels(Pixels const& pixels);

/// Whether a parser takes the text for XML.
bool is_xml(std::string const& text);

} // namespace test
