// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All public headers of the module.
#include <thalweg/solver/grid/poisson.hpp>
#include <thalweg/solver/grid/relax_explicit.hpp>
#include <thalweg/solver/grid/unreached.hpp>
#include <thalweg/solver/linear/cholesky.hpp>
#include <thalweg/solver/linear/least_squares.hpp>
#include <thalweg/solver/linear/matrix.hpp>
#include <thalweg/solver/linear/sparse.hpp>
#include <thalweg/solver/opencl/devices.hpp>
#include <thalweg/solver/spectral/circulant.hpp>
#include <thalweg/solver/spectral/fft.hpp>
#include <thalweg/solver/spectral/fractional_surface.hpp>
#include <thalweg/solver/spectral/stable_covariance.hpp>
#include <thalweg/solver/statistics/central_difference.hpp>
#include <thalweg/solver/statistics/correlation_length.hpp>
#include <thalweg/solver/statistics/expected_slope.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>
#include <thalweg/solver/statistics/fractal_dimension.hpp>
#include <thalweg/solver/statistics/lags.hpp>
