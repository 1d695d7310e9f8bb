// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments/areas.hpp>
#include <thalweg/measure/laws/power_law.hpp>

namespace thalweg::measure {

/// Flint's law S = k A^-theta: how rivers flatten as they gather water.
/// Takes: a network with heights and the areas at the ends of its arcs. Gives: the power law of the arcs' slopes, drop
/// over length, against the mean of the areas at their two ends, on bins of area: the exponent is -theta. Arcs that do
/// not fall have no logarithm and are left out. Throws: BadInput when areas or heights are not one an arc.
/// Source: Flint 1974; on the links of a network: Tarboton, Bras and Rodriguez-Iturbe 1991.
std::optional<PowerLaw> concavity(ElevatedNetwork const& network, flow::ContributingAreas const& areas,
                                  PowerLawParams const& params = {});

} // namespace thalweg::measure
