// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::exports {

/// An arc as a line of water.
struct RiverSpline {
    std::int64_t arc = 0;    ///< arc_id, from 1
    std::int64_t ds_arc = 0; ///< 0: an outlet
    int strahler = 1;
    std::vector<Vec3> line;            ///< [m] downstream
    std::vector<double> discharge_m3s; ///< [m3/s] by vertex, mean of the year
    std::vector<double> width_m;       ///< [m] by vertex
};

/// Gives a scene's rivers discharge and width: discharge is runoff times contributing area, which grows evenly along an
/// arc from those above it; width is 7.2 times the root of discharge. Areas that the scene does not know are those of
/// the DEM by D8.
/// \param scene with a DEM and a network
/// \param runoff_mm [mm/a] > 0
/// \return by arc
///
/// Source: \cite moody2002, width of rivers by discharge.
std::vector<RiverSpline> river_splines(report::Scene const& scene, double runoff_mm, Run const& run = {});

} // namespace thalweg::exports
