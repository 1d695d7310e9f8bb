// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/peaks/orometry.hpp>
#include <thalweg/measure/relief/geomorphons.hpp>
#include <thalweg/measure/relief/slope_area.hpp>
#include <thalweg/measure/relief/slopes.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/measure/relief/variety.hpp>
#include <thalweg/measure/texture/texture.hpp>

// Idea: Whether terrain looks natural is decided by many indices together: terrain from noise
// agrees in some of them, but not in all. relief() computes each with the function made for it.
// There is no theory of what is natural for most, so they are compared with two real DEMs of
// different kinds, a steep range and a plateau: an index between the lower value over a margin and
// the higher value times it is plausible. For a few, such as long straight channels, only large
// values are a fault. Indices that depend on the extent, or on how heights were surveyed, judge
// nothing.
// Source: ours: docs/relief_measures.md; each index names its own source.
// Cost: O(n) or little more for most; geomorphons O(n search_cells). Flow field and statistics are
// given.
// Not for: a verdict: two DEMs are not all landscapes, and an index outside its range is a
// question, not a fault. How near a terrain is to one DEM: measure/likeness/likeness.hpp.
// Example:
//     flow::FlowField const drainage = flow::route(dem);
//     Relief const indices = relief(dem, drainage, statistics(dem));
//     ReliefMetric const& metric = relief_metrics()[0];
//     bool const is_plausible = metric.of(indices) <= relief_range(0).high;
// More: docs/relief_measures.md.

namespace thalweg::measure {

/// Morphometric indices of a DEM; NaN: the DEM is too small.
struct Relief {
    Slopes slopes;
    std::optional<PowerLaw> slope_area; ///< its exponent is -theta
    std::optional<Chi> chi;
    double hypsometric_integral = 0.5; ///< [0, 1]
    LocalExtremes extremes;
    std::array<double, form_count> forms{};                                ///< [0, 1] shares of geomorphons
    double valleys_over_ridges = std::numeric_limits<double>::quiet_NaN(); ///< cells of valley / ridge
    /// cells of all valley forms / all ridge forms
    double hollows_over_noses = std::numeric_limits<double>::quiet_NaN();
    double length_x = std::numeric_limits<double>::quiet_NaN(); ///< [-] correlation length along rows / width
    double length_y = std::numeric_limits<double>::quiet_NaN(); ///< [-] correlation length along columns / height
    std::int64_t support_cells = 0;                             ///< cells that drain through the first cell of a river
    double drainage_density = std::numeric_limits<double>::quiet_NaN(); ///< [m/m2] of these streams
    /// [-] times the square root of the support's area
    double scaled_density = std::numeric_limits<double>::quiet_NaN();
    double slope_area_ratio = std::numeric_limits<double>::quiet_NaN(); ///< [-] slope of channels / of hillslopes
    GradientTexture texture;
    StraightChannels straight;
    LevelPatch level_patch;
    Orometry orometry;
    Variety variety;
};

/// Options of relief().
struct ReliefParams {
    GeomorphonParams geomorphons = {};
    SlopeAreaParams slope_area = {};
    ChiParams chi = {};
    std::int64_t support_cells = 200; ///< [1, ...] for the drainage density
    SlopeAreaRatioParams slope_area_ratio = {};
    GradientTextureParams texture = {};
    StraightChannelsParams straight = {};
    LevelPatchParams level_patch = {};
    OrometryParams orometry = {};
    VarietyParams variety = {};
};

/// Computes the morphometric indices of a DEM. Valley forms: hollow, footslope, valley, pit; ridge forms: peak, ridge,
/// shoulder, spur.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \param statistics of the DEM, by statistics()
/// \return the same values as the functions for each index; the same bits for any number of threads
/// \throws BadParameter when support_cells is below 1
/// \throws BadInput when the three belong to different DEMs
Relief relief(Raster<float> const& dem, flow::FlowField const& drainage, Statistics const& statistics,
              ReliefParams const& params = {}, Run const& run = {});

/// Computes the morphometric indices of a DEM with given rivers, which decide what lies away from rivers, which cells
/// are canals, and whether there is a wall.
/// \param dem,drainage,statistics as relief without rivers
/// \param rivers indices of the rivers' cells; empty: the DEM's own streams
/// \return the same bits for any number of threads
/// \throws BadParameter as relief without rivers
/// \throws BadInput as relief without rivers, and for a cell outside the DEM
Relief relief(Raster<float> const& dem, flow::FlowField const& drainage, Statistics const& statistics,
              std::span<std::int64_t const> rivers, ReliefParams const& params = {}, Run const& run = {});

/// The total variation distance of two distributions of landforms.
/// \param a,b [0, 1] shares by form
/// \return [0, 1] half the sum of absolute differences; 0: equal
double total_variation(std::array<double, form_count> const& a, std::array<double, form_count> const& b);

/// Whether a metric distinguishes terrain from noise in any region.
enum class Judges : std::uint8_t { yes, large_values, no };

/// One index of Relief.
struct ReliefMetric {
    std::string_view key; ///< in report.json
    std::string_view name;
    std::string_view unit;
    Judges judges = Judges::yes;           ///< no: it depends on the extent or on the survey of heights
    double (*of)(Relief const&) = nullptr; ///< NaN: unknown
    double tolerance = 1.25;               ///< [1, ...] margin around the reference DEMs: two are not all terrain
    double margin = 0.0;                   ///< [unit] >= 0 added to the higher end
};

inline constexpr std::size_t relief_metric_count = 36;

/// The metrics compared with reference DEMs.
/// \return in a fixed order
std::array<ReliefMetric, relief_metric_count> const& relief_metrics();

inline constexpr std::size_t slope_share_count = 45;

/// The metrics that relief() computes for a reference DEM.
struct ReferenceDem {
    std::string_view name;
    std::string_view file; ///< in samples/, with its source in PROVENANCE.md
    std::string_view source;
    double cell_m = 0.0;
    std::array<double, relief_metric_count> figures{}; ///< [unit of each] in the order of relief_metrics
    std::array<double, slope_share_count> slopes{};    ///< [0, 1] shares of classes of 2 degrees
    std::array<double, form_count> forms{};            ///< [0, 1] shares of geomorphons
    std::span<AreaBin const> slope_area;
};

/// The reference DEMs: a steep, dissected range, and a plateau with dendritic and trellis valleys.
/// \return two entries
std::span<ReferenceDem const> reference_dems();

/// Averages the shares of geomorphons over the reference DEMs.
/// \return by form
std::array<double, form_count> mean_forms();

/// The plausible range of a metric, around the reference DEMs.
struct ReliefRange {
    double low = 0.0;  ///< [unit of the metric]
    double high = 0.0; ///< [unit of the metric]
};

/// \internal
/// Computes the plausible range of a metric.
/// \param figure index in relief_metrics()
/// \return from the smaller reference value / tolerance to the larger * tolerance; from 0 where large values alone
/// judge
ReliefRange relief_range(std::size_t figure);

/// The published natural range of a law's metric.
struct NaturalRange {
    std::string_view law;    ///< its key in report.json
    double low = 0.0;        ///< [unit of the law]
    double high = 0.0;       ///< [unit of the law]
    std::string_view source; ///< author, year, what was measured
};

/// The natural ranges of all laws for which one is published.
/// \return one entry per law
std::span<NaturalRange const> natural_ranges();

/// Finds the natural range of a law.
/// \param law its key in report.json
/// \return null: none is published
NaturalRange const* natural_range(std::string_view law);

} // namespace thalweg::measure
