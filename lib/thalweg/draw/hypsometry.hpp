// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>
#include <thalweg/draw/picture.hpp>

namespace thalweg::draw {

/// Options of hypsometry().
struct HypsometryParams {
    std::string title;   ///< what the land is, before the integral; "" for none
    int width_px = 1000; ///< [200, 8000]
    int height_px = 640; ///< [200, 8000]
    Format format = Format::svg;
};

/// \param curve x = share of the area above [0, 1], y = height [m], by rising or falling height; none gives empty axes
/// that say so
/// \param integral [0, 1], or NaN where it is not defined (one height)
/// \param params options, each with its default, unit and range
/// \return the hypsometric curve: height over the share of the area that lies above it, with its integral.
/// \throws BadParameter
/// \throws BadInput when a number is not finite or a share lies outside [0, 1]
///
/// Source: \cite strahler1952.
Picture hypsometry(std::vector<Vec2> const& curve, double integral, HypsometryParams const& params = {});

} // namespace thalweg::draw
