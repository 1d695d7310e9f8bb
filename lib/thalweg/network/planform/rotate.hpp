// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of rotate().
struct RotateParams {
    double turn_deg = 0.0; ///< [-180, 180] counter-clockwise
};

/// A network and the grid it lies in.
struct Rotated {
    StreamNetwork network;
    Grid grid;
};

/// \param seed random seed
/// \return a turn at random that takes a lattice's axes and diagonals far from the grid's: 12 to 33 degrees either way.
double random_turn(std::uint64_t seed);

/// Turns a network and puts it into the middle of a grid.
/// \pre a network; the grid, of which width and height may be 0: then it is a twentieth of the network's longer side
/// larger than the network, all around, two cells at least, its north-western corner as given.
/// \param network the network
/// \param frame the grid; a size of 0 is chosen
/// \param params options, each with its default, unit and range
/// \return the same network, turned, its box in the middle of the grid; distances are kept but for coordinates rounded
/// to 1e-6 m. A turn of 0 only moves it.
/// \throws BadParameter
/// \throws BadInput for no arcs, a coordinate that is not a number, or a network that does not fit
Rotated rotate(StreamNetwork const& network, Grid const& frame, RotateParams const& params = {});

} // namespace thalweg::network
