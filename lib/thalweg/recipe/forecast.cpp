// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::recipe {

namespace {

/// Estimates the cells of a network grown from this many particles, with its margin, from the radius of a cluster of
/// dimension 1.71, of which one arm is kept.
std::int64_t cells_of_cluster(std::int64_t particles) {
    double const radius = 0.8 * portable::pow(static_cast<double>(particles), 1.0 / 1.71);
    return std::max<std::int64_t>(1, std::llround(1.2 * radius * radius));
}

/// The stages that plan and make rivers.
std::vector<std::string> stages_of_rivers(Plan const& plan) {
    std::vector<std::string> stages;
    switch (plan.recipe.network->source) {
    case Source::dla: stages = {"grow", "thin", "trace"}; break;
    case Source::lines: stages = {"read", "adopt"}; break;
    case Source::forest: stages = {"shape", "grow"}; break;
    case Source::tokunaga:
        stages = plan.tree ? std::vector<std::string>{"grow", "embed"} : std::vector<std::string>{"read", "grow"};
        break;
    }
    if (has_coastlines(*plan.recipe.network, plan.lines)) {
        stages.emplace_back("sea");
    }
    stages.emplace_back("prune");
    if (has_meanders(plan.recipe)) {
        stages.emplace_back("meander");
    }
    if (!heights_follow_terrain(plan.recipe)) {
        stages.emplace_back("raise");
    }
    return stages;
}

std::vector<std::string> stages_of_land_alone(Recipe const& recipe) {
    std::vector<std::string> stages = {"land"};
    if (levels_of(recipe) > 0) {
        stages.emplace_back("detail");
    }
    if (recipe.statistics) {
        stages.emplace_back("project");
    }
    return stages;
}

std::vector<std::string> stages_around_rivers(Recipe const& recipe) {
    std::vector<std::string> stages;
    if (in_equilibrium(recipe)) {
        stages = {"channels", "fill"};
    }
    if (scatters_points(recipe)) {
        stages.emplace_back("scatter");
    }
    if (has_ridges(recipe)) {
        stages.emplace_back("ridge");
    }
    if (needs_tin(recipe)) {
        stages.emplace_back("tin");
    }
    if (!in_equilibrium(recipe)) {
        stages.emplace_back("fill");
    }
    return stages;
}

std::vector<std::string> stages_after(Recipe const& recipe) {
    std::vector<std::string> stages(recipe.patches.size(), "blend");
    if (conditions_dem(recipe)) {
        stages.emplace_back("carve");
    }
    stages.emplace_back("drain");
    if (adds_side_valleys(recipe)) {
        stages.emplace_back("valleys");
    }
    stages.emplace_back("measure");
    if (finds_catchments(recipe)) {
        stages.emplace_back("catchments");
    }
    if (recipe.network) {
        stages.emplace_back("certify");
    }
    if (has_ridges(recipe)) {
        stages.emplace_back("ridges");
    }
    if (measures_areas(recipe)) {
        stages.emplace_back("areas");
    }
    stages.insert(stages.end(), {"laws", "relief"});
    return stages;
}

std::vector<std::string> stages_of(Plan const& plan) {
    Recipe const& recipe = plan.recipe;
    std::vector<std::string> stages;
    auto const append = [&](std::vector<std::string> const& more) {
        stages.insert(stages.end(), more.begin(), more.end());
    };
    if (on_raster(recipe)) {
        stages.emplace_back("raster");
    }
    if (recipe.network) {
        append(stages_of_rivers(plan));
    }
    if (recipe.surface || !recipe.network) {
        append(recipe.network ? stages_around_rivers(recipe) : stages_of_land_alone(recipe));
        append(stages_after(recipe));
    }
    if (recipe.network) {
        stages.emplace_back("check");
    }
    if (!recipe.output.against.empty()) {
        stages.emplace_back("compare");
    }
    return stages;
}

/// Seconds per million cells, by stage; stages not listed take a tenth.
double seconds_a_million(std::string const& stage, Method method) {
    if (stage == "fill") {
        return method == Method::equilibrium ? 2.0 : method == Method::dilate ? 1.0 : 0.8;
    }
    if (stage == "project") {
        return 20.0;
    }
    if (stage == "carve" || stage == "relief" || stage == "meander" || stage == "blend") {
        return 0.7;
    }
    return 0.1;
}

/// Peak memory [bytes] of the whole program; measured on the samples, of 0.01 to 1 million cells.
std::int64_t memory_of(Recipe const& recipe, std::int64_t cells) {
    constexpr std::int64_t program = 100'000'000; // with its libraries
    constexpr std::int64_t a_particle = 60;
    bool const has_cluster = recipe.network && recipe.network->source == Source::dla;
    constexpr std::int64_t a_cell_of_exact_detail = 120; // transforms on a torus of up to seven cells per cell
    bool const exact = levels_of(recipe) > 0 && recipe.detail->midpoint.stencil == fractal::Stencil::exact;
    return program + bytes_needed(cells) * 2 + (exact ? cells * a_cell_of_exact_detail : 0) +
           (has_cluster ? recipe.network->dla.particles * a_particle : 0);
}

double seconds_of(Recipe const& recipe, Forecast const& found) {
    Method const method = recipe.surface ? recipe.surface->method : Method::tin;
    double const millions = static_cast<double>(found.cells) / 1e6;
    double seconds = 1.5 * millions; // files and the page
    for (std::string const& stage : found.stages) {
        seconds += millions * seconds_a_million(stage, method);
    }
    if (recipe.network && recipe.network->source == Source::dla) {
        seconds += 2.5e-6 * static_cast<double>(recipe.network->dla.particles) +
                   8e-8 * growth::least_arrivals(recipe.network->dla);
    }
    return seconds;
}

/// The Run of a forecast: of what planning finds it reports warnings, and no progress of stages.
Run warnings_only(Run run) {
    run.found = [report = run](Finding const& finding) {
        if (finding.severity() != Severity::note) {
            report.report({finding});
        }
    };
    run.log = {};
    return run;
}

} // namespace

Forecast forecast(Plan const& plan) {
    Forecast found;
    found.grid = plan.grid;
    found.cells = plan.grid ? plan.grid->cells() : cells_of_cluster(plan.recipe.network->dla.particles);
    found.stages = stages_of(plan);
    found.memory_bytes = memory_of(plan.recipe, found.cells);
    found.seconds = seconds_of(plan.recipe, found);
    found.findings = plan.findings;
    return found;
}

Forecast forecast(Recipe const& recipe, Run const& run) {
    return forecast(resolve(recipe, warnings_only(run)));
}

} // namespace thalweg::recipe
