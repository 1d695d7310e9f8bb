// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/value_noise.hpp>

#include <thalweg/core/numbers/random.hpp>

#include <cmath>

namespace thalweg {
namespace {

constexpr std::uint64_t stage = 0x6e6f697365; // "noise"

double node(std::uint64_t seed, double x, double y) {
    return 2.0 * unit(random_word(seed, stage, static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y))) - 1.0;
}

double eased(double t) {
    return t * t * (3.0 - 2.0 * t);
}

double mixed(double a, double b, double t) {
    return a + (b - a) * t;
}

} // namespace

double value_noise(std::uint64_t seed, Cell cell, double lattice_cells) {
    double const x = (static_cast<double>(cell.col) + 0.5) / lattice_cells;
    double const y = (static_cast<double>(cell.row) + 0.5) / lattice_cells;
    double const left = std::floor(x);
    double const top = std::floor(y);
    double const across = eased(x - left);
    return mixed(mixed(node(seed, left, top), node(seed, left + 1.0, top), across),
                 mixed(node(seed, left, top + 1.0), node(seed, left + 1.0, top + 1.0), across), eased(y - top));
}

} // namespace thalweg
