// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/rock.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parallel.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg::surface {

namespace {

/// Mean of a field over some finest cells, without those that have none.
float mean_over(Raster<float> const& field, Cell from, std::int64_t side) {
    double sum = 0.0;
    double count = 0.0;
    for (std::int64_t r = from.row; r < from.row + side; ++r) {
        for (std::int64_t c = from.col; c < from.col + side; ++c) {
            Cell const at{std::clamp<std::int64_t>(c, 0, field.width() - 1),
                          std::clamp<std::int64_t>(r, 0, field.height() - 1)};
            if (float const value = field[at]; !std::isnan(value)) {
                sum += static_cast<double>(value);
                count += 1.0;
            }
        }
    }
    return count > 0.0 ? static_cast<float>(sum / count) : 1.0F;
}

Cells<float> level_of(Raster<float> const& field, LandLevel const& level) {
    auto const side = static_cast<std::int64_t>(level.side);
    Cells<float> out(static_cast<std::size_t>(level.cells()), 1.0F);
    for (std::int64_t row = 1; row + 1 < level.height; ++row) {
        for (std::int64_t col = 1; col + 1 < level.width; ++col) {
            Cell const from{level.corner.col + (col - 1) * side, level.corner.row + (row - 1) * side};
            out[static_cast<std::size_t>(row * level.width + col)] = mean_over(field, from, side);
        }
    }
    return out;
}

} // namespace

void set_rock(LandLevel& level, RockFields const& fields, RockParams const& params, Run const& run) {
    level.erodibility = rock_noise(level, params.noise, run);
    level.cap.resize(level.erodibility.size());
    bool const rocks = fields.erodibility.cells() > 0;
    Cells<float> const rock = rocks ? level_of(fields.erodibility, level) : Cells<float>{};
    if (fields.uplift.cells() > 0) {
        level.uplift = level_of(fields.uplift, level);
    }
    parallel_ranges(run, level.cells(), 1 << 14, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            double const noise = level.cover[i] == Cover::river ? 0.0 : static_cast<double>(level.erodibility[i]);
            double fifth_root = portable::exp(0.2 * params.roughness * noise);
            if (rocks) {
                fifth_root *= portable::pow(static_cast<double>(rock[i]), 0.2);
            }
            double const fourth = fifth_root * fifth_root * fifth_root * fifth_root;
            level.erodibility[i] = static_cast<float>(fourth * fifth_root);
            level.cap[i] = static_cast<float>(static_cast<double>(steepest_tangent) / fourth);
        }
    });
}

} // namespace thalweg::surface
