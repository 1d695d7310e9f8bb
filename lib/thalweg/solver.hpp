// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Numbers → numbers: Laplace and Poisson on grids, Fourier transforms, least squares, statistics of fields.
#include <thalweg/solver/grid/poisson.hpp>
#include <thalweg/solver/linear/linear.hpp>
#include <thalweg/solver/opencl/devices.hpp>
#include <thalweg/solver/spectral/circulant.hpp>
#include <thalweg/solver/spectral/fft.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>
