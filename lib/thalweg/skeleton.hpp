// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/skeleton/attract.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/field_params.hpp>
#include <thalweg/skeleton/grf.hpp>
#include <thalweg/skeleton/markov3.hpp>
#include <thalweg/skeleton/midpoint_inverse.hpp>
#include <thalweg/skeleton/noise_along.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/skeleton/scatter_between.hpp>
#include <thalweg/skeleton/separable_ar.hpp>
#include <thalweg/skeleton/shift_mean.hpp>
