// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/internal/concavity.hpp>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments/areas.hpp>

namespace thalweg::measure {

std::optional<PowerLaw> concavity(ElevatedNetwork const& network, flow::ContributingAreas const& areas,
                                  PowerLawParams const& params) {
    std::size_t const arcs = network.plan.arc_count();
    if (areas.us_area_m2.size() != arcs || areas.ds_area_m2.size() != arcs || network.arc_z.size() != arcs) {
        throw BadInput(fmt::format("measure.concavity: {} and {} areas and heights of {} for {} arcs; measure the "
                                   "network again",
                                   areas.us_area_m2.size(), areas.ds_area_m2.size(), network.arc_z.size(), arcs));
    }
    std::vector<AtArea> slopes;
    slopes.reserve(arcs);
    for (std::size_t a = 0; a < arcs; ++a) {
        double const drop = network.arc_z[a].front() - network.arc_z[a].back();
        slopes.push_back({0.5 * (areas.us_area_m2[a] + areas.ds_area_m2[a]), drop / network.plan.length_m(a)});
    }
    return fit_power_law(slopes, params);
}

} // namespace thalweg::measure
