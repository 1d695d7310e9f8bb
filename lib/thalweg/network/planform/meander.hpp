// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Options of meander().
struct MeanderParams {
    double gain = 1.0;      ///< [0, 2] how far rivers wander; 0: corners and lattice steps are rounded within half a
                            ///< cell, nodes stay
    double gap_cells = 1.5; ///< [0.5, 4] rivers farther apart stay so: cells, for they are drawn into those
    std::uint64_t seed = 7;
};

/// What meander() returns.
struct Meandered {
    StreamNetwork network;
    std::int64_t rounds = 0;   ///< in which bends were eased because rivers came too close
    std::int64_t eased = 0;    ///< vertices whose shift was reduced
    std::int64_t vertices = 0; ///< of the network
    double max_shift_m = 0.0;
};

/// Lets rivers wander: rounds corners and lattice steps, bends the plain by long waves and each river by noise along
/// it, whose wavelength and amplitude grow with drainage area.
/// \pre a network inside the grid whose arcs meet only in nodes; by arc its drainage area [m2] at its lower end.
/// \param network the network
/// \param grid the grid
/// \param area_m2 [m2] drainage area by arc
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the same arcs between the same nodes, with a vertex a cell; nodes move with the larger river, an outlet on
/// the grid's edge stays. Arcs meet only in nodes (CGAL). On the bent plain, what is gap_cells or more from a segment
/// of a river (along one river: and eight cells on) stays so, what is nearer keeps a third of its distance: where it
/// would not, the shift is halved there until it does. Wave: 12 widths of a valley floor, 0.08 * area [cells] ^ 0.4, at
/// least 10 cells. Coordinates are rounded to 1e-6 m. Random numbers are a hash of (seed, node).
/// \throws BadParameter
/// \throws BadInput for areas of other arcs, a vertex outside the grid, arcs that meet elsewhere, or a network that is
/// not a forest
/// \throws Cancelled
///
/// Source: wavelengths of 10 to 14 widths, \cite leopold1960.
Meandered meander(StreamNetwork const& network, Grid const& grid, std::vector<double> const& area_m2,
                  MeanderParams const& params = {}, Run const& run = {});

/// \pre a mask on the network's grid.
/// \param network the network
/// \param land the cells of land; 0: sea
/// \param area_m2 [m2] drainage area by arc
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the same where there is sea (0): what is on land (1) stays there, and moves the less the nearer the sea is.
Meandered meander(StreamNetwork const& network, Mask const& land, std::vector<double> const& area_m2,
                  MeanderParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
