// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Numbers, rivers and points → heights that a surface must pass through: random fields and points, ridges, regression.
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/midpoint_inverse.hpp>
#include <thalweg/skeleton/random_fields.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/skeleton/scatter.hpp>
