// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/finding.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/raster_files.hpp>

class GDALRasterBand;

namespace thalweg::io {

// Which bands of a file are heights, by the names and meanings that it gives them.

/// A text of GDAL; null: "".
std::string text_of(char const* text);

/// Opens the only variable of a file without cells of its own, or the only one whose name means heights; where one
/// means heights and others depths, that of heights.
/// \throws BadInput naming all variables where there is none such
Dataset variable_of_heights(Dataset const& file, About const& about);

/// The bands of a file that make its heights.
struct HeightBands {
    Dataset file;     ///< as it was named
    Dataset variable; ///< of the file, if one was chosen
    GDALRasterBand* heights = nullptr;
    std::array<GDALRasterBand*, 3> colours{}; ///< that are decoded; null: none
    GDALRasterBand* alpha = nullptr;
    std::optional<Finding> choice = {}; ///< of one among several

    GDALDataset& data() const { return variable ? *variable : *file; }
};

/// Chooses them.
/// \throws BadInput where no band is clearly that of heights, or the one wanted is missing
HeightBands choose_bands(Dataset file, ReadDemParams const& params, About const& about);

/// Whether a band's numbers grow upwards.
struct HeightDirection {
    enum class Way : std::uint8_t {
        up,
        down,
        depths_or_heights ///< named as depths, without a word on the way they grow
    };
    Way way = Way::up;
    std::string contradiction; ///< between its names and attributes, in words; "": none
};

/// Takes it from the attributes \c positive and \c standard_name, the band's name and the vertical CRS.
HeightDirection direction_of(GDALDataset& data, GDALRasterBand& band);

} // namespace thalweg::io
