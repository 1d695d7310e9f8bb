// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

namespace {

Rows<network::DlaParams> growth_keys() {
    using network::DlaParams;
    using network::VisitRule;
    return {
        number("particles", &DlaParams::particles)
            .range({1, 1e9})
            .used(source_is("dla"))
            .means("number of particles in the cluster"),
        number("radius", &DlaParams::max_radius)
            .unit("cells")
            .range({0, 1e6})
            .used(source_is("dla"))
            .means("radius of the cluster at which growth stops early; 0: none"),
        number("sticking", &DlaParams::sticking)
            .range({0, 1, left_open})
            .used(source_is("dla"))
            .means("sticking probability S: a particle with n occupied neighbours sticks with S^(3-n)"),
        number("visits", &DlaParams::visits)
            .range({1, 255})
            .used(source_is("dla"))
            .means("noise-reduction count M: arrivals that a site needs before it is occupied"),
        choice("rule", &DlaParams::rule)
            .one_of({{"count_first", VisitRule::count_first}, {"stick_then_count", VisitRule::stick_then_count}})
            .used(source_is("dla") && above("network.dla.visits", 1.0) &&
                  when("network.dla.sticking < 1",
                       [](Recipe const& r) { return r.network && r.network->dla.sticking < 1.0; }))
            .means("whether an arrival counts before or after its sticking test"),
    };
}

} // namespace

Rows<NetworkRecipe> dla_keys() {
    using network::BranchChoice;
    return joined<NetworkRecipe>({inside("dla.", &NetworkRecipe::dla, growth_keys()),
                                  {choice("dla.branch", &NetworkRecipe::branch)
                                       .one_of({{"largest", BranchChoice::largest},
                                                {"north", BranchChoice::north},
                                                {"east", BranchChoice::east},
                                                {"south", BranchChoice::south},
                                                {"west", BranchChoice::west},
                                                {"all", BranchChoice::all}})
                                       .used(source_is("dla"))
                                       .means("which arm of the cluster becomes the valley")}});
}

} // namespace thalweg::pipeline
