// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/measure/laws/fits.hpp>

namespace thalweg::measure {

/// Fits Hack's law L = c A^h: how the longest flow path grows with the area it drains.
/// \param network a forest
/// \param ds_area_m2 [m2] by arc, at its downstream end
/// \param head_m [m] by node: length of the flow path from the divide to a source; empty: rivers begin at the divide
/// \return the law over the downstream ends of all arcs, on bins of area; L runs along the rivers to the farthest
/// source and continues by head_m. Basins are nested, so that the standard error is less than that of as many separate
/// basins.
/// \throws BadInput when there is not one area per arc or one head per node
///
/// Source: \cite hack1957; L from the divide as in Rigon et al. 1996.
std::optional<PowerLaw> hack(StreamNetwork const& network, std::vector<double> const& ds_area_m2,
                             std::vector<double> const& head_m = {}, PowerLawParams const& params = {});

/// Fits Flint's law S = k A^-theta: how rivers flatten with contributing area.
/// \param network with heights
/// \param areas at the ends of its arcs
/// \return the power law of the arcs' slopes, drop over length, against the mean area of their two ends, on bins of
/// area: the exponent is -theta. Arcs that do not fall are left out.
/// \throws BadInput when there are not areas and heights of every arc
///
/// Source: \cite flint1974; on the links of a network: \cite tarboton1991.
std::optional<PowerLaw> concavity(ElevatedNetwork const& network, flow::ContributingAreas const& areas,
                                  PowerLawParams const& params = {});

} // namespace thalweg::measure
