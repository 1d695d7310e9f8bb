// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::exports {

/// Options of write_print().
struct PrintParams {
    double longest_mm = 150.0;         ///< [mm] [10, 2000] longer side of the model, between the outermost vertices
    double base_mm = 3.0;              ///< [mm] [0.2, 100] thickness below the lowest height
    double exaggeration = 1.0;         ///< > 0, factor of heights
    std::int64_t most_vertices = 1025; ///< [2, 2049] a side; fewer where they would be closer than 0.1 mm
};

/// What write_print() wrote.
struct PrintExport {
    Vec3 size_mm;                   ///< [mm] eastwards, northwards, upwards with the base
    double scale = 1.0;             ///< of the plan: 1 : scale
    double relief_mm = 0.0;         ///< [mm] from the lowest height to the highest
    std::int64_t width = 0;         ///< vertices of a row of the surface
    std::int64_t height = 0;        ///< vertices of a column of the surface
    std::int64_t vertices = 0;      ///< of the closed mesh
    std::int64_t triangles = 0;     ///< of the closed mesh
    std::vector<std::string> files; ///< names in the folder
    std::vector<Finding> findings;  ///< choices and what may be wrong with the print
};

/// Writes terrain.stl for 3D printers: a closed solid in millimetres, x east, y north, z up, its corner at the origin,
/// so that slicers put it on the plate as it is. The sea is level.
/// \param scene with a DEM
/// \param out where to write
/// \return what was written; the same bytes for any number of threads
/// \throws BadParameter for an option out of its range
/// \throws BadInput when cells have no data and are not the sea, or the DEM has a single row or column
PrintExport write_print(report::Scene const& scene, PrintParams const& params, io::OutputFolder const& out,
                        Run const& run);

} // namespace thalweg::exports
