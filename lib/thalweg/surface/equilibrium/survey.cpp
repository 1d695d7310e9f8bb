// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/surface/equilibrium/internal/known_features.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/rebuild_steps.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>
#include <thalweg/surface/equilibrium/rebuild.hpp>

// Described in docs/rebuild.md.

namespace thalweg::surface {
namespace {

constexpr double degrees_per_radian = 180.0 / portable::pi;

/// A level that has nothing but the rivers.
TerrainLevel bare_level(Channels const& rivers) {
    TerrainLevel level;
    level.width = rivers.grid.width + 2;
    level.height = rivers.grid.height + 2;
    for (CellIndex const cell : rivers.cell) {
        Cell const c = rivers.grid.at(cell);
        level.rivers.cell.push_back(static_cast<std::uint32_t>((c.row + 1) * level.width + c.col + 1));
    }
    return level;
}

/// The long profiles of rivers.
class RiverProfiles {
public:
    /// \param cells by river cell: cells nearest to it
    RiverProfiles(Channels const& rivers, std::vector<double> cells, double window_m)
        : rivers_(rivers), window_m_(window_m), area_km2_(std::move(cells)), length_m_(area_km2_.size(), 0.0),
          stem_(area_km2_.size(), -1) {
        double const cell_km2 = rivers.grid.cell_m * rivers.grid.cell_m * 1e-6;
        for (std::size_t n = area_km2_.size(); n-- > 0;) {
            area_km2_[n] *= cell_km2;
        }
        for (std::size_t n = area_km2_.size(); n-- > 0;) {
            std::int64_t const r = rivers.receiver[n];
            if (r >= 0) {
                area_km2_[r] += area_km2_[n];
                Cell const a = rivers.grid.at(rivers.cell[n]);
                Cell const b = rivers.grid.at(rivers.cell[r]);
                bool const diagonal = a.col != b.col && a.row != b.row;
                length_m_[n] = rivers.grid.cell_m * (diagonal ? std::sqrt(2.0) : 1.0);
                if (stem_[r] < 0 || area_km2_[n] > area_km2_[stem_[r]]) {
                    stem_[r] = static_cast<std::int64_t>(n);
                }
            }
        }
    }

    double area_km2(std::size_t n) const { return area_km2_[n]; }
    bool is_source(std::size_t n) const { return stem_[n] < 0; }

    /// The slope over half a window downstream and half upstream; NaN: lake, or too short a river.
    double slope(std::size_t n) const {
        constexpr double least = 1e-4;
        constexpr double known = 0.4; // share of the window
        if (is_lake(n)) {
            return std::nan("");
        }
        auto const half = 0.5 * window_m_;
        Below const below = walk_down(n);
        double up = 0.0;
        auto high = static_cast<std::int64_t>(n);
        while (stem_[high] >= 0 && up < half) {
            high = stem_[high];
            up += length_m_[high];
        }
        double const fall = static_cast<double>(rivers_.z[high]) - static_cast<double>(rivers_.z[below.cell]);
        double const way = below.way_m + up;
        return way > known * window_m_ ? std::max(fall / way, least) : std::nan("");
    }

    /// The cell half a window downstream.
    std::size_t below(std::size_t n) const { return walk_down(n).cell; }

private:
    struct Below {
        std::size_t cell;
        double way_m;
    };
    Below walk_down(std::size_t n) const {
        double down = 0.0;
        while (rivers_.receiver[n] >= 0 && down < 0.5 * window_m_) {
            down += length_m_[n];
            n = static_cast<std::size_t>(rivers_.receiver[n]);
        }
        return {n, down};
    }

    bool is_lake(std::size_t n) const { return !rivers_.level.empty() && rivers_.level[n] != 0; }

