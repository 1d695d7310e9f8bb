// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/tin.hpp>

namespace thalweg::geometry {

/// Whether angles and lengths of a TIN are measured in plan or in space.
enum class Measured : std::uint8_t {
    in_plan,   ///< heights are ignored
    on_surface ///< in space, for any triangle mesh
};

/// Computes half the cotangents of the angles of every triangle, as weights of the Laplacian.
/// \param tin triangles in either orientation, with area as measured
/// \param measured in plan or in space
/// \return by triangle, by corner: the triangle's share in the weight of the opposite edge. For a grid of halved
/// squares the weights of sides are 1 and of diagonals exactly 0: the stiffness row of an inner vertex is 4, -1, -1,
/// -1, -1.
/// \throws BadInput naming the triangle or vertex when one has no area, does not exist or is not finite
///
/// Source: \cite nenu2015, eq. 16; \cite pinkall1993.
std::vector<std::array<double, 3>> half_cotangents(Tin const& tin, Measured measured = Measured::in_plan);

} // namespace thalweg::geometry
