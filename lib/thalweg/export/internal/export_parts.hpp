// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/lattice.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/export/export.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::exports {

/// Samples or vertices of a row and of a column.
struct ExportSize {
    std::int64_t width = 0;
    std::int64_t height = 0;
};

/// \return the size nearest to a DEM's shape whose longer side has this many samples
ExportSize fitting(Grid const& grid, std::int64_t longer);

/// Samples the DEM, whose gaps get the level of the sea or, in meshes without one, stay, and says so in the result.
Lattice sampled(report::Scene const& scene, ExportSize size, ExportResult& made, Run const& run);

/// \return PNG of the ground; corners as a lattice's
std::string texture_of(report::Scene const& scene, Run const& run);

/// Rivers laid on a mesh, in its frame; a little above it, or they would be hidden in it.
std::vector<std::vector<Vec3>> rivers_on_mesh(ElevatedNetwork const& network, Lattice const& ground,
                                              LatticeMesh const& mesh, double exaggeration);

bool is_mesh(ExportFormat format);

/// Runs `thalweg export --for`.
ExportResult run_export_for(ExportParams const& params, Run const& run);

} // namespace thalweg::exports