    Channels const& rivers_;
    double window_m_;
    std::vector<double> area_km2_;
    std::vector<double> length_m_;   ///< to the receiver
    std::vector<std::int64_t> stem_; ///< the donor with the largest area; -1: none
};

/// -d ln slope / d ln area over bins of areas, by the root of their counts.
double concavity_of(std::vector<double> const& log_area, std::vector<double> const& log_slope) {
    constexpr double usual = 0.45;
    constexpr double width = 0.405465108108164; // ln 1.5
    constexpr std::size_t bins = 256;
    constexpr double least_count = 30.0;
    struct Bin {
        double area = 0.0;
        double slope = 0.0;
        double count = 0.0;
    };
    std::array<Bin, bins> all{};
    for (std::size_t k = 0; k < log_area.size(); ++k) {
        auto const at = std::clamp(std::floor(log_area[k] / width) + 0.5 * bins, 0.0, bins - 1.0);
        Bin& bin = all[static_cast<std::size_t>(at)];
        bin.area += log_area[k];
        bin.slope += log_slope[k];
        bin.count += 1.0;
    }
    double s = 0.0;
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (Bin const& bin : all) {
        if (bin.count >= least_count) {
            double const w = std::sqrt(bin.count);
            double const x = bin.area / bin.count;
            double const y = bin.slope / bin.count;
            s += w;
            sx += w * x;
            sy += w * y;
            sxx += w * x * x;
            sxy += w * x * y;
        }
    }
    double const spread = s * sxx - sx * sx;
    return spread > 0.0 ? std::clamp(-(s * sxy - sx * sy) / spread, 0.2, 1.2) : usual;
}

EquilibriumParams closed_edge() {
    EquilibriumParams params;
    params.edge = Edge::closed;
    return params;
}

double median_of(std::vector<float> values) {
    auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return static_cast<double>(*middle);
}

/// [km²] by river cell, by the nearest river cell.
std::vector<double> areas_of(Channels const& rivers) {
    TerrainLevel const level = bare_level(rivers);
    NearestRiver const near = nearest_river(level);
    std::vector<double> area(rivers.cell.size(), 0.0);
    double const cell_km2 = rivers.grid.cell_m * rivers.grid.cell_m * 1e-6;
    each_inner(level, [&](std::size_t i) { area[near.number[i]] += cell_km2; });
    for (std::size_t n = area.size(); n-- > 0;) {
        if (std::int64_t const r = rivers.receiver[n]; r >= 0) {
            area[r] += area[n];
        }
    }
    return area;
}

/// Gives the ends of rivers without any height that of the nearest cell that has one.
void end_unknown_rivers(Channels& rivers) {
    std::vector<std::uint8_t> known(rivers.cell.size()); // by end: whether a cell upstream has a height
    for (std::size_t n = known.size(); n-- > 0;) {
        known[n] = known[n] != 0 || !std::isnan(rivers.z[n]) ? 1 : 0;
        if (std::int64_t const r = rivers.receiver[n]; r >= 0 && known[n] != 0) {
            known[r] = 1;
        }
    }
    TerrainLevel const level = bare_level(rivers);
    std::vector<std::uint32_t> cells;
    std::vector<float> heights;
    for (std::size_t n = 0; n < known.size(); ++n) {
        if (!std::isnan(rivers.z[n])) {
            cells.push_back(level.rivers.cell[n]);
            heights.push_back(rivers.z[n]);
        }
    }
    refuse_if<BadInput>(cells.empty(), "surface.rebuild", "no river cell has a height; give one at least");
    NearestRiver const near = nearest_of(level, cells);
    for (std::size_t n = 0; n < known.size(); ++n) {
        if (rivers.receiver[n] < 0 && known[n] == 0) {
            rivers.z[n] = heights[near.number[level.rivers.cell[n]]];
        }
    }
}

} // namespace

Channels with_heights(Channels rivers) {
    rivers.z.resize(rivers.cell.size(), std::nanf(""));
    if (std::none_of(rivers.z.begin(), rivers.z.end(), [](float z) { return std::isnan(z); })) {
        return rivers;
    }
    end_unknown_rivers(rivers);
    constexpr double theta = 0.45;
    constexpr double usual = 0.03; // slope where 1 km² drains
    std::vector<double> const area = areas_of(rivers);
    RiverCells const cells = padded(rivers, {}, closed_edge()).rivers;
    std::vector<float> fall(cells.cell.size(), 0.0F);
    std::vector<float> steepness;
    for (std::size_t n = 0; n < fall.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        if (r < 0) {
            continue;
        }
        double const length = rivers.grid.cell_m * static_cast<double>(step_lengths[cells.direction[n]]);
        fall[n] = static_cast<float>(length / portable::pow(std::max(area[n], 0.1), theta));
        if (float const drop = rivers.z[n] - rivers.z[r]; drop > 0.0F) {
            steepness.push_back(drop / fall[n]);
        }
    }
    float const k = steepness.empty() ? static_cast<float>(usual) : static_cast<float>(median_of(std::move(steepness)));
    std::transform(fall.begin(), fall.end(), fall.begin(), [k](float of) { return k * of; });
    rivers.z = heights_through(cells, fall, rivers.z);
    return rivers;
}

RiverSurvey survey_rivers(Channels const& rivers, Run const& run) {
    Grid const& grid = rivers.grid;
    TerrainLevel const level = bare_level(rivers);
    NearestRiver const near = straight_to(level, level.rivers.cell, run);
    std::vector<double> nearest(rivers.cell.size(), 0.0);
    std::vector<float> far;
    far.reserve(static_cast<std::size_t>(grid.cells()));
    each_inner(level, [&](std::size_t i) {
        nearest[near.number[i]] += 1.0;
        far.push_back(near.distance[i]);
    });
    RiverSurvey survey;
    survey.spacing_m = std::max(median_of(std::move(far)), 1.0) * grid.cell_m;
    double const window_m = std::max(std::min(500.0, 1.2 * survey.spacing_m), 6.0 * grid.cell_m);
    RiverProfiles const profiles(rivers, std::move(nearest), window_m);
    std::vector<double> slope(rivers.cell.size());
    std::vector<double> log_area;
    std::vector<double> log_slope;
    for (std::size_t n = 0; n < slope.size(); ++n) {
        slope[n] = profiles.slope(n);
        if (slope[n] > 0.0 && profiles.area_km2(n) > 0.0) {
            log_area.push_back(portable::log(profiles.area_km2(n)));
            log_slope.push_back(portable::log(slope[n]));
        }
    }
    survey.concavity = concavity_of(log_area, log_slope);

    // Source: mean slope of seven DEMs smoothed between rivers; the cap of threshold slopes bends the relation.
    constexpr double theta = 0.45;
    double tangents = 0.0;
    double sources = 0.0;
    std::vector<float> source_km2;
    for (std::size_t n = 0; n < slope.size(); ++n) {
        std::size_t const at = profiles.below(n);
        if (profiles.is_source(n)) {
            source_km2.push_back(static_cast<float>(profiles.area_km2(n)));
        }
        if (profiles.is_source(n) && slope[at] > 0.0) {
            double const k = slope[at] * portable::pow(std::max(profiles.area_km2(at), 0.1), theta);
            tangents += 3.7 * k / (1.0 + 5.1 * k);
            sources += 1.0;
        }
    }
    survey.source_km2 = source_km2.empty() ? 0.0 : median_of(std::move(source_km2));
    constexpr double usual = 0.31;
    survey.mean_slope_deg = degrees_per_radian * portable::atan2(sources > 0.0 ? tangents / sources : usual, 1.0);

    double mean = 0.0;
    for (std::size_t k = 0; k < log_area.size(); ++k) {
        mean += (log_slope[k] + survey.concavity * log_area[k]) / static_cast<double>(log_area.size());
    }
    survey.steepness = Raster<float>(grid, 0.0F);
    Raster<float> weight(grid, 0.0F);
    std::size_t k = 0;
    for (std::size_t n = 0; n < slope.size(); ++n) {
        if (slope[n] > 0.0 && profiles.area_km2(n) > 0.0) {
            double const q = log_slope[k] + survey.concavity * log_area[k] - mean;
            survey.steepness[rivers.cell[n]] = static_cast<float>(std::clamp(q, -1.0, 1.0));
            weight[rivers.cell[n]] = 1.0F;
            ++k;
        }
    }
    auto const reach = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(std::min(2000.0, 5.0 * survey.spacing_m) / grid.cell_m / 1.7));
    for (Raster<float>* field : {&survey.steepness, &weight}) {
        blur(&(*field)[0], {grid.width, grid.height, grid.width}, {reach, 3}, run);
    }
    constexpr float power = 0.5F;
    constexpr float least_weight = 1e-4F;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        float const q = power * survey.steepness[i] / (weight[i] + least_weight);
        survey.steepness[i] = static_cast<float>(portable::exp(static_cast<double>(q)));
    }
    return survey;
}

