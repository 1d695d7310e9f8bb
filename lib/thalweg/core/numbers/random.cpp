// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/random.hpp>

#include <cmath>

#include <Random123/philox.h>

#include <thalweg/core/numbers/elementary.hpp>

namespace thalweg {
namespace {

std::array<std::uint64_t, 4> philox(std::uint64_t seed, std::uint64_t stage, std::uint64_t a, std::uint64_t b,
                                    std::uint64_t c, std::uint64_t d) {
    r123::Philox4x64::ctr_type const counter = {{a, b, c, d}};
    r123::Philox4x64::key_type const key = {{seed, stage}};
    auto const out = r123::Philox4x64{}(counter, key);
    return {out[0], out[1], out[2], out[3]};
}

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

std::array<std::uint64_t, 4> random_block(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c,
                                          std::uint64_t d) {
    return philox(seed, 0, a, b, c, d);
}

void RandomStream::refill() {
    for (std::size_t i = 0; i < words_.size(); i += 4) {
        auto const four = philox(seed_, ~stage_, item_, block_++, 0, 0);
        for (std::size_t k = 0; k < 4; ++k) {
            words_[i + k] = four[k];
        }
    }
    next_ = 0;
}

std::array<double, 2> normal_pair(std::uint64_t first, std::uint64_t second) {
    double const radius = std::sqrt(-2.0 * portable::log(1.0 - unit(first)));
    double const angle = 2.0 * portable::pi * unit(second);
    return {radius * portable::cos(angle), radius * portable::sin(angle)};
}

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
