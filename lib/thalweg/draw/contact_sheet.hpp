// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// A small picture of a terrain with words below it.
struct Thumbnail {
    Raster<std::uint8_t> shade;     ///< [1, 255] hillshade; 0: no data; without cells: an empty frame
    std::string missing;            ///< UTF-8, in an empty frame
    std::vector<std::string> words; ///< UTF-8, a line each; the first is bold
};

/// Options of contact_sheet().
struct ContactSheetParams {
    std::string title;   ///< UTF-8; "" for none
    std::string note;    ///< UTF-8, a line below the title; "" for none
    int width_px = 1600; ///< [200, 8000]; the height follows
    Format format = Format::png;
};

/// Draws thumbnails in rows, in their order. All frames have one size, in which a terrain keeps its shape.
/// \param thumbnails none: an empty sheet that says so
/// \return the picture
/// \throws BadInput when the picture would be higher than 32 000 pixels
Picture contact_sheet(std::vector<Thumbnail> const& thumbnails, ContactSheetParams const& params = {});

} // namespace thalweg::draw
