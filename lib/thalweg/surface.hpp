// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Rivers and a skeleton → a height for every cell: equilibrium, dilation, diffusion, TINs.
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>
#include <thalweg/surface/dilation/increment.hpp>
#include <thalweg/surface/dilation/separable.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/features.hpp>
#include <thalweg/surface/equilibrium/match_texture.hpp>
#include <thalweg/surface/equilibrium/rebuild.hpp>
#include <thalweg/surface/gaps/close_gaps.hpp>
#include <thalweg/surface/strata/strata.hpp>
#include <thalweg/surface/tin/level_areas.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>
