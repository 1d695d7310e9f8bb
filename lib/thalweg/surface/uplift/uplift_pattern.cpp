// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/uplift/uplift_pattern.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/vec.hpp>

// Described in docs/equilibrium.md.

namespace thalweg::surface {

namespace {

constexpr std::uint64_t strike_stage = 0x737472696b65;    // "strike"
constexpr std::uint64_t uplift_stage = 0x75706c696674;    // "uplift"
constexpr std::uint64_t pattern_stage = 0x7061747465726e; // "pattern"
constexpr double radians = portable::pi / 180.0;

/// A position in wavelengths from the grid's centre.
struct Place {
    double along; ///< along the strike
    double across;
};

double at_node(std::uint64_t seed, std::uint64_t which, double i, double j = 0.0) {
    auto const word = [](double k) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(k)); };
    return unit(random_word(seed, uplift_stage, which, word(i), word(j)));
}

/// Smooth noise along a line, in [-1, 1], of wavelength 2.
double along_line(std::uint64_t seed, std::uint64_t which, double at) {
    double const node = std::floor(at);
    double const t = at - node;
    double const a = at_node(seed, which, node);
    double const b = at_node(seed, which, node + 1.0);
    return 2.0 * (a + (b - a) * t * t * (3.0 - 2.0 * t)) - 1.0;
}

double dome(std::uint64_t seed, Place p) {
    constexpr double reach = 0.8; // of a dome
    double most = 0.0;
    for (double i = std::floor(p.along) - 1.0; i <= std::floor(p.along) + 1.0; i += 1.0) {
        for (double j = std::floor(p.across) - 1.0; j <= std::floor(p.across) + 1.0; j += 1.0) {
            double const dx = i + 0.15 + 0.7 * at_node(seed, 0, i, j) - p.along;
            double const dy = j + 0.15 + 0.7 * at_node(seed, 1, i, j) - p.across;
            double const t = std::min(1.0, (dx * dx + dy * dy) / (reach * reach));
            most = std::max(most, (0.4 + 0.6 * at_node(seed, 2, i, j)) * (1.0 - t) * (1.0 - t));
        }
    }
    return most;
}

double block(std::uint64_t seed, Place p) {
    double const bent = p.across + 0.15 * along_line(seed, 3, p.along);
    auto const fault = [&](double k) { return k + 0.35 * at_node(seed, 4, k); };
    double k = std::floor(bent);
    k -= bent < fault(k) ? 1.0 : 0.0;
    double const t = (bent - fault(k)) / (fault(k + 1.0) - fault(k));
    double const height = at_node(seed, 5, k);
    bool const rises_eastward = at_node(seed, 6, k) < 0.5;
    return 0.4 * height + 0.6 * (rises_eastward ? t : 1.0 - t);
}

double fold(std::uint64_t seed, Place p) {
    double const bent = p.across + 0.12 * along_line(seed, 7, p.along);
    double const plunge = 0.7 + 0.3 * along_line(seed, 8, 0.3 * p.along);
    return 0.5 + 0.5 * plunge * portable::cos(2.0 * portable::pi * bent);
}

/// The share of the range from the least to the largest uplift at a position.
double share_at(UpliftPatternParams const& params, Place p, double half_width) {
    switch (params.pattern) {
    case UpliftPattern::tilt: return 0.5 + 0.5 * p.across / half_width;
    case UpliftPattern::domes: return dome(params.seed, p);
    case UpliftPattern::blocks: return block(params.seed, p);
    case UpliftPattern::folds:
    case UpliftPattern::seed: break;
    }
    return fold(params.seed, p);
}

void check(UpliftPatternParams const& params) {
    constexpr char const* self = "surface.uplift_pattern";
    require_in(self, "contrast", params.contrast, Range::between(1.0, 100.0));
    require_in(self, "wave_m", params.wave_m, Range::above(0.0), "m");
    require_in(self, "strike_deg", params.strike_deg, Range::between(-360.0, 360.0), "degrees");
}

} // namespace

double random_strike_deg(std::uint64_t seed) {
    return 90.0 - 180.0 * unit(random_word(seed, strike_stage));
}

UpliftPattern uplift_pattern_of_seed(std::uint64_t seed) {
    constexpr std::array<UpliftPattern, 3> patterns = {UpliftPattern::domes, UpliftPattern::blocks,
                                                       UpliftPattern::folds};
    double const at = unit(random_word(seed, pattern_stage)) * static_cast<double>(patterns.size());
    return patterns[std::min(static_cast<std::size_t>(at), patterns.size() - 1)];
}

Raster<float> uplift_pattern(Grid const& grid, UpliftPatternParams const& asked, Run const& run) {
    check(asked);
    UpliftPatternParams params = asked;
    if (params.pattern == UpliftPattern::seed) {
        params.pattern = uplift_pattern_of_seed(params.seed);
    }
    double const strike = params.pattern == UpliftPattern::domes ? 0.0 : params.strike_deg * radians;
    Vec2 const along{portable::sin(strike), portable::cos(strike)};
    Vec2 const across{along.y, -along.x};
    double const width_m = static_cast<double>(grid.width) * grid.cell_m;
    double const height_m = static_cast<double>(grid.height) * grid.cell_m;
    double const half_width = 0.5 * (std::fabs(across.x) * width_m + std::fabs(across.y) * height_m) / params.wave_m;
    double const log_contrast = portable::log(params.contrast);
    Raster<float> uplift(grid);
    parallel_ranges(run, grid.height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            double const north = (0.5 * height_m - (static_cast<double>(row) + 0.5) * grid.cell_m) / params.wave_m;
            for (std::int64_t col = 0; col < grid.width; ++col) {
                double const east = ((static_cast<double>(col) + 0.5) * grid.cell_m - 0.5 * width_m) / params.wave_m;
                Place const p{along.x * east + along.y * north, across.x * east + across.y * north};
                double const share = std::clamp(share_at(params, p, half_width), 0.0, 1.0);
                uplift[Cell{col, row}] = static_cast<float>(portable::exp(log_contrast * (share - 0.5)));
            }
        }
    });
    return uplift;
}

} // namespace thalweg::surface