std::vector<Finding> doubts_of(RiverSurvey const& survey) {
    constexpr double least_km2 = 0.1;
    constexpr double least_deg = 5.0;
    constexpr double of_smooth = 0.8; // mean slope of smooth terrain relative to that of the terrain
    char const* const remedy = "Give it, with --like DEM or --set surface.mean_slope=";
    double const slope_deg = survey.mean_slope_deg / of_smooth;
    if (survey.source_km2 > 0.0 && survey.source_km2 < least_km2) {
        return {{.kind = "rills",
                 .amount = survey.source_km2,
                 .text = fmt::format("half of the rivers begin where less than {:.2g} km² drain: they are rills or "
                                     "gullies, whose slope tells little of the land's, taken for {:.0f} degrees",
                                     survey.source_km2, slope_deg),
                 .remedy = fmt::format("{}{:.0f}", remedy, 20.0),
                 .key = "surface.mean_slope",
                 .numbers = {{"mean_slope", slope_deg, "deg"}}}};
    }
    if (slope_deg < least_deg) {
        return {{.kind = "gentle_land",
                 .amount = slope_deg,
                 .text = fmt::format("by its rivers the land is gentle, {:.1f} degrees on average; below {:g} degrees "
                                     "they tell little of its slope",
                                     slope_deg, least_deg),
                 .remedy = fmt::format("{}{:.1f}", remedy, 0.5 * slope_deg),
                 .key = "surface.mean_slope"}};
    }
    return {};
}

} // namespace thalweg::surface
