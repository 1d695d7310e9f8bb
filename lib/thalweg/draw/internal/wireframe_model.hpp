// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/fishnet.hpp>
#include <thalweg/draw/internal/hidden_lines.hpp>
#include <thalweg/draw/wireframe.hpp>

/// What a wireframe shows, projected. Private to this module.
namespace thalweg::draw {

inline constexpr double degree = 3.14159265358979323846 / 180.0;

/// Parallel projection, in metres: x to the right, y up.
struct View {
    double sine = 0.0; ///< of the bearing
    double cosine = 1.0;
    double tilt = 0.5;    ///< what depth adds to y
    double upright = 1.0; ///< what height adds to y

    View(double azimuth_deg, double elevation_deg, double exaggeration);
    Vec2 at(Vec2 ground, double z) const {
        return {ground.x * cosine - ground.y * sine, (ground.x * sine + ground.y * cosine) * tilt + z * upright};
    }
};

/// The net over the ground with what stands around it, projected.
struct Model {
    Fishnet knots;
    Net net;
    double exaggeration = 1.0;
    std::vector<std::array<Vec2, 2>> skirt;  ///< from knots on front edges down to the base, where seen
    std::vector<std::array<Vec2, 2>> bottom; ///< the base between them
    Vec2 base_corner;                        ///< the nearest corner, on the base
    Vec2 base_col_end;                       ///< the far end of the front edge along columns
    Vec2 base_row_end;
    Box box; ///< of all that, y up: x, y are its lower left corner
};

/// A place on the base below a knot.
struct Foot {
    Vec2 at;
    double depth = 0.0; ///< [m] of the knot, growing away from the viewer
};

using Feet = Indexed<KnotId, Foot>;

/// Hangs a skirt on every side of a mesh that has land behind it and none before it.
void hang_skirt(Model& model, Feet const& feet);

/// The net, its skirt and their box, with the exaggeration of the params or one that reads well.
Model model_of(Raster<float> const& dem, WireframeParams const& params);

} // namespace thalweg::draw
