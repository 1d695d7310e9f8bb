// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/box_means.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/draw/map.hpp>
#include <thalweg/draw/picture.hpp>
#include <thalweg/draw/sections.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/report/landmarks.hpp>

namespace thalweg::report {

enum class PictureKind : std::uint8_t { map, profile, curve, hypsometry, sections, wireframe };

/// \internal
/// The kinds of picture.
/// \return in the order of the enumeration
std::vector<PictureKind> const& picture_kinds();
char const* name_of(PictureKind kind);

/// The content of pictures; missing parts are empty.
struct Scene {
    std::optional<Raster<float>> dem;
    std::optional<ElevatedNetwork> network;
    NetworkOrders orders;           ///< of the network
    std::vector<double> ds_area_m2; ///< [m²] by arc: contributing area, not above 0: unknown; empty: all unknown
    std::vector<double> increments; ///< [m] of the surface, as used
    std::string increment;          ///< its name or expression
    std::string title;
    double contour_interval_m = 0.0; ///< 0: a round number is chosen
    std::optional<Sea> sea;          ///< cells without a height are the sea
    Mask lakes;                      ///< on the DEM's grid; without cells: none
    draw::LayersBelow rock;          ///< below the ground
};

/// The layers of rock of a recipe, as sections show them.
/// \param dem [m] the terrain
/// \param shift_m by which they lie lower than the recipe says
/// \internal
draw::LayersBelow layers_below(recipe::Recipe const& recipe, Raster<float> const& dem, double shift_m);

/// The appearance of pictures; each picture chooses what is not set.
struct Look {
    draw::Format format = draw::Format::png;
    int width_px = 0;
    std::optional<double> azimuth_deg;   ///< of the wireframe, like the next one; not set: up-valley from the outlet
    std::optional<double> elevation_deg; ///< of the viewer above the horizon
    std::optional<double> exaggeration;
};

/// \internal
/// Explains why a picture cannot be drawn.
/// \param kind of picture
/// \param scene its content
/// \return the end of a sentence; "": it can
std::string missing_for(PictureKind kind, Scene const& scene);

/// Draws one picture of a scene.
/// \param kind of picture
/// \param scene its content
/// \param look its appearance
/// \return the picture
/// \throws BadInput when a part of the scene is missing; as the pictures
draw::Picture draw_picture(PictureKind kind, Scene const& scene, Look const& look, Run const& run = {});

/// What a picture shows of a DEM: the DEM itself, or means of its heights where it has more columns than the picture
/// has pixels.
/// \internal
class ShownLand {
public:
    /// \param dem outlives this object
    /// \param seen overview() of the DEM of so many columns as the picture has pixels; outlives this object
    /// \param lakes on its grid, or without cells; outlives this object
    ShownLand(Raster<float> const& dem, Overview const& seen, Mask const& lakes, Run const& run = {});

    bool is_whole() const { return seen_.means.cells() == 0; }
    Raster<float> const& dem() const { return is_whole() ? dem_ : seen_.means; }
    /// \return heights, hillshade and lakes; needs this object
    draw::MapSheet sheet() const;
    /// \return height and line of the contours of what is shown: of means over two pixels, where finer ones would be a
    /// tangle
    std::vector<std::pair<double, std::vector<Vec2>>> contours(double interval_m, Run const& run = {}) const;

private:
    Raster<float> const& dem_;
    Overview const& seen_;
    Mask const& lakes_;
    Mask lakes_shown_;
    Raster<std::uint8_t> hillshade_;
};

/// Draws a map with what every map of a terrain has: the sea, heights of summits, its coordinate system in words.
/// \param sheet the rest of the map
/// \param sea of the terrain
/// \param summits of the terrain
/// \param params without crs
/// \return the picture
/// \throws BadInput as draw::map
draw::Picture draw_land(draw::MapSheet sheet, std::optional<Sea> const& sea, std::vector<Summit> const& summits,
                        draw::MapParams params);

/// Chooses a contour interval.
/// \param relief_m [m] > 0, height range
/// \return 1, 2 or 5 times a power of ten that gives about twenty contours
double round_interval(double relief_m);

} // namespace thalweg::report
