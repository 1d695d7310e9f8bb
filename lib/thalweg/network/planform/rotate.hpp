// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of rotate().
struct RotateParams {
    double turn_deg = 0.0; ///< [-180, 180] counterclockwise
};

/// A network and the grid it lies in.
struct RotatedNetwork {
    StreamNetwork network;
    Grid grid;
};

/// Chooses a random rotation that turns a lattice's axes and diagonals away from the grid's.
/// \param seed random seed
/// \return [deg] 12 to 33 in either direction
double random_turn(std::uint64_t seed);

/// Rotates a network and centres it in a grid.
/// \param network at least one arc
/// \param frame the grid; width and height 0: the network's box, enlarged on each side by a twentieth of its longer
/// side and at least two cells, with the frame's north-western corner
/// \return distances are kept except for coordinates rounded to 1e-6 m; a rotation by 0 only translates
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput for no arcs, a coordinate that is not a number, or a network larger than the grid
RotatedNetwork rotate(StreamNetwork const& network, Grid const& frame, RotateParams const& params = {});

} // namespace thalweg::network
