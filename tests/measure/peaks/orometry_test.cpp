// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/peaks/orometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/run.hpp>

#include "dems.hpp"

namespace orometry_test {

using namespace thalweg;
using measure::isolation;
using measure::orometry;
using measure::Orometry;
using measure::OrometryParams;
using measure::Peak;
using measure::prominent_peaks;

namespace {

bool is_higher(Raster<float> const& dem, std::int64_t a, std::int64_t b) {
    return dem[a] > dem[b] || (dem[a] == dem[b] && a < b);
}

bool is_peak(Raster<float> const& dem, std::int64_t cell) {
    Cell const at = dem.grid().at(cell);
    return !std::isnan(dem[cell]) && std::all_of(d8_steps.begin(), d8_steps.end(), [&](Cell step) {
        Cell const there{at.col + step.col, at.row + step.row};
        return dem.grid().contains(there) && !std::isnan(dem[there]) && is_higher(dem, cell, dem.grid().index(there));
    });
}

/// Floods down from the peak, at each step over the highest cell of the edge, until higher land is met.
double prominence_by_flooding(Raster<float> const& dem, std::int64_t peak) {
    std::vector<std::int64_t> edge{peak};
    std::vector<bool> seen(static_cast<std::size_t>(dem.cells()));
    seen[static_cast<std::size_t>(peak)] = true;
    float lowest = dem[peak];
    while (!edge.empty()) {
        auto const at = std::max_element(edge.begin(), edge.end(),
                                         [&](std::int64_t a, std::int64_t b) { return is_higher(dem, b, a); });
        std::int64_t const cell = *at;
        edge.erase(at);
        if (is_higher(dem, cell, peak)) {
            break;
        }
        lowest = std::min(lowest, dem[cell]);
        for (Cell const step : d8_steps) {
            Cell const there{dem.grid().at(cell).col + step.col, dem.grid().at(cell).row + step.row};
            if (dem.grid().contains(there) && !std::isnan(dem[there]) &&
                !seen[static_cast<std::size_t>(dem.grid().index(there))]) {
                seen[static_cast<std::size_t>(dem.grid().index(there))] = true;
                edge.push_back(dem.grid().index(there));
            }
        }
    }
    return static_cast<double>(dem[peak]) - static_cast<double>(lowest);
}

} // namespace

TEST(ProminentPeaks, AsFoundByFlooding) {
    ASSERT_TRUE(rc::check("every peak, and its key saddle", [] {
        Raster<float> const dem = *gen_dem(14, 10);
        std::vector<Peak> const found = prominent_peaks(dem, 0.0);
        std::size_t next = 0;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (!is_peak(dem, i)) {
                continue;
            }
            RC_ASSERT(next < found.size());
            RC_ASSERT(found[next].cell == i);
            RC_ASSERT(found[next].height_m == static_cast<double>(dem[i]));
            RC_ASSERT(found[next].prominence_m == prominence_by_flooding(dem, i));
            ++next;
        }
        RC_ASSERT(next == found.size());
    }));
}

TEST(ProminentPeaks, AsFoundByFloodingOfManyRows) {
    // Land that rises to the south, so that ascents lead through many rows, with humps and a lake.
    Raster<float> dem(Grid{6, 300, 10.0, 0.0, 0.0, {}});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const at = dem.grid().at(i);
        auto const noise = static_cast<float>(random_word(5, static_cast<std::uint64_t>(i)) >> 58U);
        dem[i] = static_cast<float>(at.row) + (at.row > 200 ? noise : at.row > 100 ? 0.02F * noise : 0.0F);
        if (at.row > 125 && at.row < 131 && at.col > 0) {
            dem[i] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    std::vector<Peak> const found = prominent_peaks(dem, 0.0);
    ASSERT_GT(found.size(), 20U);
    for (Peak const& peak : found) {
        EXPECT_TRUE(is_peak(dem, peak.cell));
        EXPECT_EQ(peak.prominence_m, prominence_by_flooding(dem, peak.cell));
    }
    thalweg::Run serial;
    serial.threads = 1;
    EXPECT_EQ(prominent_peaks(dem, 0.0, serial).size(), found.size());
}

TEST(ProminentPeaks, LeavesOutSmallOnes) {
    Raster<float> const dem = dem_of(7, {0, 0, 0, 0, 0, 0, 0, //
                                         0, 9, 3, 4, 0, 5, 0, //
                                         0, 0, 0, 0, 0, 0, 0});
    ASSERT_EQ(prominent_peaks(dem, 0.0).size(), 3U);
    std::vector<Peak> const found = prominent_peaks(dem, 2.0);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].prominence_m, 9.0);
    EXPECT_EQ(found[1].prominence_m, 5.0);
    EXPECT_THROW(prominent_peaks(dem, -1.0), BadParameter);
    EXPECT_TRUE(prominent_peaks(Raster<float>{}, 0.0).empty());
}

