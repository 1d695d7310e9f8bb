// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <thalweg/skeleton/scatter.hpp>

namespace thalweg::pipeline {

/// The land that the statistics are brought to.
enum class Prior : std::uint8_t { grf, separable, markov3, points };

/// Targets for the terrain as a whole; others stay free.
struct StatisticsRecipe {
    std::optional<double> mean;                  ///< [m]
    std::optional<double> std;                   ///< [m] > 0
    std::optional<std::array<double, 3>> max;    ///< height [m], column, row
    std::optional<std::array<double, 3>> min;    ///< likewise
    std::optional<std::array<double, 2>> length; ///< [cells] > 0, along rows and along columns
    std::optional<double> slope;                 ///< [rad] (0, pi/2) arctan of metres a cell
    std::optional<double> dimension;             ///< (2, 3)
    Prior skeleton = Prior::grf;
    double reach_cells = 6.0; ///< [cells] >= 0, R of equations 4 and 10; 0 pulls nothing
    skeleton::Falloff falloff = skeleton::Falloff::continuous;
};

} // namespace thalweg::pipeline
