// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

Rows<surface::DiffuseParams> diffusion_keys() {
    using surface::DiffuseParams;
    using surface::Diffusion;
    using surface::DiffusionStart;
    Use const by_sweeps = by_diffusion() && is("surface.diffusion", {"explicit"});
    return {
        choice("diffusion", &DiffuseParams::mode)
            .one_of({{"steady", Diffusion::steady}, {"explicit", Diffusion::explicit_sweeps}})
            .used(by_diffusion())
            .means("steady state, or a number of explicit sweeps as published"),
        number("sweeps", &DiffuseParams::iterations).range({0, 1e9}).used(by_sweeps).means("number of explicit sweeps"),
        choice("start", &DiffuseParams::start)
            .one_of({{"coarse", DiffusionStart::coarse}, {"zero", DiffusionStart::zero}})
            .used(by_sweeps)
            .means("where sweeps start: from the steady state of a coarser grid, or from 0 as published"),
        number("alpha", &DiffuseParams::alpha)
            .range({0, 0.25, left_open})
            .used(by_sweeps)
            .means("D dt / h^2 of an explicit sweep"),
        number("smoothing", &DiffuseParams::sigma_cells)
            .unit("cells")
            .range({0, 100})
            .used(by_diffusion())
            .means("sigma of Gaussian smoothing away from rivers, ridges and points; 0: none"),
        number("noise", &DiffuseParams::noise_m)
            .unit("m")
            .range({0, 1e5})
            .used(by_diffusion())
            .means("amplitude of noise far from rivers, ridges and points"),
    };
}

} // namespace thalweg::pipeline
