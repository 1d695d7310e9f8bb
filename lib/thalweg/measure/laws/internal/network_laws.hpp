// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/measure/laws/fits.hpp>

namespace thalweg::measure {

/// Hack's law L = c A^h: how the longest way of water grows with the area it drains.
/// Takes: a network of trees; ds_area_m2: by arc, at its downstream end; head_m: by node, the way of water above a
/// source, from the divide down to it; empty where rivers begin at the divide. Gives: the law over the downstream ends
/// of all arcs, on bins of area; L runs along the rivers up to the farthest source and on by head_m. Basins lie within
/// one another, so that the standard error is less than that of as many basins side by side. Throws: BadInput when
/// areas are not one an arc or heads not one a node.
/// Source: Hack 1957; L from the divide as in Rigon et al. 1996.
std::optional<PowerLaw> hack(StreamNetwork const& network, std::vector<double> const& ds_area_m2,
                             std::vector<double> const& head_m = {}, PowerLawParams const& params = {});

/// Flint's law S = k A^-theta: how rivers flatten as they gather water.
/// Takes: a network with heights and the areas at the ends of its arcs. Gives: the power law of the arcs' slopes, drop
/// over length, against the mean of the areas at their two ends, on bins of area: the exponent is -theta. Arcs that do
/// not fall have no logarithm and are left out. Throws: BadInput when areas or heights are not one an arc.
/// Source: Flint 1974; on the links of a network: Tarboton, Bras and Rodriguez-Iturbe 1991.
std::optional<PowerLaw> concavity(ElevatedNetwork const& network, flow::ContributingAreas const& areas,
                                  PowerLawParams const& params = {});

} // namespace thalweg::measure
