// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/internal/forecast.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/recipe/stages.hpp>

namespace thalweg::recipe {

namespace {

/// Estimates the cells of a network grown from this many particles, with its margin, from the radius of a cluster of
/// dimension 1.71, of which one arm is kept.
std::int64_t cells_of_cluster(std::int64_t particles) {
    double const radius = 0.8 * portable::pow(static_cast<double>(particles), 1.0 / 1.71);
    return std::max<std::int64_t>(1, std::llround(1.2 * radius * radius));
}

/// What rivers take of each cell of a grid that they fill [bytes].
double bytes_of_rivers(Recipe const& recipe) {
    return by_tokunaga(recipe) ? 4.0 : from_forest(recipe) ? 2.0 : 0.0;
}

/// Peak memory [bytes] of the whole program: that of its largest stage. From the first measure on files are written
/// beside the stages, by libraries that take memory of their own, and pictures have at most some pixels.
std::int64_t memory_of(Recipe const& recipe, RiverLines const& lines, std::int64_t cells) {
    constexpr double program = 68e6;
    constexpr double program_with_files = 94e6;
    constexpr double a_pixel = 8.0;
    constexpr double most_pixels = 2e6; // of a map; it has a pixel a cell until then
    constexpr double a_particle = 60.0;
    constexpr double a_cell_of_files = 12.0;
    constexpr double a_cell_of_exact_detail = 120.0; // transforms on a torus of up to seven cells per cell
    auto const of = static_cast<double>(cells);
    double const rivers = bytes_of_rivers(recipe);
    double const files = program_with_files + a_pixel * std::min(of, most_pixels);
    double most = files + of * (a_cell_of_files + rivers);
    double besides = program;
    for (Stage const* const one : stages_of(recipe, lines)) {
        besides = one == &stage::measure ? files : besides;
        most = std::max(most, besides + of * (one->bytes_a_cell + rivers));
    }
    if (levels_of(recipe) > 0 && recipe.detail->midpoint.stencil == fractal::Stencil::exact) {
        most = std::max(most, program + of * a_cell_of_exact_detail);
    }
    if (from_cluster(recipe)) {
        most = std::max(most, program + a_particle * static_cast<double>(recipe.network->dla.particles));
    }
    return std::llround(most);
}

/// What a cluster takes besides its cells [s].
double seconds_of_particles(Recipe const& recipe) {
    return from_cluster(recipe) ? 2.5e-6 * static_cast<double>(recipe.network->dla.particles) +
                                      8e-8 * growth::least_arrivals(recipe.network->dla)
                                : 0.0;
}

/// The Run of a forecast: of what planning finds it reports warnings, and no progress of stages.
Run warnings_only(Run run) {
    run.found = [report = run](Finding const& finding) {
        if (finding.severity() != Severity::note) {
            report.report({finding});
        }
    };
    run.log = {};
    run.planned = {};
    return run;
}

} // namespace

std::int64_t cells_of(Recipe const& recipe, std::optional<Grid> const& grid) {
    return grid ? grid->cells() : cells_of_cluster(recipe.network->dla.particles);
}

void require_memory(Recipe const& recipe, RiverLines const& lines, Grid const& grid) {
    require_free(memory_of(recipe, lines, grid.cells()), grid.width, grid.height);
}

Timings expected_times(Recipe const& recipe, RiverLines const& lines, std::int64_t cells) {
    constexpr double writing = 1.5; // [s] a million cells: files and the page
    double const millions = static_cast<double>(cells) / 1e6;
    Timings expected;
    for (Stage const* const one : stages_of(recipe, lines)) {
        double const besides = one == &stage::grow ? seconds_of_particles(recipe) : 0.0;
        expected.push_back({one->name, millions * one->seconds_a_million + besides});
    }
    expected.push_back({"write", millions * writing});
    return expected;
}

Forecast forecast(Plan const& plan) {
    Forecast found;
    found.grid = plan.grid;
    found.cells = cells_of(plan.recipe, plan.grid);
    for (StageTime const& one : expected_times(plan.recipe, plan.lines, found.cells)) {
        found.stages.push_back(one.stage);
        found.seconds += one.wall_s;
    }
    found.stages.pop_back(); // its files
    found.memory_bytes = memory_of(plan.recipe, plan.lines, found.cells);
    found.findings = plan.findings;
    return found;
}

Forecast forecast(Recipe const& recipe, Run const& run) {
    return forecast(resolve(recipe, warnings_only(run)));
}

} // namespace thalweg::recipe
