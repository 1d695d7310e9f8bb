// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/recipe/plan.hpp>

namespace thalweg::make {

/// A given point, and the terrain there.
struct PointOff {
    std::int64_t number = 0; ///< in its file, from 1
    Vec2 at;                 ///< [m]
    double asked_m = 0.0;
    double z_m = 0.0;      ///< NaN: no data
    bool in_river = false; ///< whose height it has there
};

/// A given ridge, and the terrain there.
struct RidgeOff {
    std::int64_t feature = 0;     ///< number in its file, from 1
    std::int64_t cells = 0;       ///< under it
    std::int64_t in_rivers = 0;   ///< of these: cells of rivers and beside them, where no ridge can be
    std::int64_t crossed = 0;     ///< of the others: where water of ten cells or more comes across
    std::optional<double> most_m; ///< largest difference from its heights, where it has some
};

/// Given points and ridges, compared with the terrain.
struct GivenFeatures {
    std::string points_file = {};
    std::string ridges_file = {};
    std::vector<PointOff> points = {}; ///< in the file's order
    std::vector<RidgeOff> ridges = {}; ///< likewise
    double tolerance_m = 1.0;

    /// \return points whose height is off by more than the tolerance
    std::int64_t missed() const;
};

/// Compares given points and ridges with the terrain.
/// \param recipe of it
/// \param points,ridges of its files
/// \param terrain of it, which drains
/// \return nothing where there are neither, or no rivers
std::optional<GivenFeatures> given_features(recipe::Recipe const& recipe, FeaturePoints const& points,
                                            RiverLines const& ridges, Terrain const& terrain);

/// \internal
/// Formats the comparison.
/// \param given the comparison
/// \return one line for the log
std::string line_of(GivenFeatures const& given);

} // namespace thalweg::make
