// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// Options of lines().
struct LinesParams {
    std::string title;    ///< UTF-8; "" for none
    int width_px = 1000;  ///< [200, 8000]
    int height_px = 1000; ///< [200, 8000]
    Format format = Format::svg;
};

/// \param lines lines; none give an empty sheet
/// \param params options, each with its default, unit and range
/// \return polylines in plan, as large as the sheet lets them be, north up.
/// \throws BadParameter
/// \throws BadInput when a coordinate is not finite
Picture lines(std::vector<std::vector<Vec2>> const& lines, LinesParams const& params = {});

} // namespace thalweg::draw
