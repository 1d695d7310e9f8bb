// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace thalweg::io {

/// The table of a GeoPackage in which QGIS looks for styles.
inline constexpr char const* styles_layer = "layer_styles";

/// What stands beside the elements of a style, in QML as in a project.
inline constexpr char const* style_attributes =
    "version=\"3.22.0\" styleCategories=\"AllStyleCategories\" labelsEnabled=\"1\" hasScaleBasedVisibilityFlag=\"0\" "
    "simplifyDrawingHints=\"1\" simplifyDrawingTol=\"1\" simplifyLocal=\"1\" simplifyAlgorithm=\"0\" "
    "simplifyMaxScale=\"1\"";

/// Text for an element or an attribute in double quotes; XML 1.0 has no control characters but three, not even escaped.
std::string xml_escaped(std::string_view text);

} // namespace thalweg::io
