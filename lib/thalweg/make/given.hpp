// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/network/import/import_lines.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// Account of the length of a file's lines, in plan [m]: read_m + closed_m = kept_m + the sum of left_out_m.
struct GivenLength {
    double read_m = 0.0;
    std::array<double, 8> left_out_m = {}; ///< by LeftOut
    double kept_m = 0.0;                   ///< in the network
    double connector_m = 0.0;              ///< of these: artificial channels, without which rivers would end
    double closed_m = 0.0;                 ///< added where ends were joined
    double carried_m = 0.0;                ///< added where outlets were extended
    double turned_m = 0.0;                 ///< reversed
    double moved_m = 0.0;                  ///< largest shift of an end
    std::vector<SecondaryLine> secondary;  ///< everything left out

    /// \param cause why a line is left out
    /// \return [m] left out for it
    double left_out(LeftOut cause) const { return left_out_m[static_cast<std::size_t>(cause)]; }
    /// \return [m] that the network should contain: everything except what fields, coastlines, divergences, duplicates,
    /// the grid and pruning leave out
    double given_m() const { return kept_m + left_out(LeftOut::too_short) + left_out(LeftOut::head); }
    /// \return [0, 1] share of given_m() that is kept
    double share() const { return kept_m / given_m(); }
};

/// \internal
/// The key of a cause in report.json.
/// \param cause why a line is left out
/// \return snake_case
char const* key_of(LeftOut cause);

/// \internal
/// The words for a cause.
/// \param cause why a line is left out
/// \return for readers: "cut at heads"
char const* words_of(LeftOut cause);

/// Accounts for the lines of a file.
/// \param of_plan what was found when they were read
/// \param planform rivers made of them
/// \param terrain made of these
GivenLength given_length(std::vector<Finding> const& of_plan, Planform const& planform, Terrain const& terrain);

/// How far the DEM is from the heights of one feature of a file.
struct RiverOff {
    std::int64_t feature = 0;
    std::int64_t vertices = 0;
    double median_off_m = 0.0;
    double p99_off_m = 0.0;
    double most_off_m = 0.0;
};

/// Heights of a file's lines at their vertices, compared with the DEM.
struct GivenHeights {
    double tolerance_m = 0.0;
    std::int64_t vertices = 0; ///< with heights, in the network
    std::int64_t missed = 0;   ///< of these: differ by more than the tolerance and the river's fall within a cell
    double largest_m = 0.0;    ///< largest difference of these
    double mean_m = 0.0;       ///< mean difference of these
    double median_off_m = 0.0; ///< of all vertices, like the following
    double p99_off_m = 0.0;
    double most_off_m = 0.0;
    std::vector<RiverOff> rivers = {}; ///< by most_off_m, falling; a thousand at most
};

/// Compares the heights of a file's lines with the DEM.
/// \param wanted what the recipe takes of them
/// \param lines of the file
/// \param planform rivers made of these
/// \param terrain made of them
/// \return nothing where the network does not take all heights of a file, or there is no DEM
std::optional<GivenHeights> given_heights(recipe::NetworkRecipe const& wanted, RiverLines const& lines,
                                          Planform const& planform, Terrain const& terrain);

/// Drainage areas at the lower ends of a file's lines, compared with the terrain's. Ratios: terrain / file.
struct GivenAreas {
    std::int64_t arcs = 0;        ///< that end where a line with an area ends
    double median = 0.0;          ///< of the ratios
    double low = 0.0;             ///< their 5th percentile
    double high = 0.0;            ///< their 95th percentile
    double within_factor_2 = 0.0; ///< [0, 1] share of arcs
};

/// Compares the drainage areas of a file's lines with those of the terrain.
/// \param of_file its lines
/// \param planform rivers made of these
/// \param terrain made of them
/// \return nothing where the file has none
std::optional<GivenAreas> given_areas(RiverLines const& of_file, Planform const& planform, Terrain const& terrain);

/// \internal
/// Formats the account.
/// \param given the account
/// \return one line for the log: kilometres read, kept, left out by cause, reversed, moved, added
std::string line_of(GivenLength const& given);

/// \internal
/// Formats the comparison.
/// \param given the comparison
/// \return one line for the log
std::string line_of(GivenAreas const& given);

/// \internal
/// Formats the comparison.
/// \param given the comparison
/// \return one line for the log
std::string line_of(GivenHeights const& given);

// What is said of the directions of lines.

/// A note on the lengths reversed, by evidence, and a warning for each kind of doubt, with what decides.
/// \internal
/// \param by_dem,by_rule options that decide: "--set network.lines.dem=FILE", "--dem FILE"; "" for none
std::vector<Finding> direction_findings(network::Directions const& directions, std::string const& by_dem,
                                        std::string const& by_rule);

} // namespace thalweg::make
