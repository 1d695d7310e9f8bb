// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/strata/strata.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>

namespace thalweg::surface {
namespace {

constexpr double rad_per_deg = portable::pi / 180.0;

double tangent(double deg) {
    return portable::sin(deg * rad_per_deg) / portable::cos(deg * rad_per_deg);
}

void check(Strata const& strata) {
    constexpr char const* self = "surface.Bed";
    for (std::size_t k = 0; k < strata.layers.size(); ++k) {
        RockLayer const& layer = strata.layers[k];
        auto const name = [k](char const* key) { return fmt::format("layer {} {}", k + 1, key); };
        require_in(self, name("thickness_m"), layer.thickness_m, Range::above(0.0), "m");
        require_in(self, name("strength"), layer.strength, Range::between(0.001, 1000.0));
        require_in(self, name("cliff"), layer.cliff, Range::between(0.01, 20.0));
    }
    require_in(self, "base_m", strata.base_m, Range::finite(), "m");
    require_in(self, "dip_deg", strata.dip_deg, Range::between(0.0, 75.0), "degrees");
    require_in(self, "strike_deg", strata.strike_deg, Range::between(-360.0, 360.0), "degrees");
    require_in(self, "folds amplitude_m", strata.folds.amplitude_m, Range::at_least(0.0), "m");
    require_in(self, "folds wavelength_m", strata.folds.wavelength_m, Range::above(0.0), "m");
    require_in(self, "folds axis_deg", strata.folds.axis_deg, Range::between(-360.0, 360.0), "degrees");
    require_in(self, "folds plunge_deg", strata.folds.plunge_deg, Range::between(-30.0, 30.0), "degrees");
    for (RockDome const& dome : strata.domes) {
        require_in(self, "dome east_m", dome.east_m, Range::finite(), "m");
        require_in(self, "dome north_m", dome.north_m, Range::finite(), "m");
        require_in(self, "dome height_m", dome.height_m, Range::finite(), "m");
        require_in(self, "dome radius_m", dome.radius_m, Range::above(0.0), "m");
    }
    for (RockFault const& fault : strata.faults) {
        require_in(self, "fault east_m", fault.east_m, Range::finite(), "m");
        require_in(self, "fault north_m", fault.north_m, Range::finite(), "m");
        require_in(self, "fault strike_deg", fault.strike_deg, Range::between(-360.0, 360.0), "degrees");
        require_in(self, "fault throw_m", fault.throw_m, Range::finite(), "m");
    }
    require_in(self, "undulation_m", strata.undulation_m, Range::at_least(0.0), "m");
    require_in(self, "undulation_wave_m", strata.undulation_wave_m, Range::above(0.0), "m");
}

} // namespace

Bed::Way Bed::way_of(double deg) {
    return {portable::sin(deg * rad_per_deg), portable::cos(deg * rad_per_deg)};
}

Bed::Bed(Strata const& strata) : strata_(strata) {
    check(strata);
    Way const strike = way_of(strata.strike_deg);
    east_ = -tangent(strata.dip_deg) * strike.north;
    north_ = tangent(strata.dip_deg) * strike.east;
    axis_ = way_of(strata.folds.axis_deg);
    plunge_ = tangent(strata.folds.plunge_deg);
    for (RockFault const& fault : strata.faults) {
        fault_strike_.push_back(way_of(fault.strike_deg));
    }
}

double Bed::folded(double x, double y) const {
    RockFolds const& folds = strata_.folds;
    if (folds.amplitude_m == 0.0) {
        return 0.0;
    }
    constexpr double bend = 0.12;     // of hinges, in wavelengths
    constexpr double bend_wave = 1.1; // [rad] per wavelength along the axis
    double const along = axis_.along(x, y);
    double const across = axis_.to_the_right(x, y) +
                          bend * folds.wavelength_m * portable::sin(bend_wave * along / folds.wavelength_m + 0.4);
    return folds.amplitude_m * portable::cos(2.0 * portable::pi * across / folds.wavelength_m) - plunge_ * along;
}

double Bed::height_m(double east_m, double north_m) const {
    double z = strata_.base_m + east_ * east_m + north_ * north_m + folded(east_m, north_m);
    for (RockDome const& dome : strata_.domes) {
        double const x = east_m - dome.east_m;
        double const y = north_m - dome.north_m;
        z += dome.height_m * portable::exp(-(x * x + y * y) / (2.0 * dome.radius_m * dome.radius_m));
    }
    for (std::size_t k = 0; k < fault_strike_.size(); ++k) {
        RockFault const& fault = strata_.faults[k];
        if (fault_strike_[k].to_the_right(east_m - fault.east_m, north_m - fault.north_m) > 0.0) {
            z -= fault.throw_m;
        }
    }
    if (strata_.undulation_m > 0.0) {
        constexpr double per_m = 64.0;
        Cell const place{std::llround(per_m * east_m), std::llround(per_m * north_m)};
        double const wave = per_m * strata_.undulation_wave_m;
        z += strata_.undulation_m *
             (value_noise(strata_.seed, place, wave) + 0.5 * value_noise(strata_.seed + 1, place, wave / 2.1));
    }
    return z;
}

std::vector<StackedLayer> stack_of(Strata const& strata, double low_m, double high_m) {
    double const upright = 1.0 / portable::cos(strata.dip_deg * rad_per_deg);
    double period = 0.0;
    for (RockLayer const& layer : strata.layers) {
        period += layer.thickness_m * upright;
    }
    double const first = strata.repeats ? std::floor(low_m / period) : 0.0;
    double const last = strata.repeats ? std::max(first, std::floor(high_m / period)) : 0.0;
    constexpr double most = 10'000.0;
    refuse_if<BadInput>(!(last - first <= most), "surface.stack_of",
                        "layers {:.3g} m thick together lie {:.0f} times between the lowest and the highest place; "
                        "make them thicker, or the land less tilted",
                        period, last - first);
    std::vector<StackedLayer> stack;
    for (double round = first; round <= last; round += 1.0) {
        double top = round * period;
        for (std::size_t k = 0; k < strata.layers.size(); ++k) {
            top += strata.layers[k].thickness_m * upright;
            stack.push_back({top, k});
        }
    }
    stack.back().top_m = std::numeric_limits<double>::infinity();
    return stack;
}

std::optional<std::size_t> cap_rock(Strata const& strata) {
    for (std::size_t k = strata.layers.size(); !strata.repeats && k-- > 1;) {
        if (strata.layers[k - 1].strength > strata.layers[k].strength) {
            return k - 1;
        }
    }
    return std::nullopt;
}

Vec2 from_centre(Grid const& grid, Vec2 place) {
    return {place.x - (grid.west + 0.5 * static_cast<double>(grid.width) * grid.cell_m),
            place.y - (grid.north - 0.5 * static_cast<double>(grid.height) * grid.cell_m)};
}

Raster<float> bed_heights(Grid const& grid, Strata const& strata, double shift_m, Run const& run) {
    Bed const bed(strata);
    Raster<float> heights(grid);
    parallel_ranges(run, grid.height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            double const north_m =
                (0.5 * static_cast<double>(grid.height - 1) - static_cast<double>(row)) * grid.cell_m;
            for (std::int64_t col = 0; col < grid.width; ++col) {
                double const east_m =
                    (static_cast<double>(col) - 0.5 * static_cast<double>(grid.width - 1)) * grid.cell_m;
                heights[Cell{col, row}] = static_cast<float>(bed.height_m(east_m, north_m) - shift_m);
            }
        }
    });
    return heights;
}

