// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

struct CurveParams {
    std::string increment; ///< its name or expression, for the title
    int width_px = 1000;   ///< [200, 8000]
    int height_px = 560;
    Format format = Format::svg;
};

/// The increment dh(x) and its sum H(d), as in Table 1 of paper 000. increments: [m] x = 1 ..
Picture curve(std::vector<double> const& increments, CurveParams const& params = {});

} // namespace thalweg::draw
