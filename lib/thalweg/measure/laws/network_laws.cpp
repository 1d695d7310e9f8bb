// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/network_laws.hpp>

#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/numbers/compensated_sum.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/laws/internal/concavity.hpp>
#include <thalweg/measure/laws/internal/hack.hpp>

namespace thalweg::measure {

NetworkLaws network_laws(ElevatedNetwork const& network, NetworkOrders const& orders,
                         flow::ContributingAreas const& areas, NetworkLawsParams const& params) {
    if (!(params.land_m2 > 0.0) || std::isinf(params.land_m2)) {
        throw BadParameter(
            fmt::format("measure.network_laws: the land has {} m2; it must have some", double{params.land_m2}));
    }
    NetworkLaws laws;
    laws.horton = horton(network.plan, orders, areas.ds_area_m2);
    laws.tokunaga = tokunaga(params.side_branches);
    laws.hack = hack(network.plan, areas.ds_area_m2, params.head_m);
    laws.concavity = concavity(network, areas);
    CompensatedSum length;
    for (double const l : network.plan.length_m()) {
        length.add(l);
    }
    laws.drainage_density_m = length.value() / params.land_m2;
    laws.links = link_lengths(network.plan);
    laws.junctions = junction_angles(network.plan, params.junction_reach_m);
    return laws;
}

} // namespace thalweg::measure
