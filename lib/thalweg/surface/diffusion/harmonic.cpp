// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/harmonic.hpp>

#include <thalweg/surface/diffusion/internal/heights_of.hpp>
#include <thalweg/surface/diffusion/internal/problem_through.hpp>

#include <utility>

namespace thalweg::surface {

Raster<float> harmonic(Valley const& valley, Run const& run) {
    return harmonic(valley, {}, run);
}

Raster<float> harmonic(Valley const& valley, Mask const& inside, Run const& run) {
    return harmonic(valley, inside, HarmonicParams{}, run);
}

Raster<float> harmonic(Valley const& valley, Mask const& inside, HarmonicParams const& params, Run const& run) {
    auto problem = problem_through(valley.z, inside, "surface.harmonic", run);
    Raster<std::uint8_t> const kind = problem.kind;
    return heights_of(solver::solve_poisson(std::move(problem), {params.tolerance, 1000}, run).value, kind, valley.z);
}

} // namespace thalweg::surface
