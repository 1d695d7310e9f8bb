// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/rock_noise.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parallel.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::surface {

namespace {

constexpr std::uint64_t rock_stage = 0x726f636b; // "rock"
constexpr double shortest_wave = 2.0;
// Eased between four uniform numbers, the variance is about that of one, a twelfth, times a half.
constexpr double to_unit_variance = 5.0;
constexpr double stronger = 1.1; // from octave to octave: gullies want more than the long waves leave them
constexpr int counted_octaves = 8;

/// One octave: its lattice turned and moved against the grid, and the numbers at the nodes that the grid needs.
class Octave {
public:
    Octave(LandLevel const& level, RockNoise const& params, std::uint64_t number, double wave, Run const& run)
        : Octave(params.strike + turn(number, params.stretch), std::sqrt(params.stretch), level.side / wave) {
        double const col = static_cast<double>(level.corner.col) / level.side - 0.5; // centre of the frame's corner
        double const row = static_cast<double>(level.corner.row) / level.side - 0.5;
        x0_ = x_per_col_ * col - x_per_row_ * row + 17.3 * static_cast<double>(number);
        y0_ = y_per_col_ * col + y_per_row_ * row + 91.7 * static_cast<double>(number);
        auto const across = static_cast<double>(level.width);
        auto const down = static_cast<double>(level.height);
        double const left = std::floor(x0_ + std::min(0.0, x_per_col_ * across) + std::min(0.0, -x_per_row_ * down));
        double const top = std::floor(y0_ + std::min(0.0, y_per_col_ * across) + std::min(0.0, y_per_row_ * down));
        double const reach_x = std::fabs(x_per_col_) * across + std::fabs(x_per_row_) * down;
        double const reach_y = std::fabs(y_per_col_) * across + std::fabs(y_per_row_) * down;
        width_ = static_cast<std::int64_t>(reach_x) + 4;
        auto const rows = static_cast<std::int64_t>(reach_y) + 4;
        nodes_.resize(static_cast<std::size_t>(width_ * rows));
        draw(params.seed, number, static_cast<std::int64_t>(left), static_cast<std::int64_t>(top), rows, run);
        x0_ -= left;
        y0_ -= top;
    }

    void add_to_row(std::int64_t row, double weight, float* out, std::int64_t count) const {
        double const x = x0_ - x_per_row_ * static_cast<double>(row);
        double const y = y0_ + y_per_row_ * static_cast<double>(row);
        auto const w = static_cast<float>(weight);
        for (std::int64_t col = 0; col < count; ++col) {
            double const at_x = x + x_per_col_ * static_cast<double>(col);
            double const at_y = y + y_per_col_ * static_cast<double>(col);
            auto const ix = static_cast<std::int32_t>(at_x);
            auto const iy = static_cast<std::int32_t>(at_y);
            float const u = eased(static_cast<float>(at_x - ix));
            float const v = eased(static_cast<float>(at_y - iy));
            float const* const n = &nodes_[static_cast<std::size_t>(iy * width_ + ix)];
            float const upper = n[0] + (n[1] - n[0]) * u;
            float const lower = n[width_] + (n[width_ + 1] - n[width_]) * u;
            out[col] += w * (upper + (lower - upper) * v);
        }
    }

private:
    /// lattice: cells of the level in a cell's width
    Octave(double angle, double stretch, double per_cell)
        : x_per_col_(portable::cos(angle) * per_cell / stretch), x_per_row_(portable::sin(angle) * per_cell / stretch),
          y_per_col_(portable::sin(angle) * per_cell * stretch), y_per_row_(portable::cos(angle) * per_cell * stretch) {
    }

    /// All ways where rock has no grain; else up to 17 degrees to either side of the strike.
    static double turn(std::uint64_t number, double stretch) {
        return stretch > 1.0 ? 0.15 * (static_cast<double>(number * 7919 % 5) - 2.0)
                             : 0.7 * static_cast<double>(number);
    }
    static float eased(float t) { return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F); }

    void draw(std::uint64_t seed, std::uint64_t number, std::int64_t left, std::int64_t top, std::int64_t rows,
              Run const& run) {
        constexpr std::int64_t a_block = 8;
        parallel_ranges(run, rows, 16, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                std::array<std::uint64_t, 4> words{};
                std::int64_t held = -1;
                for (std::int64_t col = 0; col < width_; ++col) {
                    // Counted from far to the left, so that blocks lie where they lie for any grid.
                    std::int64_t const at = left + col + (std::int64_t{1} << 40);
                    if (at / a_block != held) {
                        held = at / a_block;
                        words = random_block(seed, rock_stage, number, static_cast<std::uint64_t>(top + row),
                                             static_cast<std::uint64_t>(held));
                    }
                    auto const k = static_cast<std::uint64_t>(at % a_block);
                    auto const half = static_cast<std::uint32_t>(words[k / 2] >> (32 * (k % 2)));
                    nodes_[static_cast<std::size_t>(row * width_ + col)] =
                        static_cast<float>(static_cast<double>(half) * 0x1p-32 - 0.5);
                }
            }
        });
    }

    double x_per_col_; ///< along the strike, in widths of the lattice
    double x_per_row_;
    double y_per_col_; ///< across
    double y_per_row_;
    double x0_ = 0.0;
    double y0_ = 0.0;
    std::int64_t width_ = 0;
    Cells<float> nodes_;
};

} // namespace

Cells<float> rock_noise(LandLevel const& level, RockNoise const& params, Run const& run) {
    Cells<float> noise(static_cast<std::size_t>(level.cells()));
    double variance = 0.0;
    double part = 1.0;
    for (int octave = 0; octave < counted_octaves; ++octave, part *= stronger * stronger) {
        variance += part;
    }
    double weight = to_unit_variance / std::sqrt(variance);
    double wave = params.longest_wave;
    double const shortest = std::max(shortest_wave, 1.5 * static_cast<double>(level.side));
    for (std::uint64_t number = 0; wave >= shortest; ++number, wave /= 2.0, weight *= stronger) {
        Octave const octave(level, params, number, wave, run);
        parallel_ranges(run, level.height, 16, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                octave.add_to_row(row, weight, &noise[static_cast<std::size_t>(row * level.width)], level.width);
            }
        });
    }
    return noise;
}

} // namespace thalweg::surface
