// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/detail/check_targets.hpp>
#include <thalweg/detail/estimate_fractal.hpp>
#include <thalweg/detail/fine_forms.hpp>
#include <thalweg/detail/midpoint.hpp>
#include <thalweg/detail/noise_row.hpp>
#include <thalweg/detail/project.hpp>
#include <thalweg/detail/refine.hpp>
#include <thalweg/detail/stencil_weights.hpp>
