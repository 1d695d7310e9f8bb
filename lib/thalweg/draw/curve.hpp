// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// Options of curve().
struct CurveParams {
    std::string increment; ///< its name or expression, for the title
    int width_px = 1000;   ///< [200, 8000]
    int height_px = 560;   ///< [200, 8000]
    Format format = Format::svg;
};

/// \param increments increments [m] of x = 1, 2, ...; none give empty axes that say so
/// \param params options, each with its default, unit and range
/// \return the increment dh(x) and its sum H(d), as in Table 1 of Cao, Long and Lü 2009, in two diagrams.
/// \throws BadParameter
/// \throws BadInput when an increment is not finite
Picture curve(std::vector<double> const& increments, CurveParams const& params = {});

} // namespace thalweg::draw
