// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/tin.hpp>

namespace thalweg::geometry {

/// Where angles and lengths of a TIN are measured.
enum class Measured : std::uint8_t {
    in_plan,   ///< heights do not count
    on_surface ///< in space: also for meshes that are no TIN seen from above
};

/// Half the cotangents of the angles of every triangle.
/// \pre triangles that have area where they are measured, in either direction.
/// \param tin the TIN
/// \param measured in plan or in space
/// \return for the angle at a triangle's k-th corner number k, which is the triangle's share in the weight of the edge
/// across. Of a grid's squares halved along either diagonal the weights of the sides are 1 and those of the diagonals
/// exactly 0, so that the stiffness row of an inner vertex is 4, -1, -1, -1, -1.
/// \throws BadInput naming triangle or vertex when one has no area, is not there or is not finite
///
/// Source: \cite nenu2015, eq. 16; \cite pinkall1993.
std::vector<std::array<double, 3>> half_cotangents(Tin const& tin, Measured measured = Measured::in_plan);

} // namespace thalweg::geometry