TEST(Isolation, IsTheNearestHigherCell) {
    ASSERT_TRUE(rc::check("as looked for in the whole DEM", [] {
        Raster<float> const dem = *gen_dem(14, 10);
        auto const cell = *evenly<std::int64_t>(0, dem.cells());
        std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
        Cell const at = dem.grid().at(cell);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const there = dem.grid().at(i);
            if (dem[i] > dem[cell]) {
                nearest = std::min(nearest, (there.col - at.col) * (there.col - at.col) +
                                                (there.row - at.row) * (there.row - at.row));
            }
        }
        double const found = isolation(dem, cell);
        if (nearest == std::numeric_limits<std::int64_t>::max()) {
            RC_ASSERT(std::isnan(found));
        } else {
            RC_ASSERT(found == std::sqrt(static_cast<double>(nearest)) * dem.grid().cell_m);
        }
    }));
    Raster<float> const dem = rough_dem(frame(3, 3), 1);
    EXPECT_THROW(isolation(dem, -1), BadInput);
    EXPECT_THROW(isolation(dem, 9), BadInput);
}

TEST(Orometry, CountsByArea) {
    Raster<float> dem(frame(9, 5));
    dem[Cell{2, 2}] = 100.0F;
    dem[Cell{6, 2}] = 50.0F;
    dem[Cell{4, 3}] = 20.0F; // too little
    Orometry const found = orometry(dem);
    EXPECT_EQ(found.peaks, 2);
    EXPECT_DOUBLE_EQ(found.peaks_per_km2, 2.0 / 45e-6);
    EXPECT_EQ(found.median_prominence_m, 75.0);
    EXPECT_EQ(found.median_isolation_m, 4.0); // nothing is higher than the highest
    EXPECT_THROW(orometry(dem, {.least_prominence_m = std::nan("")}), BadParameter);
    EXPECT_TRUE(std::isnan(orometry(Raster<float>{}).peaks_per_km2));
    EXPECT_TRUE(std::isnan(orometry(Raster<float>(frame(5, 5), 1.0F)).median_isolation_m));
}

// Blocks of cells and rings of cells find the same.
TEST(Orometry, IsolationIsThatOfEachPeak) {
    for (auto const& [width, height] : {std::pair<std::int64_t, std::int64_t>(150, 97), {16, 33}, {40, 3}}) {
        Raster<float> dem = rough_dem(frame(width, height), 7);
        dem[Cell{width / 2, 1}] = hole;
        OrometryParams const params{.least_prominence_m = 0.0};
        std::vector<double> far;
        for (Peak const& peak : prominent_peaks(dem, 0.0)) {
            if (double const found = isolation(dem, peak.cell); !std::isnan(found)) {
                far.push_back(found);
            }
        }
        std::sort(far.begin(), far.end());
        ASSERT_FALSE(far.empty());
        double const middle = 0.5 * (far[far.size() / 2] + far[(far.size() - 1) / 2]);
        EXPECT_EQ(orometry(dem, params).median_isolation_m, middle);
    }
}

} // namespace orometry_test