Raster<std::uint8_t> layers_at(Raster<float> const& dem, Raster<float> const& bed, Strata const& strata,
                               Run const& run) {
    require_in("surface.layers_at", "number of layers", static_cast<double>(strata.layers.size()),
               Range::between(1.0, 255.0));
    require_same_grid(dem.grid(), bed.grid(), "surface.layers_at", "the terrain and the bed", "make both on one grid");
    auto const place = [&](std::int64_t i) { return static_cast<double>(dem[i]) - static_cast<double>(bed[i]); };
    double low = 0.0;
    double high = 0.0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        double const s = place(i);
        low = s < low ? s : low;
        high = s > high ? s : high;
    }
    std::vector<StackedLayer> const stack = stack_of(strata, low - 1.0, high + 1.0);
    constexpr double skin_m = 0.05; // heights are floats, and rivers and banks are settled by less
    Raster<std::uint8_t> layers(dem.grid());
    parallel_ranges(run, dem.cells(), 16384, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (double const s = place(i) - skin_m; !std::isnan(s)) {
                auto const above =
                    std::upper_bound(stack.begin(), stack.end(), s,
                                     [](double at, StackedLayer const& stacked) { return at < stacked.top_m; });
                layers[i] = static_cast<std::uint8_t>(above->layer + 1);
            }
        }
    });
    return layers;
}

std::vector<double> shares_of_layers(Raster<std::uint8_t> const& layers, std::size_t count) {
    std::vector<std::int64_t> cells(count + 1, 0);
    for (std::uint8_t const layer : layers.values()) {
        ++cells.at(layer);
    }
    std::int64_t const with_data = layers.cells() - cells.front();
    std::vector<double> shares;
    for (std::size_t k = 1; k <= count; ++k) {
        shares.push_back(with_data > 0 ? static_cast<double>(cells[k]) / static_cast<double>(with_data) : 0.0);
    }
    return shares;
}

} // namespace thalweg::surface
